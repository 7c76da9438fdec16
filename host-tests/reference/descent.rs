//! Descent over a window: the step by numeric minimisation along the line, the whole minimum by its certificate.

use super::{RegressionRow, Theta, least_squares};
use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::brent::{BrentOpt, BrentRoot};
use nalgebra::{Matrix2, Vector2};

/// `J(t) = sum |e - t p|^power` for t in units of `span`, over its value at zero.
#[derive(Clone)]
struct Line {
    terms: Vec<(f64, f64)>,
    power: i32,
    span: f64,
}

impl Line {
    fn value(&self, t: f64) -> f64 {
        self.terms.iter().map(|&(p, e)| (e - t * self.span * p).powi(self.power)).sum()
    }

    fn slope(&self, t: f64) -> f64 {
        -self.terms.iter().map(|&(p, e)| p * (e - t * self.span * p).powi(self.power - 1)).sum::<f64>()
    }
}

impl CostFunction for Line {
    type Param = f64;
    type Output = f64;

    fn cost(&self, t: &f64) -> Result<f64, Error> {
        Ok(self.value(*t))
    }
}

struct Slope(Line);

impl CostFunction for Slope {
    type Param = f64;
    type Output = f64;

    fn cost(&self, t: &f64) -> Result<f64, Error> {
        Ok(self.0.slope(*t))
    }
}

/// How far to go from `from` along `direction`, downhill, to the minimum of `sum |e|^power`.
///
/// Brent's minimiser finds it to about the root of the double's resolution; Brent's root finder on the slope then
/// finds the rest, and the two must agree.
pub fn line_minimum(rows: &[RegressionRow], from: Theta, direction: Vector2<f64>, power: i32) -> f64 {
    let terms: Vec<_> = rows.iter().map(|r| (r.regressor().dot(&direction), r.residual(from))).collect();
    let size = |pick: fn(&(f64, f64)) -> f64| terms.iter().map(|t| pick(t).powi(2)).sum::<f64>().sqrt();
    let mut line = Line { span: size(|t| t.1) / size(|t| t.0), terms, power };
    while line.slope(1.0) < 0.0 {
        line.span *= 2.0;
    }
    let minimum = Executor::new(line.clone(), BrentOpt::new(0.0, 1.0).set_tolerance(1e-9, 1e-14))
        .configure(|state| state.max_iters(500))
        .run()
        .expect("a minimum");
    let root = Executor::new(Slope(line.clone()), BrentRoot::new(0.0, 1.0, 1e-15))
        .configure(|state| state.max_iters(500))
        .run()
        .expect("a root of the slope");
    let (minimum, root) = (*minimum.state().get_param().expect("t"), *root.state().get_param().expect("t"));
    // Near its minimum J is flat to its last digit over a width of 1e-8 of the curvature's own scale; where the
    // quadratic part is small beside the fourth power that is up to 1e-4 of the span.
    assert!((minimum - root).abs() <= 2e-4, "two ways to one minimum: {minimum} and {root}");
    root * line.span
}

/// The unit vector against the gradient of `sum |e|^power`.
pub fn steepest_direction(rows: &[RegressionRow], from: Theta, power: i32) -> Vector2<f64> {
    gradient(rows, from, power).normalize()
}

/// The unit vector along the Newton step of `sum e^4`.
pub fn newton_direction(rows: &[RegressionRow], from: Theta) -> Vector2<f64> {
    let descent = gradient(rows, from, 4);
    hessian(rows, from).svd(true, true).solve(&descent, 0.0).expect("a solution").normalize()
}

/// The minimiser of `sum e^4`: damped Newton steps, believed for the gradient that they end with and not for the way.
///
/// The sum is convex, so a point without gradient is the minimum however it was come by.
pub fn whole_minimum(rows: &[RegressionRow]) -> Theta {
    let mut at = least_squares(rows);
    let cost = |theta: Theta| rows.iter().map(|r| r.residual(theta).powi(4)).sum::<f64>();
    let newton = |theta: Theta| hessian(rows, theta).lu().solve(&gradient(rows, theta, 4)).expect("a solution") / 3.0;
    for _ in 0..40 {
        let step = newton(at);
        let better = |a: &f64, b: &f64| cost(at + step * *a).total_cmp(&cost(at + step * *b));
        at += step * [3.0, 2.0, 1.0, 0.5, 0.1].into_iter().min_by(better).expect("a fraction");
    }
    // At the minimum the cost is flat to its last digit and can no longer choose; plain steps double the digits.
    for _ in 0..6 {
        at += newton(at);
    }
    let unsigned: Vector2<f64> = rows.iter().map(|r| r.regressor().abs() * r.residual(at).abs().powi(3)).sum();
    let left = gradient(rows, at, 4).component_div(&unsigned).amax();
    assert!(left < 1e-8, "a gradient of {left} of its terms is left at the minimum");
    at
}

/// `sum phi e^(power - 1)`: downhill.
fn gradient(rows: &[RegressionRow], from: Theta, power: i32) -> Vector2<f64> {
    rows.iter().map(|r| r.regressor() * r.residual(from).powi(power - 1)).sum()
}

fn hessian(rows: &[RegressionRow], from: Theta) -> Matrix2<f64> {
    rows.iter().map(|r| r.regressor() * r.regressor().transpose() * r.residual(from).powi(2)).sum()
}
