//! What a trial is run on.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use anyhow::Result;
use serde::{Deserialize, Serialize};

use super::monitor::Violation;
use crate::experiment_design::Limits;
use crate::recording::Recording;

/// How a trial ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "how", content = "why")]
pub enum Ending {
    /// The whole reference was run.
    Completed,
    /// A limit came too near, and the rig was brought to rest.
    Stopped(Violation),
    /// The user stopped it, and the rig was brought to rest.
    Interrupted,
    /// There is no recording, or only a part of one.
    Failed(String),
}

/// What came of a trial.
#[derive(Debug, Clone)]
pub struct TrialOutcome {
    /// What was recorded until it ended.
    pub recording: Option<Recording>,
    /// How it ended.
    pub ending: Ending,
}

/// A trial to be run.
pub struct TrialRequest<'a> {
    /// Positions to be commanded, one a row.
    pub reference: &'a [f64],
    /// Rows a second.
    pub rate_hz: f64,
    /// What must not be passed.
    pub limits: &'a Limits,
    /// The file that holds the reference.
    pub reference_file: &'a Path,
    /// Where the recording will be.
    pub recording_file: &'a Path,
    /// Set once the user wants to stop.
    pub interrupted: &'a AtomicBool,
    /// Number of the round, which decides the noise of a simulated one.
    pub round: u64,
}

/// A rig on which a reference can be run.
pub trait TestBed {
    /// What it is, for people.
    fn description(&self) -> String;

    /// Runs a trial, and leaves the rig at rest however it ends.
    ///
    /// # Errors
    /// The bed cannot be used at all; what goes wrong within a trial is its ending.
    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome>;
}
