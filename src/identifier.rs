//! The whole way from sensor readings to an estimate, for one law.

use crate::contact::Sample;
use crate::error::{ConfigError, require};
use crate::estimate::Estimate;
use crate::front_end::Rejection;
use crate::law::Law;
use crate::stream::{Stream, StreamConfig, Tracker};

/// Front end, ring of `N` observations, one law.
///
/// `N` is the law's window, or 1 for a recursive law; a longer ring costs memory only.
#[derive(Debug, Clone)]
pub struct Identifier<L: Law, const N: usize> {
    stream: Stream<N>,
    tracker: Tracker<L>,
}

impl<L: Law, const N: usize> Identifier<L, N> {
    /// Checks the settings against each other.
    ///
    /// # Errors
    /// The first field that is out of range, or a window longer than `N`.
    pub fn new(config: StreamConfig, law: L) -> Result<Self, ConfigError> {
        require(law.window() <= N, "window", "at most N, the ring's capacity")?;
        Ok(Self { stream: Stream::new(config)?, tracker: Tracker::new(law) })
    }

    /// One sample: bounded work, no allocation, no panic. Call it from the interrupt.
    ///
    /// # Errors
    /// Why the sample was rejected. Then nothing but the clock has moved, and the next good sample goes on.
    pub fn update(&mut self, sample: Sample) -> Result<Estimate, Rejection> {
        let event = self.stream.update(sample)?;
        Ok(self.tracker.follow(&self.stream, &event))
    }

    /// What the law has learnt.
    pub fn state(&self) -> &L::State {
        self.tracker.state()
    }
}
