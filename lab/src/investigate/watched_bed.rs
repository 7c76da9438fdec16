//! A test bed that tells what its trials used of the limits.

use serde::{Deserialize, Serialize};

use super::test_bed::TestBed;

/// What is held against the limits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Watched {
    /// What really happened, which neither sensors nor the investigation see.
    #[default]
    TrueMotion,
    /// What was recorded: the bed tells nothing else.
    Recording,
}

/// A test bed that is watched apart from the investigation, and that has rich references of its own.
pub trait WatchedBed: TestBed {
    /// Greatest share of each limit that was used, over all trials: position, speed, force, effort; above one, it was passed.
    fn used(&self) -> [f64; 4];

    /// Of what these are the shares.
    fn watched(&self) -> Watched;

    /// Seconds of all trials.
    fn seconds(&self) -> f64;

    /// The next rich reference: positions in m or rad, one a row of the recordings.
    fn rich_reference(&mut self) -> Vec<f64>;
}
