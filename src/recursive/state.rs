//! What the recursive least-squares laws share: estimate, covariance, uncertainty.

use crate::contact::{Impedance, Observation};
use crate::error::{ConfigError, require, require_positive};
use crate::math::smaller;
use crate::quality::Confidence;
use crate::quality::Flags;
use crate::quality::Step;
use crate::quality::UncertaintyPropagation;
use crate::recursive::covariance::Covariance;

/// Largest forgetting factor for fill and excitation: a sum in single precision over a memory of a thousand
/// samples is exact to 1e-4, and one that never forgets would stop growing.
const MAX_FORGETTING: f32 = 0.999;

/// The state of a recursive least-squares law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecursiveState {
    /// K and B, internal units.
    pub estimate: Impedance,
    /// Covariance per unit of noise variance.
    pub covariance: Covariance,
    uncertainty: UncertaintyPropagation,
}

impl RecursiveState {
    /// The estimate without the bias that is left from its initial value of zero; `None` until both parameters can be estimated.
    ///
    /// A small P(0) biases a recursion towards its initial value for seconds. That bias follows from the gains: `M (I - M)^-1 (start -
    /// estimate)` ([`UncertaintyPropagation`]). Without it the estimate is the weighted least-squares solution of the samples alone. The
    /// state is not changed.
    pub fn without_start(&self) -> Option<Impedance> {
        let corrected = self.estimate.moved(-1.0, self.uncertainty.confidence(self.estimate).startup_bias);
        corrected.is_finite().then_some(corrected)
    }

    /// With the estimate at `estimate` and all else at its start.
    pub(crate) fn new(initial_covariance: f32, estimate: Impedance) -> Self {
        Self::with_prior(Covariance::identity(initial_covariance), estimate)
    }

    /// With the prior mean `estimate` and the prior covariance `covariance`.
    pub(crate) fn with_prior(covariance: Covariance, estimate: Impedance) -> Self {
        Self { estimate, covariance, uncertainty: UncertaintyPropagation::new(estimate) }
    }

    /// Moves the estimate by `gain * innovation` and takes `covariance`, both or neither; where either is unsound, the
    /// covariance starts anew.
    #[inline(always)]
    pub(crate) fn commit(
        &mut self,
        gain: Impedance,
        innovation: f32,
        covariance: Covariance,
        initial_covariance: f32,
    ) -> Flags {
        self.commit_or(gain, innovation, covariance, Covariance::identity(initial_covariance))
    }

    /// The same, with the covariance that it starts anew from.
    #[inline(always)]
    pub(crate) fn commit_or(
        &mut self,
        gain: Impedance,
        innovation: f32,
        covariance: Covariance,
        initial: Covariance,
    ) -> Flags {
        let estimate = self.estimate.moved(innovation, gain);
        if covariance.is_sound() && estimate.is_finite() {
            (self.estimate, self.covariance) = (estimate, covariance);
            Flags::empty()
        } else {
            self.covariance = initial;
            Flags::RESET
        }
    }

    /// The same where nothing is out of the ordinary: both are finite, and the covariance needs no limit. Else nothing is taken.
    #[inline(always)]
    pub(crate) fn commit_plain(
        &mut self,
        gain: Impedance,
        innovation: f32,
        covariance: Covariance,
        limit: f32,
    ) -> bool {
        self.commit_where(covariance.is_plain(limit), gain, innovation, covariance)
    }

    /// The same with a limit of its own for the factor of each parameter.
    #[inline(always)]
    pub(crate) fn commit_plain_each(
        &mut self,
        gain: Impedance,
        innovation: f32,
        covariance: Covariance,
        limits: Impedance,
    ) -> bool {
        self.commit_where(covariance.is_plain_each(limits), gain, innovation, covariance)
    }

    #[inline(always)]
    fn commit_where(&mut self, plain: bool, gain: Impedance, innovation: f32, covariance: Covariance) -> bool {
        let estimate = self.estimate.moved(innovation, gain);
        // A sum that is finite has no part that is not. The other two factors of a plain covariance are finite.
        let total = estimate.stiffness + estimate.damping + covariance.off_diagonal();
        let plain = plain && total.is_finite();
        if plain {
            (self.estimate, self.covariance) = (estimate, covariance);
        }
        plain
    }

    /// The outcome of an update; `forgetting` sets over how many samples fill and excitation are measured.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        o: &Observation,
        gain: Impedance,
        innovation: f32,
        forgetting: f32,
        flags: Flags,
    ) -> Step {
        let forgetting = smaller(forgetting, MAX_FORGETTING);
        self.uncertainty.advance_to(self.estimate, o, gain, innovation, forgetting, flags)
    }
}

