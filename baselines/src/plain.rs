//! By nalgebra, as one would write it down.

use nalgebra::{Matrix2, Vector2};
use palpate::{Impedance, Observation, Recent};

use crate::{COVARIANCE, FORGETTING};

/// Recursive least squares in matrices.
pub struct NalgebraRls {
    theta: Vector2<f32>,
    covariance: Matrix2<f32>,
}

impl Default for NalgebraRls {
    fn default() -> Self {
        Self { theta: Vector2::zeros(), covariance: Matrix2::identity() * COVARIANCE }
    }
}

impl NalgebraRls {
    /// One observation.
    pub fn update(&mut self, o: &Observation) -> Impedance {
        let phi = Vector2::new(o.penetration, o.rate);
        let spread = self.covariance * phi;
        let gain = spread / (FORGETTING + phi.dot(&spread));
        self.theta += gain * (o.force - phi.dot(&self.theta));
        self.covariance = (self.covariance - gain * spread.transpose()) / FORGETTING;
        Impedance { stiffness: self.theta.x, damping: self.theta.y }
    }
}

/// Least squares over a window by its normal equations, zero where they have no solution.
pub fn nalgebra_window(recent: Recent<'_>) -> Impedance {
    let (mut normal, mut right) = (Matrix2::<f32>::zeros(), Vector2::<f32>::zeros());
    recent.for_each(|o| {
        let phi = Vector2::new(o.penetration, o.rate);
        normal += phi * phi.transpose();
        right += phi * o.force;
    });
    let theta = normal.try_inverse().map_or_else(Vector2::zeros, |inverse| inverse * right);
    Impedance { stiffness: theta.x, damping: theta.y }
}
