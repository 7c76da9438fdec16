//! One rig, put to three ways: the first recording alone, designed trials, and as many trials along fixed rich references.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};

use super::answer::Answer;
use crate::diagnose::diagnose;
use crate::experiment_design::Limits;
use crate::investigate::concealed_bed::stopped_by;
use crate::investigate::record::{Investigation, Setup, State, write};
use crate::investigate::session::{Session, reference_csv};
use crate::investigate::test_bed::TrialRequest;
use crate::investigate::watched_bed::{Watched, WatchedBed};
use crate::recording::Recording;
use crate::rig::Rig;

/// What an investigation knows of a rig, and where it works.
pub struct Subject<'a> {
    /// The simulation.
    pub rig: &'a Rig,
    /// Names the rig file in errors.
    pub origin: &'a str,
    /// What was recorded to begin with.
    pub given: &'a [Recording],
    /// Limits of every trial.
    pub limits: Limits,
    /// Where everything is written.
    pub folder: &'a Path,
    /// Most trials that are designed.
    pub rounds: u64,
}

/// What the three ways came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// After the first recording alone.
    pub first: Answer,
    /// After each designed trial.
    pub rounds: Vec<Answer>,
    /// After the first recording and as many along the fixed references.
    pub fixed: Answer,
    /// What was held against the limits.
    #[serde(default)]
    pub watched: Watched,
    /// Greatest share of each limit in a designed trial: position, speed, force, effort.
    pub used: [f64; 4],
    /// The same in the fixed trials.
    pub used_by_fixed: [f64; 4],
    /// Designed trials that the bed cut off, or whose recording passed a limit.
    pub stopped: usize,
    /// Seconds recorded in designed trials, and in fixed ones.
    pub recorded_s: [f64; 2],
    /// Why it ended.
    pub outcome: String,
    /// Seconds of the investigation.
    pub seconds: f64,
}

impl Comparison {
    /// Puts `subject` to all three: the designed trials run on `bed`, the fixed ones on `fixed_bed`, each of the same rig.
    ///
    /// # Errors
    /// A bed that cannot be used, a file that cannot be written, or a first recording of which no diagnosis can be made.
    pub fn run(subject: &Subject<'_>, bed: &mut dyn WatchedBed, fixed_bed: &mut dyn WatchedBed) -> Result<Self> {
        let begun = Instant::now();
        let investigation = subject.designed(bed)?;
        let seconds = begun.elapsed().as_secs_f64();
        let states = investigation.rounds.iter().filter_map(|round| round.state.as_ref());
        let mut answers = states.map(Answer::of);
        let first = answers.next().context("no diagnosis of the first recording")?;
        let rounds = answers.collect();
        let trials = investigation.rounds.len().saturating_sub(1);
        let fixed = subject.along_fixed(trials, fixed_bed)?.unwrap_or_else(|| first.clone());
        let stopped = investigation.rounds.iter().filter_map(|round| round.trial.as_ref());
        Ok(Self {
            first,
            rounds,
            fixed,
            watched: if fixed_bed.watched() == Watched::Recording { Watched::Recording } else { bed.watched() },
            used: bed.used(),
            used_by_fixed: fixed_bed.used(),
            stopped: stopped.filter(|trial| stopped_by(&trial.ending).is_some()).count(),
            recorded_s: [bed.seconds(), fixed_bed.seconds()],
            outcome: investigation.outcome.map(|outcome| outcome.sentence().to_owned()).unwrap_or_default(),
            seconds,
        })
    }

    /// After the last designed trial.
    #[must_use]
    pub fn last(&self) -> &Answer {
        self.rounds.last().unwrap_or(&self.first)
    }
}

impl Subject<'_> {
    fn designed(&self, bed: &mut dyn WatchedBed) -> Result<Investigation> {
        let setup = Setup { inputs_sha256: Vec::new(), on: bed.description(), limits: self.limits, seed: 1 };
        let mut investigation = Investigation::new(setup);
        let session = Session {
            rig: self.rig,
            origin: self.origin,
            given: self.given,
            folder: self.folder,
            rounds: self.rounds,
            interrupted: &AtomicBool::new(false),
            say: &|_| {},
        };
        session.run(&mut investigation, bed)?;
        Ok(investigation)
    }

    /// The answer after `count` trials along rich references; `None` where there are none, or no diagnosis of them.
    fn along_fixed(&self, count: usize, bed: &mut dyn WatchedBed) -> Result<Option<Answer>> {
        let mut trials = self.given.to_vec();
        for round in 0..count as u64 {
            trials.extend(self.fixed_trial(round, bed)?);
        }
        if count == 0 {
            return Ok(None);
        }
        let found = diagnose(self.rig, self.origin, &trials, &[], 1, &|_| {}).ok();
        Ok(found.map(|found| Answer::of(&State::of(&found, Vec::new()))))
    }

    /// What was recorded along the next rich reference; reference and recording stay in `fixed-N/`.
    fn fixed_trial(&self, round: u64, bed: &mut dyn WatchedBed) -> Result<Option<Recording>> {
        let folder = self.folder.join(format!("fixed-{round}"));
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let (reference, rate_hz) = (bed.rich_reference(), self.given[0].rate());
        let [reference_file, recording_file] = ["reference.csv", "recording.csv"].map(|name| folder.join(name));
        write(&reference_file, reference_csv(&reference, rate_hz, self.rig).as_bytes())?;
        let request = TrialRequest {
            reference: &reference,
            rate_hz,
            limits: &self.limits,
            reference_file: &reference_file,
            recording_file: &recording_file,
            interrupted: &AtomicBool::new(false),
            round,
        };
        let recording = bed.run(&request)?.recording;
        if let Some(recording) = &recording {
            recording.write(&recording_file, self.rig)?;
        }
        Ok(recording.map(|recording| Recording { name: format!("fixed-{round}.csv"), ..recording }))
    }
}
