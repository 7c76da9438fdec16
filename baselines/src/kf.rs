//! By kfilter.

use kfilter::KalmanLinearNoInput;
use kfilter::kalman::{KalmanFilter as _, KalmanUpdate as _};
use kfilter::measurement::LinearMeasurement;
use kfilter::system::LinearNoInputSystem;
use nalgebra_034::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
use palpate::{Impedance, Observation};

use crate::{COVARIANCE, FORGETTING};

/// A Kalman filter of two numbers that stand still.
pub struct Kfilter(KalmanLinearNoInput<f32, 2>);

impl Default for Kfilter {
    fn default() -> Self {
        let still = LinearNoInputSystem::new(Matrix2::identity(), Matrix2::zeros(), Vector2::zeros());
        Self(KalmanLinearNoInput::new_custom(still, Matrix2::identity() * COVARIANCE))
    }
}

impl Kfilter {
    /// One observation.
    pub fn update(&mut self, o: &Observation) -> Impedance {
        let regressor = RowVector2::new(o.penetration, o.rate);
        let measured = LinearMeasurement::new(regressor, Matrix1::new(FORGETTING), Vector1::new(o.force));
        // Where the innovation has no variance nothing moves, and the estimate is what it was.
        let _ = self.0.update(&measured);
        *self.0.covariance_mut() /= FORGETTING;
        let theta = self.0.state();
        Impedance { stiffness: theta.x, damping: theta.y }
    }
}
