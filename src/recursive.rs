//! What the recursive least-squares laws share: estimate, covariance, uncertainty.

use crate::confidence::Propagation;
use crate::contact::{Impedance, Observation};
use crate::covariance::Covariance;
use crate::error::{ConfigError, require, require_positive};
use crate::flags::Flags;
use crate::law::Step;
use crate::math::smaller;

/// Forgetting factor, at most, over which the noise is measured: a memory of a thousand samples follows a sensor that
/// changes, and a sum in single precision over it is exact to 1e-4.
const NOISE_FORGETTING: f32 = 0.999;

/// The state of a recursive least-squares law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecursiveState {
    /// K and B, internal units.
    pub estimate: Impedance,
    /// Covariance per unit of noise variance.
    pub covariance: Covariance,
    pub(crate) uncertainty: Propagation,
    pub(crate) start: Covariance,
}

impl RecursiveState {
    /// With the estimate at `estimate` and all else at its start.
    pub(crate) fn new(initial_covariance: f32, estimate: Impedance) -> Self {
        let start = Covariance::identity(initial_covariance);
        Self { estimate, covariance: start, uncertainty: Propagation::new(estimate), start }
    }

    /// The bare recursion: `theta += P phi / s * innovation` and the covariance behind it. Returns the gain.
    pub fn advance(&mut self, o: &Observation, innovation: f32, forgetting: f32) -> Impedance {
        let gain = self.covariance.observe(o, forgetting);
        self.estimate = self.estimate.moved(innovation, gain);
        gain
    }

    /// Commits `next` where it is sound, else keeps the estimate and starts the covariance anew.
    pub(crate) fn commit(&mut self, next: Self) -> Flags {
        if next.covariance.is_sound() && next.estimate.is_finite() {
            *self = next;
            Flags::empty()
        } else {
            self.covariance = self.start;
            Flags::RESET
        }
    }

    pub(crate) fn step(&mut self, o: &Observation, gain: Impedance, innovation: f32, forgetting: f32) -> Step {
        let forgetting = smaller(forgetting, NOISE_FORGETTING);
        self.uncertainty.advance(o, gain, innovation, forgetting);
        Step {
            estimate: self.estimate,
            innovation,
            confidence: self.uncertainty.confidence(self.estimate),
            fill: self.uncertainty.fill(forgetting),
            excitation: self.uncertainty.excitation(),
            flags: Flags::empty(),
        }
    }
}

/// Checks a covariance that may grow up to `limit`.
pub(crate) fn check_covariance(initial: f32, limit: f32) -> Result<(), ConfigError> {
    check_initial_covariance(initial)?;
    require(limit >= initial && limit <= 1e9, "covariance_limit", "at least initial_covariance and at most 1e9")
}

pub(crate) fn check_initial_covariance(value: f32) -> Result<(), ConfigError> {
    require_positive(value, "initial_covariance")?;
    require(value <= 1e8, "initial_covariance", "at most 1e8 internal units")
}
