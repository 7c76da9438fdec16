//! Recursive least squares with covariance resetting.

use crate::contact::Impedance;
use crate::error::{ConfigError, require};
use crate::quality::Step;
use crate::recursive::covariance::Covariance;
use crate::recursive::state::{RecursiveState, check_initial_covariance};
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`ResetRls`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ResetRlsConfig {
    /// Samples from one reset to the next, at least 2.
    pub reset_interval: u16,
    /// P(0), and P after each reset, = `initial_covariance` * I, above 0, at most 1e8.
    pub initial_covariance: f32,
}

impl Default for ResetRlsConfig {
    /// A reset every 300 samples, P = 10.
    fn default() -> Self {
        Self { reset_interval: 300, initial_covariance: 10.0 }
    }
}

/// RLS without forgetting whose covariance returns to its start every `reset_interval` samples (Goodwin and Sin,
/// Adaptive Filtering Prediction and Control, 1984, section 3.3): the estimate at the reset is then the prior of what
/// follows.
#[derive(Debug, Clone, Copy)]
pub struct ResetRls {
    config: ResetRlsConfig,
}

/// State of [`ResetRls`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResetRlsState {
    /// Estimate and covariance.
    pub recursion: RecursiveState,
    since_reset: u16,
}

impl ResetRls {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: ResetRlsConfig) -> Result<Self, ConfigError> {
        require(config.reset_interval >= 2, "reset_interval", "at least 2 samples")?;
        check_initial_covariance(config.initial_covariance)?;
        Ok(Self { config })
    }
}

impl ResetRls {
    fn from(&self, estimate: Impedance) -> ResetRlsState {
        ResetRlsState { recursion: RecursiveState::new(self.config.initial_covariance, estimate), since_reset: 0 }
    }
}

impl UpdateLaw for ResetRls {
    type State = ResetRlsState;

    fn initial_state(&self) -> ResetRlsState {
        self.from(Impedance::ZERO)
    }

    fn reset_memory(&self, state: &mut ResetRlsState) {
        *state = self.from(state.recursion.estimate);
    }

    fn window(&self) -> usize {
        1
    }

    fn update(&self, state: &mut ResetRlsState, recent: Recent<'_>) -> Step {
        let o = recent.newest().unwrap_or_default();
        if state.since_reset >= self.config.reset_interval {
            state.recursion.covariance = Covariance::identity(self.config.initial_covariance);
            state.since_reset = 0;
        }
        state.since_reset += 1;
        let innovation = o.residual(state.recursion.estimate);
        let mut covariance = state.recursion.covariance;
        let gain = covariance.observe(&o, 1.0);
        let flags = state.recursion.commit(gain, innovation, covariance, self.config.initial_covariance);
        let memory = 1.0 - 1.0 / f32::from(self.config.reset_interval);
        state.recursion.step(&o, gain, innovation, memory, flags)
    }
}
