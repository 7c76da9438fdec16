//! The block laws in double precision, summed anew: what an update should have come to.

use crate::reference::{self, RegressionRow, Theta};
use nalgebra::{Matrix2, Vector2};

/// Least squares by normal equations: in double precision their 1e-16 times the conditioning is far below a single's digit.
pub fn least_squares(rows: &[RegressionRow]) -> Theta {
    let (mut r, mut m) = (Matrix2::zeros(), Vector2::zeros());
    for row in rows {
        let phi = row.regressor();
        r += phi * phi.transpose();
        m += phi * row.force;
    }
    r.try_inverse().expect("independent columns") * m
}

/// One exact step of the fourth power from `from`, along its gradient.
pub fn fourth_step(rows: &[RegressionRow], from: Theta) -> Theta {
    let gradient: Vector2<f64> = rows.iter().map(|row| row.regressor() * row.residual(from).powi(3)).sum();
    along(rows, from, gradient.normalize())
}

/// The same along the Newton direction.
pub fn newton_step(rows: &[RegressionRow], from: Theta) -> Theta {
    along(rows, from, reference::newton_direction(rows, from))
}

/// One exact step of the square, along its gradient.
pub fn square_step(rows: &[RegressionRow], from: Theta) -> Theta {
    let u = rows.iter().map(|row| row.regressor() * row.residual(from)).sum::<Vector2<f64>>();
    let bend: f64 = rows.iter().map(|row| row.regressor().dot(&u).powi(2)).sum();
    from + u * (u.norm_squared() / bend)
}

fn along(rows: &[RegressionRow], from: Theta, u: Vector2<f64>) -> Theta {
    let terms: Vec<(f64, f64)> = rows.iter().map(|row| (row.regressor().dot(&u), row.residual(from))).collect();
    // The slope of the cost rises everywhere, so bisection finds its only zero.
    let slope = |t: f64| terms.iter().map(|(p, e)| -p * (e - t * p).powi(3)).sum::<f64>();
    let [a, b, c, d] = terms.iter().fold([0.0; 4], |[a, b, c, d], (p, e)| {
        [a + p.powi(4), b - 3.0 * p.powi(3) * e, c + 3.0 * p * p * e * e, d - p * e.powi(3)]
    });
    let rises = |t: f64| ((a * t + b) * t + c) * t + d > 0.0;
    let mut high = 1e-12;
    while !rises(high) {
        high *= 2.0;
    }
    let mut low = 0.0;
    while high - low > 1e-9 * high {
        let middle = 0.5 * (low + high);
        if rises(middle) { high = middle } else { low = middle }
    }
    // The polynomial cancels near a triple root; the sum itself does not, and three Newton steps on it end the search.
    let mut t = 0.5 * (low + high);
    for _ in 0..3 {
        let bend: f64 = terms.iter().map(|(p, e)| 3.0 * (p * (e - t * p)).powi(2)).sum();
        if bend > 0.0 {
            t -= slope(t) / bend;
        }
    }
    from + u * t
}
