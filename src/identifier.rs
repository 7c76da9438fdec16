//! The whole way from sensor readings to an estimate, for one law.

use crate::contact::{Impedance, Sample};
use crate::error::{ConfigError, require};
use crate::front_end::Rejection;
use crate::quality::{Estimate, Flags};
use crate::recursive::{CusumRls, CusumRlsConfig};
use crate::stream::{EstimatorState, Stream, StreamConfig};
use crate::update_law::UpdateLaw;

/// Front end, ring of `N` observations, one law.
///
/// `N` is the law's window, or 1 for a recursive law; a longer ring costs memory only.
///
/// The default law is [`CusumRls`]: of all that are here it alone is quick at a touch and at a jump of K, quiet in between, free of
/// bias behind the matched filter, and needs no window. [`Identifier::recommended`] has it with its settings. The measurements are
/// in `docs/paper.md`; `palpate reproduce` makes them again. Others for other jobs:
///
/// - [`crate::AdaptiveWindow`] or [`crate::BlockLeastSquares`] where the estimate has to rest on a stretch of time that can be named;
/// - [`crate::Ewrls`] with a factor near 1 where nothing ever changes;
/// - [`crate::BlockLeastMeanFourth`] along Newton's direction where the noise is bounded and never spikes;
/// - [`crate::DirectionalRls`] for a tool that is often held still.
#[derive(Debug, Clone)]
pub struct Identifier<L: UpdateLaw = CusumRls, const N: usize = 1> {
    stream: Stream<N>,
    tracker: EstimatorState<L>,
}

impl Identifier {
    /// The law to take where no other is asked for: [`CusumRls`] with its default settings.
    ///
    /// # Errors
    /// The first field of `config` that is out of range.
    pub fn recommended(config: StreamConfig) -> Result<Self, ConfigError> {
        Self::new(config, CusumRls::new(CusumRlsConfig::default())?)
    }
}

impl<const N: usize> Identifier<CusumRls, N> {
    /// As [`Self::update`], without what an interval takes, a third of the instructions: K and B in SI, zero out of contact, with
    /// every flag but [`Flags::STIFFNESS_UNCERTAIN`] and [`Flags::DAMPING_UNCERTAIN`], which come of the interval.
    /// [`Self::half_width`] tells the interval whenever it is asked for; the uncertainty is followed in any case.
    ///
    /// The estimate and its interval are those of [`Self::update`] to the bit, and either may be called for each sample. Only an
    /// estimate that [`Self::update`] holds over a gap right after this has an infinite interval.
    ///
    /// # Errors
    /// As [`Self::update`].
    pub fn update_estimate(&mut self, sample: Sample) -> Result<(Impedance, Flags), Rejection> {
        match self.stream.update_in_contact(&sample) {
            Some(flags) => Ok(self.tracker.learn_estimate(&self.stream, flags)),
            None => self.update_estimate_otherwise(&sample),
        }
    }

    /// [`Self::update_estimate`] for any sample. Apart, so that the usual one does not pay for it.
    #[inline(never)]
    fn update_estimate_otherwise(&mut self, sample: &Sample) -> Result<(Impedance, Flags), Rejection> {
        let event = self.stream.update(*sample)?;
        Ok(match self.tracker.settle(&self.stream, &event) {
            Some(estimate) => {
                (estimate.impedance, estimate.flags - Flags::STIFFNESS_UNCERTAIN - Flags::DAMPING_UNCERTAIN)
            }
            None => self.tracker.learn_estimate(&self.stream, event.flags),
        })
    }

    /// Half-widths of the 95 % intervals of the present K and B [N/m, N s/m; N m/rad, N m s/rad]: [`Estimate::half_width`]. Infinite where
    /// nothing is known, zero out of contact. After a gap in time at which nothing was discarded it is that of the estimate before.
    pub fn half_width(&self) -> Impedance {
        if self.stream.touches() { self.tracker.half_width(&self.stream) } else { Impedance::ZERO }
    }
}

