//! Recursive least squares that forgets only in the direction of the newest regressor.

use crate::contact::{Impedance, Observation};
use crate::error::{ConfigError, require};
use crate::math::sym2::Sym2;
use crate::prior::Prior;
use crate::quality::Flags;
use crate::quality::Step;
use crate::quality::UncertaintyPropagation;
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`DirectionalRls`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct DirectionalRlsConfig {
    /// lambda, above 0.5 and at most 1: what is kept of the information along the newest regressor.
    pub forgetting_factor: f32,
    /// Prior of the first sample.
    pub prior: Prior,
}

impl Default for DirectionalRlsConfig {
    /// 0.95, and the defaults of [`Prior`].
    fn default() -> Self {
        Self { forgetting_factor: 0.95, prior: Prior::default() }
    }
}

/// Directional forgetting (L. Cao, H. Schwartz, Automatica 36 (2000) 1725):
///
/// ```text
/// R = R - (1 - lambda) R phi phi' R / (phi' R phi) + phi phi',   theta += R^-1 phi e
/// ```
/// Information across the newest regressor is kept: a held contact forgets nothing of B, and R is bounded from below without
/// a limit of the covariance.
///
/// It is offered for what it keeps, not for its speed: consecutive samples of a sampled motion point the same way, each forgets what
/// the one before has just brought, and what lies across is kept. A jump of K takes it more than a second at 0.95, where
/// [`crate::Ewrls`] of the same factor needs a tenth of that.
#[derive(Debug, Clone, Copy)]
pub struct DirectionalRls {
    config: DirectionalRlsConfig,
    start: Sym2,
}

/// State of [`DirectionalRls`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalRlsState {
    /// K and B, internal units.
    pub estimate: Impedance,
    /// R, the inverse of the covariance per unit of noise variance.
    pub information: Sym2,
    uncertainty: UncertaintyPropagation,
}

impl DirectionalRls {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: DirectionalRlsConfig) -> Result<Self, ConfigError> {
        let lambda = config.forgetting_factor;
        require(lambda > 0.5 && lambda <= 1.0, "forgetting_factor", "above 0.5 and at most 1")?;
        let ridge = config.prior.check()?.ridge();
        Ok(Self { config, start: Sym2::diagonal(ridge.stiffness, ridge.damping) })
    }

    fn from(&self, estimate: Impedance) -> DirectionalRlsState {
        DirectionalRlsState { estimate, information: self.start, uncertainty: UncertaintyPropagation::new(estimate) }
    }

    /// R without what is forgotten along `phi`; all of it where nothing is known along it.
    fn forgotten(&self, information: Sym2, phi: Impedance) -> Sym2 {
        let along = information.times(phi);
        let known = along.stiffness * phi.stiffness + along.damping * phi.damping;
        if known > f32::MIN_POSITIVE {
            let share = (self.config.forgetting_factor - 1.0) / known;
            let forgotten = information.plus_outer(share, along.stiffness, along.damping);
            if forgotten.xx > 0.0 && forgotten.vv > 0.0 { forgotten } else { information }
        } else {
            information
        }
    }
}

impl UpdateLaw for DirectionalRls {
    type State = DirectionalRlsState;

    fn initial_state(&self) -> DirectionalRlsState {
        self.from(Impedance::ZERO)
    }

    fn reset_memory(&self, state: &mut DirectionalRlsState) {
        *state = self.from(state.estimate);
    }

    fn window(&self) -> usize {
        1
    }

    fn update(&self, state: &mut DirectionalRlsState, recent: Recent<'_>) -> Step {
        let o: Observation = recent.newest().unwrap_or_default();
        let phi = Impedance { stiffness: o.penetration, damping: o.rate };
        let innovation = o.residual(state.estimate);
        let lambda = self.config.forgetting_factor;
        let information = self.forgotten(state.information, phi).plus_outer(1.0, o.penetration, o.rate);
        let mut flags = Flags::empty();
        let gain = match information.invert(0.0) {
            Some(covariance) => covariance.times(phi),
            None => Impedance::ZERO,
        };
        let next = state.estimate.moved(innovation, gain);
        if gain != Impedance::ZERO && next.is_finite() {
            (state.estimate, state.information) = (next, information);
            state.uncertainty.advance(&o, gain, innovation, lambda.min(MAX_FORGETTING));
        } else if !information.is_finite() {
            state.information = self.start;
            flags = Flags::RESET;
        } else {
            flags = Flags::HELD;
        }
        state.uncertainty.step(state.estimate, innovation, lambda.min(MAX_FORGETTING), flags)
    }
}

/// Largest forgetting factor for fill and excitation.
const MAX_FORGETTING: f32 = 0.999;

#[cfg(test)]
mod tests {
    use super::*;

    const ALONG_K: Impedance = Impedance { stiffness: 1.0, damping: 0.0 };
    const ALONG_B: Impedance = Impedance { stiffness: 0.0, damping: 1.0 };

    fn law() -> DirectionalRls {
        let config = DirectionalRlsConfig { forgetting_factor: 0.75, ..DirectionalRlsConfig::default() };
        DirectionalRls::new(config).expect("sound settings")
    }

    #[test]
    fn information_is_forgotten_along_the_regressor_alone() {
        let known = Sym2::diagonal(4.0, 8.0);
        assert_eq!(law().forgotten(known, ALONG_K), Sym2::diagonal(3.0, 8.0));
        assert_eq!(law().forgotten(known, ALONG_B), Sym2::diagonal(4.0, 6.0));
        assert_eq!(law().forgotten(known, Impedance::ZERO), known);
    }

    /// Rounding can leave the information with a determinant below zero; a quarter of what lies along the regressor is then
    /// more than there is across it.
    #[test]
    fn information_that_forgetting_would_make_negative_is_kept() {
        let unsound = Sym2 { xx: 1.0, xv: 4.0, vv: 1.0 };
        assert_eq!(law().forgotten(unsound, ALONG_K), unsound);
        assert_eq!(law().forgotten(unsound, ALONG_B), unsound);
    }

    #[test]
    fn information_that_forgetting_would_make_zero_or_that_is_next_to_nothing_is_kept() {
        let singular = Sym2 { xx: 1.0, xv: 2.0, vv: 1.0 };
        assert_eq!(law().forgotten(singular, ALONG_K), singular);
        assert_eq!(law().forgotten(singular, ALONG_B), singular);
        let least = Sym2::diagonal(f32::MIN_POSITIVE, 8.0);
        assert_eq!(law().forgotten(least, ALONG_K), least);
    }
}
