//! The constant-gain gradient law.

use crate::contact::Impedance;
use crate::error::{ConfigError, require_positive};
use crate::quality::Flags;
use crate::quality::Step;
use crate::quality::{DEFAULT_FORGETTING, UncertaintyPropagation};
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`Gradient`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct GradientConfig {
    /// Adaptation gain of K, above zero, internal units (1/m^2 on the bench).
    pub stiffness_gain: f32,
    /// Adaptation gain of B, above zero, internal units (s^2/m^2 on the bench).
    pub damping_gain: f32,
}

impl Default for GradientConfig {
    /// 100 for K and 1 for B: on the bench (8 mm and 0.15 m/s rms) a horizon of about 150 samples for K and 50 for B.
    fn default() -> Self {
        Self { stiffness_gain: 100.0, damping_gain: 1.0 }
    }
}

/// The normalised gradient law
///
/// ```text
/// theta += G phi e / (1 + phi' G phi),   G = diag(stiffness_gain, damping_gain)
/// ```
/// It is the point that minimises `(theta - theta_before)' G^-1 (theta - theta_before) + (F - phi' theta)^2`, so its
/// distance to the truth (in G^-1, its Lyapunov function) never grows without noise, whatever the gains (Ioannou and
/// Sun, Robust Adaptive Control, 1996, section 4.3; Goodwin and Sin 1984, section 3.3).
#[derive(Debug, Clone, Copy)]
pub struct Gradient {
    config: GradientConfig,
}

/// State of [`Gradient`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GradientState {
    /// K and B, internal units.
    pub estimate: Impedance,
    uncertainty: UncertaintyPropagation,
}

impl Gradient {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: GradientConfig) -> Result<Self, ConfigError> {
        require_positive(config.stiffness_gain, "stiffness_gain")?;
        require_positive(config.damping_gain, "damping_gain")?;
        Ok(Self { config })
    }
}

impl UpdateLaw for Gradient {
    type State = GradientState;

    fn initial_state(&self) -> GradientState {
        GradientState { estimate: Impedance::ZERO, uncertainty: UncertaintyPropagation::new(Impedance::ZERO) }
    }

    fn reset_memory(&self, state: &mut GradientState) {
        state.uncertainty = UncertaintyPropagation::new(state.estimate);
    }

    fn window(&self) -> usize {
        1
    }

    fn update(&self, state: &mut GradientState, recent: Recent<'_>) -> Step {
        let o = recent.newest().unwrap_or_default();
        let innovation = o.residual(state.estimate);
        let pull = Impedance {
            stiffness: self.config.stiffness_gain * o.penetration,
            damping: self.config.damping_gain * o.rate,
        };
        let norm = 1.0 / (1.0 + pull.stiffness * o.penetration + pull.damping * o.rate);
        let gain = Impedance { stiffness: pull.stiffness * norm, damping: pull.damping * norm };
        let next = state.estimate.moved(innovation, gain);
        let mut flags = Flags::empty();
        if next.is_finite() {
            state.estimate = next;
            state.uncertainty.advance(&o, gain, innovation, DEFAULT_FORGETTING);
        } else {
            flags = Flags::HELD;
        }
        state.uncertainty.step(state.estimate, innovation, DEFAULT_FORGETTING, flags)
    }
}
