//! A bed on which the three ways are compared.

use crate::investigate::test_bed::TestBed;

/// A test bed that is watched apart from the investigation, and that has rich references of its own.
pub trait WatchedBed: TestBed {
    /// Greatest share of each limit that was used, over all trials: position, speed, force, effort; above one, it was passed.
    fn used(&self) -> [f64; 4];

    /// Seconds of all trials.
    fn seconds(&self) -> f64;

    /// The next rich reference: positions in m or rad, one a row of the recordings.
    fn rich_reference(&mut self) -> Vec<f64>;
}
