//! The whole way from sensor readings to an estimate, for one law.

use crate::contact::Sample;
use crate::error::{ConfigError, require};
use crate::front_end::Rejection;
use crate::quality::Estimate;
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
        let event = self.stream.update(sample)?;
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

    #[test]
    fn a_window_longer_than_the_ring_is_refused() {
        assert!(Identifier::<_, 24>::new(StreamConfig::BENCH, law(24)).is_ok());
        let refused = Identifier::<_, 24>::new(StreamConfig::BENCH, law(25)).expect_err("one sample too many");
        assert_eq!(refused.parameter, "window");
    }
}
