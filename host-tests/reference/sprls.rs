//! Self-perturbing least squares in information form: the covariance exists only while it is kicked.

use super::{RegressionRow, Theta};
use nalgebra::Matrix2;

/// `R += phi phi'`, `theta = R^-1 (R theta + phi F)`, and where the residual before perturbs, `R = (R^-1 + perturbation I)^-1`.
#[derive(Debug, Clone)]
pub struct SelfPerturbing {
    pub estimate: Theta,
    information: Matrix2<f64>,
    innovation_before: f64,
    gain: f64,
    sensitivity: f64,
}

impl SelfPerturbing {
    pub fn new(initial_covariance: f64, gain: f64, sensitivity: f64) -> Self {
        Self {
            estimate: Theta::zeros(),
            information: Matrix2::identity() / initial_covariance,
            innovation_before: 0.0,
            gain,
            sensitivity,
        }
    }

    /// The level of the perturbation that the next update adds, before it is rounded to a whole number.
    pub fn level(&self) -> f64 {
        self.sensitivity * self.innovation_before * self.innovation_before
    }

    /// One row; `steps` of the perturbation are forced where given, for which side a tie falls to is not ours to say.
    pub fn update(&mut self, row: RegressionRow, steps: Option<f64>) {
        let steps = steps.unwrap_or_else(|| self.level().round());
        self.innovation_before = row.residual(self.estimate);
        let known = self.information * self.estimate;
        self.information += row.regressor() * row.regressor().transpose();
        self.estimate = invert(self.information) * (known + row.regressor() * row.force);
        if steps > 0.0 {
            self.information = invert(invert(self.information) + Matrix2::identity() * (self.gain * steps));
        }
    }
}

fn invert(matrix: Matrix2<f64>) -> Matrix2<f64> {
    matrix.try_inverse().expect("a positive definite matrix")
}
