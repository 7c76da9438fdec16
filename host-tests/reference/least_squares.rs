//! Least squares over all rows at once by QR: no recursion, no normal equations, no 2x2 inverse.

use super::{RegressionRow, Theta};
use nalgebra::{DMatrix, DVector, Vector2};

/// What is believed before the first row: `at`, with `covariance` times the identity.
#[derive(Debug, Clone, Copy)]
pub struct Prior {
    pub at: Theta,
    pub covariance: f64,
}

/// The minimiser of `sum (force - phi'theta)^2`.
pub fn least_squares(rows: &[RegressionRow]) -> Theta {
    weighted(rows, 1.0, None)
}

/// The minimiser of `sum lambda^(n-i) (F_i - phi_i'theta)^2 + lambda^n (theta - at)'(theta - at) / covariance`.
pub fn weighted(rows: &[RegressionRow], lambda: f64, prior: Option<Prior>) -> Theta {
    let weight = |age: usize| lambda.powf(0.5 * age as f64);
    let mut equations: Vec<(Vector2<f64>, f64)> = rows
        .iter()
        .rev()
        .enumerate()
        .map(|(age, row)| (row.regressor() * weight(age), row.force * weight(age)))
        .collect();
    if let Some(prior) = prior {
        let pull = weight(rows.len()) / prior.covariance.sqrt();
        for axis in [Vector2::x(), Vector2::y()] {
            equations.push((axis * pull, axis.dot(&prior.at) * pull));
        }
    }
    solve(&equations)
}

/// The normalised gradient step as what it minimises: three rows, the new one and one that holds each unknown.
pub fn gradient_step(row: RegressionRow, before: Theta, gains: Vector2<f64>) -> Theta {
    let hold = gains.map(|g| 1.0 / g.sqrt());
    solve(&[
        (row.regressor(), row.force),
        (Vector2::new(hold.x, 0.0), hold.x * before.x),
        (Vector2::new(0.0, hold.y), hold.y * before.y),
    ])
}

/// Least squares in K alone, B given.
pub fn stiffness_alone(rows: &[RegressionRow], damping: f64) -> f64 {
    let x = DVector::from_iterator(rows.len(), rows.iter().map(|r| r.x));
    let left = DVector::from_iterator(rows.len(), rows.iter().map(|r| r.force - damping * r.v));
    x.svd(true, true).solve(&left, 0.0).expect("a column that is not zero")[0]
}

/// Squared sine of the angle between the columns of penetration and rate.
pub fn independence(rows: &[RegressionRow]) -> f64 {
    let columns = DMatrix::from_fn(rows.len(), 2, |i, j| if j == 0 { rows[i].x } else { rows[i].v });
    let (x, v) = (columns.column(0).norm(), columns.column(1).norm());
    let r = columns.qr().r();
    if x > 0.0 && v > 0.0 { (r[(1, 1)] / v).powi(2) } else { 0.0 }
}

fn solve(equations: &[(Vector2<f64>, f64)]) -> Theta {
    let size = |pick: fn(&Vector2<f64>) -> f64| {
        let norm = equations.iter().map(|(phi, _)| pick(phi).powi(2)).sum::<f64>().sqrt();
        if norm > 0.0 { norm } else { 1.0 }
    };
    // Columns of equal length, so that the factorisation sees the angle between them and not their units.
    let scale = Vector2::new(size(|phi| phi.x), size(|phi| phi.y));
    let matrix = DMatrix::from_fn(equations.len(), 2, |i, j| equations[i].0[j] / scale[j]);
    let right = DVector::from_iterator(equations.len(), equations.iter().map(|(_, force)| *force));
    let qr = matrix.qr();
    let mut rotated = right;
    qr.q_tr_mul(&mut rotated);
    let solution = qr.r().solve_upper_triangular(&rotated.rows(0, 2).into_owned()).expect("independent columns");
    Vector2::new(solution[0] / scale[0], solution[1] / scale[1])
}