impl<L: UpdateLaw, const N: usize> Identifier<L, N> {
    /// Checks the settings against each other.
    ///
    /// # Errors
    /// The first field that is out of range, or a window longer than `N`.
    pub fn new(config: StreamConfig, law: L) -> Result<Self, ConfigError> {
        require(law.window() <= N, "window", "at most N, the ring's capacity")?;
        Ok(Self { stream: Stream::new(config)?, tracker: EstimatorState::new(law) })
    }

    /// One sample: bounded work, no allocation, no panic. Call it from the interrupt.
    ///
    /// # Errors
    /// Why the sample was rejected. Then nothing but the clock has moved, and the next good sample goes on.
    pub fn update(&mut self, sample: Sample) -> Result<Estimate, Rejection> {
        match self.stream.update_in_contact(&sample) {
            Some(flags) => Ok(self.tracker.learn(&self.stream, flags)),
            None => self.update_otherwise(&sample),
        }
    }

    /// [`Self::update`] for any sample. Apart, so that the usual one does not pay for it.
    #[inline(never)]
    fn update_otherwise(&mut self, sample: &Sample) -> Result<Estimate, Rejection> {
        let event = self.stream.update(*sample)?;
        Ok(self.tracker.update(&self.stream, &event))
    }

    /// What the law has learnt.
    pub fn state(&self) -> &L::State {
        self.tracker.state()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockConfig, BlockLeastSquares};

    fn law(window: u16) -> BlockLeastSquares {
        BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings")
    }

    /// Onset, K that jumps, loss, samples that are refused, a gap, and an onset again: K, B and their intervals are the same bits
    /// whether the interval is told with the update or asked for behind it.
    #[test]
    fn an_interval_that_is_asked_for_is_the_one_that_is_told() {
        let mut told = Identifier::recommended(StreamConfig::BENCH).expect("sound settings");
        let (mut asked, mut mixed) = (told.clone(), told.clone());
        let (mut finite, mut infinite, mut away) = (0, 0, 0);
        let of_interval = Flags::STIFFNESS_UNCERTAIN | Flags::DAMPING_UNCERTAIN;
        for k in 0..3_000_u16 {
            let triangle = f32::from(k % 40) - 20.0;
            let depth = if k % 900 < 700 { 0.01 + 1e-4 * triangle.abs() } else { -0.01 };
            let stiffness = if k % 900 < 400 { 300.0 } else { 900.0 };
            let elapsed = match k {
                _ if k % 100 == 99 => f32::NAN,
                1200 => 3.0,
                _ => 1e-3,
            };
            let force = stiffness * depth.max(0.0) + 1e-3 * f32::from(k % 7);
            let sample = Sample { position: depth, force, elapsed };
            let expected = told.update(sample);
            let found = asked.update_estimate(sample);
            let Ok(expected) = expected else {
                assert_eq!(found, Err(expected.expect_err("refused")));
                let _ = mixed.update(sample);
                continue;
            };
            assert_eq!(found, Ok((expected.impedance, expected.flags - of_interval)), "at {k}");
            assert_eq!(asked.half_width(), expected.half_width, "at {k}");
            // In turn: also what is held over the gap, but for its interval.
            let [impedance, half_width] = if k % 2 == 0 {
                mixed.update(sample).map(|e| [e.impedance, e.half_width]).expect("a sample")
            } else {
                let (impedance, _) = mixed.update_estimate(sample).expect("a sample");
                [impedance, mixed.half_width()]
            };
            assert_eq!(impedance, expected.impedance, "at {k}");
            if k != 1200 {
                assert_eq!(half_width, expected.half_width, "at {k}");
            }
            match expected.half_width.stiffness {
                0.0 => away += 1,
                width if width.is_finite() => finite += 1,
                _ => infinite += 1,
            }
        }
        assert!(finite > 2_000 && infinite >= 4 && away > 500, "{finite} {infinite} {away}");
    }

    #[test]
    fn a_window_longer_than_the_ring_is_refused() {
        assert!(Identifier::<_, 24>::new(StreamConfig::BENCH, law(24)).is_ok());
        let refused = Identifier::<_, 24>::new(StreamConfig::BENCH, law(25)).expect_err("one sample too many");
        assert_eq!(refused.parameter, "window");
    }
}
