//! What the folder of an investigation holds, and what it is resumed from.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::test_bed::Ending;
use crate::diagnose::Found;
use crate::error::InputError;
use crate::experiment_design::Limits;
use crate::outfile::OutFile;

/// Layout of [`Investigation`].
pub const SCHEMA: &str = "palpate.investigation/1";

/// The file of an investigation in its folder.
pub const FILE: &str = "investigation.json";

/// An investigation as far as it came.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Investigation {
    /// [`SCHEMA`].
    pub schema: String,
    /// What decides it.
    pub setup: Setup,
    /// The rounds so far; round 0 is what was given.
    pub rounds: Vec<Round>,
    /// Why it ended; `None` while it can go on.
    pub outcome: Option<Outcome>,
}

/// What decides an investigation: another setup is another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    /// SHA-256 of the rig file and of each recording that was given.
    pub inputs_sha256: Vec<String>,
    /// The test bed.
    pub on: String,
    /// Limits of each trial.
    pub limits: Limits,
    /// Seed of diagnosis and noise.
    pub seed: u64,
}

/// One round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Its number; 0: what was given.
    pub number: u64,
    /// The trial that was designed and run; `None` in round 0.
    pub trial: Option<TrialRecord>,
    /// The diagnosis of everything recorded until then; `None` where it was not reached.
    pub state: Option<State>,
}

/// A trial as it was designed and as it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialRecord {
    /// Why this motion, in a sentence.
    pub why: String,
    /// What the motions are, in order.
    pub motions: Vec<String>,
    /// What was open, and the energy that was expected for each, of 12 that decide.
    pub questions: Vec<(String, f64)>,
    /// Share of the states in reach that it was to add.
    pub new_states: f64,
    /// Share of speed and depth that it was limited to after a trial that was cut off.
    pub ease: f64,
    /// How it ended.
    pub ending: Ending,
    /// What was wrong with the recording, if anything.
    pub faults: Vec<String>,
    /// Whether the diagnosis takes the recording.
    pub is_used: bool,
    /// Greatest share of each limit: position, speed, force, effort.
    pub used_limits: [f64; 4],
}

/// What a diagnosis came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The verdict, in its word.
    pub verdict: String,
    /// One sentence.
    pub summary: String,
    /// Names of the answer.
    pub physics: Vec<String>,
    /// Sets of names that the data do not rule out.
    pub alternatives: Vec<Vec<String>>,
    /// Values of the answer with their 95 % intervals.
    pub values: Vec<ValueState>,
    /// What is open, in words.
    pub open: Vec<String>,
    /// Residual with the answer over the expected noise.
    pub residual_over_noise: f64,
}

/// A value with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValueState {
    /// Its effect.
    pub effect: String,
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The estimate.
    pub value: f64,
    /// 95 % interval; `None` where it is open.
    pub ci95: Option<[f64; 2]>,
}

/// Why an investigation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// One explanation is left, its values are known, and a trial has confirmed it.
    Decided,
    /// No motion within the limits is expected to tell more.
    NothingMore,
    /// All rounds were spent.
    RoundsSpent,
    /// The test bed failed twice in a row.
    BedFailed,
}

impl Outcome {
    /// As a sentence.
    #[must_use]
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Decided => "One explanation is left, and a trial designed against it has confirmed it.",
            Self::NothingMore => "No motion within the limits is expected to tell more.",
            Self::RoundsSpent => "All rounds are spent.",
            Self::BedFailed => "The test bed failed twice in a row.",
        }
    }
}

impl State {
    /// Of `found`, with what it leaves open in words.
    #[must_use]
    pub fn of(found: &Found, open: Vec<String>) -> Self {
        let answer = &found.answer;
        let values = answer.physics.iter().flat_map(|physics| {
            physics.parameters.iter().map(|value| ValueState {
                effect: physics.name.clone(),
                name: value.name.clone(),
                unit: value.unit.clone(),
                value: value.value,
                ci95: value.ci95.iter().all(|end| end.is_finite()).then_some(value.ci95),
            })
        });
        let verdict = serde_json::to_value(answer.verdict).ok().and_then(|word| word.as_str().map(str::to_owned));
        Self {
            verdict: verdict.unwrap_or_default(),
            summary: answer.summary.clone(),
            physics: answer.physics.iter().map(|physics| physics.name.clone()).collect(),
            alternatives: answer.alternatives.iter().map(|alternative| alternative.physics.clone()).collect(),
            values: values.filter(|value| value.value.is_finite()).collect(),
            open,
            residual_over_noise: finite(answer.fit.improved / answer.fit.noise_floor),
        }
    }
}

/// JSON has no infinity: where nothing was expected, nothing is said.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

impl Investigation {
    /// A new one.
    #[must_use]
    pub fn new(setup: Setup) -> Self {
        Self { schema: SCHEMA.to_owned(), setup, rounds: Vec::new(), outcome: None }
    }

    /// The one in `folder`, or a new one where the folder holds none.
    ///
    /// # Errors
    /// The folder holds an investigation of another setup, or a file that is none.
    pub fn open(folder: &Path, setup: Setup) -> Result<Self> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(Self::new(setup));
        }
        let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let wrong = |found: String, expected: &str| InputError::new(path.display(), found, expected);
        let found: Self = serde_json::from_str(&text).map_err(|error| wrong(error.to_string(), SCHEMA))?;
        ensure!(found.schema == SCHEMA, wrong(found.schema, SCHEMA));
        let expected = "the same rig file, recordings, limits, seed and --on, or another folder for --out";
        ensure!(found.setup == setup, wrong("an investigation of other inputs".to_owned(), expected));
        Ok(found)
    }

    /// Writes it into `folder`.
    ///
    /// # Errors
    /// The place cannot be written.
    pub fn save(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self).context("the investigation cannot be written as JSON")? + "\n";
        write(&folder.join(FILE), text.as_bytes())
    }

    /// The diagnosis that was reached last.
    #[must_use]
    pub fn last_state(&self) -> Option<&State> {
        self.rounds.iter().rev().find_map(|round| round.state.as_ref())
    }
}

/// The folder of round `number` in `folder`.
#[must_use]
pub fn round_folder(folder: &Path, number: u64) -> PathBuf {
    folder.join(format!("round-{number}"))
}

/// Writes a file in whole or not at all.
///
/// # Errors
/// The place cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = OutFile::create(path)?;
    file.write_all(bytes).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}
