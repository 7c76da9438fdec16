//! Recursive least squares, exponentially weighted (EWRLS) or with infinite memory (RLS).

use crate::contact::{Impedance, Observation};
use crate::error::{ConfigError, require};
use crate::quality::Flags;
use crate::quality::Step;
use crate::recursive::state::{RecursiveState, check_covariance};
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`Ewrls`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct EwrlsConfig {
    /// lambda, above 0.5 and at most 1. Its horizon is 1/(1 - lambda) samples; 1 never forgets and is plain RLS.
    pub forgetting_factor: f32,
    /// P(0) = `initial_covariance` * I, above 0, at most 1e8, internal units.
    pub initial_covariance: f32,
    /// Bound of the covariance: while nothing moves, forgetting alone would let it grow without end (past the
    /// range of a single after 26 s of a held contact at 0.9967). At least `initial_covariance`, at most 1e9.
    pub covariance_limit: f32,
}

impl Default for EwrlsConfig {
    /// The paper's: forgetting 0.9967 (a horizon of 300 samples), P(0) = 10.
    fn default() -> Self {
        Self { forgetting_factor: 0.9967, initial_covariance: 10.0, covariance_limit: 1e6 }
    }
}

impl EwrlsConfig {
    /// Plain RLS: nothing is forgotten.
    pub fn rls() -> Self {
        Self { forgetting_factor: 1.0, ..Self::default() }
    }
}

/// Exponentially weighted recursive least squares.
///
/// ```text
/// s = lambda + phi' P phi,  L = P phi / s,  theta += L e,  P = (P - L phi' P) / lambda
/// ```
/// with the innovation `e = F - phi' theta`. It is the minimiser of
/// `sum lambda^(k-i) (F_i - phi_i' theta)^2 + lambda^k theta' P(0)^-1 theta`.
#[derive(Debug, Clone, Copy)]
pub struct Ewrls {
    config: EwrlsConfig,
    /// Inverse of the forgetting factor.
    growth: f32,
}

impl Ewrls {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: EwrlsConfig) -> Result<Self, ConfigError> {
        let lambda = config.forgetting_factor;
        require(lambda > 0.5 && lambda <= 1.0, "forgetting_factor", "above 0.5 and at most 1")?;
        check_covariance(config.initial_covariance, config.covariance_limit)?;
        Ok(Self { config, growth: 1.0 / lambda })
    }
}

impl Ewrls {
    /// Updates the estimate and its covariance by one observation, without interval, fill or excitation, at less than a fifth of
    /// the instructions of [`UpdateLaw::update`]. The intervals of a state updated this way are not valid until
    /// [`UpdateLaw::reset_memory`]. Returns the innovation, in internal units of force.
    pub fn update_estimate(&self, state: &mut RecursiveState, o: &Observation) -> f32 {
        let innovation = o.residual(state.estimate);
        let mut covariance = state.covariance;
        let gain = covariance.observe_with(o, self.config.forgetting_factor, self.growth);
        if state.commit_plain(gain, innovation, covariance, self.config.covariance_limit) {
            innovation
        } else {
            self.update_estimate_limited(state, o)
        }
    }

    /// The same where the covariance has to be limited, or begins anew.
    #[cold]
    fn update_estimate_limited(&self, state: &mut RecursiveState, o: &Observation) -> f32 {
        let innovation = o.residual(state.estimate);
        let mut covariance = state.covariance;
        let gain = covariance.observe_with(o, self.config.forgetting_factor, self.growth);
        covariance.limit(self.config.covariance_limit);
        state.commit(gain, innovation, covariance, self.config.initial_covariance);
        innovation
    }
}

impl UpdateLaw for Ewrls {
    type State = RecursiveState;

    fn initial_state(&self) -> RecursiveState {
        RecursiveState::new(self.config.initial_covariance, Impedance::ZERO)
    }

    fn reset_memory(&self, state: &mut RecursiveState) {
        *state = RecursiveState::new(self.config.initial_covariance, state.estimate);
    }

    fn window(&self) -> usize {
        1
    }

    fn update(&self, state: &mut RecursiveState, recent: Recent<'_>) -> Step {
        let lambda = self.config.forgetting_factor;
        let o = recent.newest().unwrap_or_default();
        let innovation = o.residual(state.estimate);
        let mut covariance = state.covariance;
        let gain = covariance.observe_with(&o, lambda, self.growth);
        let limited = covariance.limit(self.config.covariance_limit);
        let mut flags = state.commit(gain, innovation, covariance, self.config.initial_covariance);
        flags.set(Flags::LIMITED, limited);
        state.step(&o, gain, innovation, lambda, flags)
    }
}
