//! The same estimates in double precision and by other algorithms: nothing here knows how the library computes.

mod adaptive;
mod descent;
mod front_end;
mod least_squares;
mod sprls;

pub use adaptive::{Cusum, Directional, columns, ridged};
pub use descent::{line_minimum, newton_direction, steepest_direction, whole_minimum};
pub use front_end::FrontEnd;
pub use least_squares::{Prior, gradient_step, independence, least_squares, stiffness_alone, weighted};
pub use sprls::SelfPerturbing;

use nalgebra::Vector2;

/// K and B.
pub type Theta = Vector2<f64>;

/// One row of the regression.
#[derive(Debug, Clone, Copy)]
pub struct RegressionRow {
    pub x: f64,
    pub v: f64,
    pub force: f64,
}

impl RegressionRow {
    pub fn regressor(self) -> Vector2<f64> {
        Vector2::new(self.x, self.v)
    }

    pub fn residual(self, theta: Theta) -> f64 {
        self.force - self.regressor().dot(&theta)
    }
}

impl From<palpate::Observation> for RegressionRow {
    fn from(o: palpate::Observation) -> Self {
        Self { x: o.penetration.into(), v: o.rate.into(), force: o.force.into() }
    }
}

/// The library's estimate, widened.
pub fn theta(i: palpate::Impedance) -> Theta {
    Vector2::new(i.stiffness.into(), i.damping.into())
}

/// Observations, widened.
pub fn rows(observations: &[palpate::Observation]) -> Vec<RegressionRow> {
    observations.iter().map(|&o| o.into()).collect()
}
