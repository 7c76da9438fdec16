//! Self-perturbing recursive least squares (SPRLS).

use crate::contact::{Impedance, Observation};
use crate::error::{ConfigError, require_not_negative};
use crate::math::smaller;
use crate::quality::DEFAULT_FORGETTING;
use crate::quality::Flags;
use crate::quality::Step;
use crate::recursive::covariance::Covariance;
use crate::recursive::state::{RecursiveState, check_covariance};
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`Sprls`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SprlsConfig {
    /// beta >= 0: size of one step of the perturbation, internal units (the paper's beta, 100).
    pub perturbation_gain: f32,
    /// gamma >= 0: steps of the perturbation per squared residual, internal units (the paper's gamma, 2 per N^2). Residuals
    /// below sqrt(0.5 / gamma) do not perturb.
    pub perturbation_sensitivity: f32,
    /// P(0) = `initial_covariance` * I, above 0, at most 1e8.
    pub initial_covariance: f32,
    /// Bound of the covariance, at least `initial_covariance`, at most 1e9.
    pub covariance_limit: f32,
}

impl Default for SprlsConfig {
    /// The paper's: beta 100, gamma 2, P(0) = 10.
    fn default() -> Self {
        Self {
            perturbation_gain: 100.0,
            perturbation_sensitivity: 2.0,
            initial_covariance: 10.0,
            covariance_limit: 1e6,
        }
    }
}

/// Recursive least squares without forgetting whose covariance is perturbed by its own residual:
///
/// ```text
/// P = P - L phi' P + beta * NINT(gamma e'^2) I
/// ```
/// where `e'` is the innovation of the step before (the paper's e(k-1) in the update to k+1), and NINT rounds to the
/// nearest whole number, halves away from zero.
#[derive(Debug, Clone, Copy)]
pub struct Sprls {
    config: SprlsConfig,
}

/// State of [`Sprls`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SprlsState {
    /// Estimate and covariance.
    pub recursion: RecursiveState,
    /// Innovation of the update before, zero at the start.
    pub innovation_before: f32,
}

impl Sprls {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: SprlsConfig) -> Result<Self, ConfigError> {
        require_not_negative(config.perturbation_gain, "perturbation_gain")?;
        require_not_negative(config.perturbation_sensitivity, "perturbation_sensitivity")?;
        check_covariance(config.initial_covariance, config.covariance_limit)?;
        Ok(Self { config })
    }

    /// `beta * NINT(gamma e^2)` of at most 2^32 steps, bounded by the limit of the covariance; zero where the innovation is no number.
    pub fn perturbation(&self, innovation: f32) -> f32 {
        let level = self.level(innovation);
        if level >= Self::HALF_STEP { self.limited(nearest(level)) } else { 0.0 }
    }
}

/// The nearest whole number, halves upward, from 0.5 to 2^32, which nothing exceeds; zero where `level` is no number.
#[inline(always)]
fn nearest(level: f32) -> f32 {
    (level + 0.5) as u32 as f32
}

impl Sprls {
    /// Steps of the perturbation below which there is none.
    const HALF_STEP: f32 = 0.5;

    /// Steps of the perturbation, not rounded yet.
    #[inline(always)]
    fn level(&self, innovation: f32) -> f32 {
        self.config.perturbation_sensitivity * innovation * innovation
    }

    /// Adds the perturbation of the previous innovation, if any.
    fn perturb(&self, covariance: &mut Covariance, innovation: f32) {
        let level = self.level(innovation);
        if level >= Self::HALF_STEP {
            covariance.inflate(self.limited(nearest(level)));
        }
    }

    /// So many steps of the perturbation, bounded by the limit of the covariance.
    fn limited(&self, steps: f32) -> f32 {
        smaller(self.config.perturbation_gain * steps, self.config.covariance_limit)
    }

    fn from(&self, estimate: Impedance) -> SprlsState {
        SprlsState { recursion: RecursiveState::new(self.config.initial_covariance, estimate), innovation_before: 0.0 }
    }
}

impl Sprls {
    /// Updates the estimate and its covariance by one observation without its uncertainty: as [`crate::Ewrls::update_estimate`].
    pub fn update_estimate(&self, state: &mut SprlsState, o: &Observation) -> f32 {
        let mut covariance = state.recursion.covariance;
        let gain = covariance.observe_with(o, 1.0, 1.0);
        let level = self.level(state.innovation_before);
        if level >= Self::HALF_STEP {
            kicked();
            // Not limited: a perturbation beyond the limit takes the covariance beyond it as well, which is then not plain.
            covariance.inflate(self.config.perturbation_gain * nearest(level));
        }
        let innovation = o.residual(state.recursion.estimate);
        if state.recursion.commit_plain(gain, innovation, covariance, self.config.covariance_limit) {
            state.innovation_before = innovation;
            innovation
        } else {
            self.update_estimate_limited(state, o)
        }
    }

    /// The same where the perturbation or the covariance has to be limited, or the covariance begins anew.
    #[cold]
    fn update_estimate_limited(&self, state: &mut SprlsState, o: &Observation) -> f32 {
        self.advance(state, o).0
    }

    /// One update of estimate and covariance.
    #[inline(always)]
    fn advance(&self, state: &mut SprlsState, o: &Observation) -> (f32, Impedance, Flags) {
        let innovation = o.residual(state.recursion.estimate);
        let mut covariance = state.recursion.covariance;
        let gain = covariance.observe_with(o, 1.0, 1.0);
        self.perturb(&mut covariance, state.innovation_before);
        let limited = covariance.limit(self.config.covariance_limit);
        let mut flags = state.recursion.commit(gain, innovation, covariance, self.config.initial_covariance);
        flags.set(Flags::LIMITED, limited);
        state.innovation_before = innovation;
        (innovation, gain, flags)
    }
}

/// Tells the compiler that a kick is rare, so that the usual update runs straight through.
#[cold]
#[inline]
fn kicked() {}

impl UpdateLaw for Sprls {
    type State = SprlsState;

    fn initial_state(&self) -> SprlsState {
        self.from(Impedance::ZERO)
    }

    fn reset_memory(&self, state: &mut SprlsState) {
        *state = self.from(state.recursion.estimate);
    }

    fn window(&self) -> usize {
        1
    }

    fn update(&self, state: &mut SprlsState, recent: Recent<'_>) -> Step {
        let o = recent.newest().unwrap_or_default();
        let (innovation, gain, flags) = self.advance(state, &o);
        state.recursion.step(&o, gain, innovation, DEFAULT_FORGETTING, flags)
    }
}
