//! The experiment that would tell the answer from its alternatives.

mod separating_experiment;

use schemars::JsonSchema;
use serde::Serialize;

pub use separating_experiment::{separated_by, shown_beside};

/// A trajectory to run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Experiment {
    /// What it is and what it would tell.
    pub text: String,
    /// Seconds.
    pub time: Vec<f64>,
    /// Commanded position.
    pub reference: Vec<f64>,
}