impl RecursiveState {
    /// [`Self::step`] without its outcome: the fill.
    #[inline(always)]
    pub(crate) fn propagate(&mut self, o: &Observation, gain: Impedance, innovation: f32, forgetting: f32) -> f32 {
        let forgetting = smaller(forgetting, MAX_FORGETTING);
        self.uncertainty.advance(o, gain, innovation, forgetting);
        self.uncertainty.fill(forgetting)
    }

    /// The confidence in the present estimate.
    pub(crate) fn confidence(&self) -> Confidence {
        self.uncertainty.confidence(self.estimate)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sym2::Sym2;

    const START: Impedance = Impedance { stiffness: 3.0, damping: 4.0 };
    const GAIN: Impedance = Impedance { stiffness: 2.0, damping: 1.0 };

    #[test]
    fn a_sound_step_is_taken_whole() {
        let mut state = RecursiveState::new(10.0, START);
        assert_eq!(state.commit(GAIN, 0.5, Covariance::diagonal(1.0, 2.0), 10.0), Flags::empty());
        assert_eq!(state.estimate, Impedance { stiffness: 4.0, damping: 4.5 });
        assert_eq!(state.covariance.matrix(), Sym2::diagonal(1.0, 2.0));
    }

    #[test]
    fn an_unsound_covariance_is_never_taken_and_the_covariance_begins_anew() {
        for wrong in [
            Covariance::diagonal(-1.0, 2.0),
            Covariance::diagonal(1.0, -2.0),
            Covariance::diagonal(0.0, 2.0),
            Covariance::diagonal(f32::NAN, 2.0),
            Covariance::diagonal(1.0, f32::INFINITY),
        ] {
            let mut state = RecursiveState::new(10.0, START);
            state.covariance = Covariance::diagonal(5.0, 6.0);
            assert_eq!(state.commit(GAIN, 0.5, wrong, 10.0), Flags::RESET, "{wrong:?}");
            assert_eq!(state.estimate, START, "{wrong:?}");
            assert_eq!(state.covariance, Covariance::identity(10.0), "{wrong:?}");
            let mut state = RecursiveState::new(10.0, START);
            assert!(!state.commit_plain(GAIN, 0.5, wrong, 100.0), "{wrong:?}");
            assert_eq!((state.estimate, state.covariance), (START, Covariance::identity(10.0)), "{wrong:?}");
        }
    }

    #[test]
    fn an_estimate_that_is_not_finite_is_never_taken_and_the_covariance_begins_anew() {
        for innovation in [f32::INFINITY, f32::NAN, f32::MAX] {
            let mut state = RecursiveState::new(10.0, START);
            let sound = Covariance::diagonal(1.0, 2.0);
            assert_eq!(state.commit(GAIN, innovation, sound, 7.0), Flags::RESET, "{innovation}");
            assert_eq!((state.estimate, state.covariance), (START, Covariance::identity(7.0)), "{innovation}");
        }
    }

    #[test]
    fn what_needs_a_limit_is_left_to_the_full_update() {
        let mut state = RecursiveState::new(10.0, START);
        assert!(!state.commit_plain(GAIN, 0.5, Covariance::diagonal(60.0, 50.0), 100.0));
        assert_eq!((state.estimate, state.covariance), (START, Covariance::identity(10.0)));
        assert!(state.commit_plain(GAIN, 0.5, Covariance::diagonal(60.0, 40.0), 100.0));
        assert_eq!(state.covariance, Covariance::diagonal(60.0, 40.0));
    }

    #[test]
    fn an_estimate_is_finite_where_its_sum_is() {
        let commit = |stiffness, damping| {
            let mut state = RecursiveState::new(10.0, Impedance { stiffness, damping });
            state.commit_plain(GAIN, 0.0, Covariance::diagonal(1.0, 2.0), 10.0)
        };
        assert!(commit(1e30, 1e30) && commit(3e38, -3e38) && commit(-1e30, 1e30));
        assert!(!commit(3e38, 3e38) && !commit(-3e38, -3e38));
    }

    #[test]
    fn covariances_are_checked_at_their_limits() {
        for (initial, limit, accepted) in [
            (10.0, 10.0, true),
            (10.0, 9.9, false),
            (1e8, 1e9, true),
            (1e8, 1.1e9, false),
            (1.1e8, 1e9, false),
            (0.0, 1e9, false),
            (f32::NAN, 1e9, false),
            (10.0, f32::NAN, false),
        ] {
            assert_eq!(check_covariance(initial, limit).is_ok(), accepted, "{initial} {limit}");
        }
        assert!(check_initial_covariance(1e8).is_ok() && check_initial_covariance(1.1e8).is_err());
        assert!(check_initial_covariance(-1.0).is_err());
    }
}
