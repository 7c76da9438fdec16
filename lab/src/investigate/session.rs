//! The loop: diagnose, design, run, record, and again.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context as _, Result, bail};

use super::monitor::hold_against;
use super::questions::{has_unknown, questions, words};
use super::record::{Investigation, Outcome, Round, State, TrialRecord, round_folder, write};
use super::separating_trial::{capitalized, explanations_of, noise};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::diagnose::{Found, diagnose};
use crate::experiment_design::discrimination::Noise;
use crate::experiment_design::loop_model::LoopModel;
use crate::experiment_design::planner::Situation;
use crate::experiment_design::{Explanation, Limits, Plan, Question, plan};
use crate::recording::Recording;
use crate::rig::{Coordinate, Rig};

/// Shortest recording that a diagnosis takes, s.
const MIN_SECONDS: f64 = 2.0;

/// Share of rows at the greatest effort from which a recording counts as saturated.
const SATURATED_SHARE: f64 = 0.05;

/// What a trial is eased by after one that was cut off or saturated.
const EASE_AFTER_STOP: f64 = 0.6;

/// An investigation at work.
pub struct Session<'a> {
    /// The simulation that is held against the recordings.
    pub rig: &'a Rig,
    /// Names the rig file in errors.
    pub origin: &'a str,
    /// What was given to begin with.
    pub given: &'a [Recording],
    /// Where everything is written.
    pub folder: &'a Path,
    /// Most trials that are run.
    pub rounds: u64,
    /// Set once the user wants to stop.
    pub interrupted: &'a AtomicBool,
    /// Receives messages of progress.
    pub say: &'a dyn Fn(&str),
}

/// Where an investigation stands between two trials.
struct Standing {
    found: Option<Found>,
    explanations: Vec<Explanation>,
    questions: Vec<(Question, String)>,
    noise: Noise,
    closed_loop: LoopModel,
    trials: Vec<Recording>,
}

impl Session<'_> {
    /// Goes on with `investigation` on `bed` until it ends or the user stops it, and writes each round as it is there.
    ///
    /// # Errors
    /// A file that cannot be written, a test bed that cannot be used, or recordings of which no diagnosis can be made.
    pub fn run(&self, investigation: &mut Investigation, bed: &mut dyn TestBed) -> Result<Option<Found>> {
        let mut trials = self.recorded(investigation)?;
        if investigation.rounds.is_empty() {
            investigation.rounds.push(Round { number: 0, trial: None, state: None });
        }
        let mut standing = self.stand(&trials, investigation)?;
        loop {
            self.note(investigation, &standing)?;
            investigation.outcome = self.outcome(investigation, &standing);
            if investigation.outcome.is_some() || self.is_interrupted() {
                break;
            }
            (self.say)("designing the next trial");
            let ease = ease(investigation);
            let closed = is_confirmed(investigation, &standing);
            let plan = self.plan(&standing, &investigation.setup.limits, ease);
            let Some(plan) = plan.filter(|plan| !closed || plan.searches_on()) else {
                investigation.outcome = Some(if closed { Outcome::Decided } else { Outcome::NothingMore });
                break;
            };
            let number = investigation.rounds.len() as u64;
            let (trial, recording) = self.trial(bed, &plan, &standing, investigation, number, ease)?;
            investigation.rounds.push(Round { number, trial: Some(trial), state: None });
            investigation.save(self.folder)?;
            trials.extend(recording);
            if self.is_interrupted() {
                break;
            }
            standing = self.stand(&trials, investigation)?;
        }
        investigation.save(self.folder)?;
        Ok(standing.found)
    }

    fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// What was given, and what earlier rounds of `investigation` recorded and the diagnosis takes.
    fn recorded(&self, investigation: &Investigation) -> Result<Vec<Recording>> {
        let mut trials = self.given.to_vec();
        let used = |round: &&Round| round.trial.as_ref().is_some_and(|trial| trial.is_used);
        for round in investigation.rounds.iter().filter(used) {
            trials.push(Recording::read(&recording_file(self.folder, round.number), self.rig)?);
        }
        Ok(trials)
    }

    /// Diagnoses `trials` and fits what is left open.
    fn stand(&self, trials: &[Recording], investigation: &mut Investigation) -> Result<Standing> {
        let closed_loop = LoopModel::new(self.rig, trials);
        let mut trials = trials.to_vec();
        if trials.is_empty() {
            let alone = Explanation { physics: Vec::new(), rig: self.rig.clone() };
            let noise = Noise::of(self.rig, &[], [0.0; 2]);
            return Ok(Standing {
                found: None,
                explanations: vec![alone],
                questions: Vec::new(),
                noise,
                closed_loop,
                trials,
            });
        }
        let seed = investigation.setup.seed;
        (self.say)("diagnosing");
        let found = match diagnose(self.rig, self.origin, &trials, &[], seed, self.say) {
            Ok(found) => found,
            // A recording of this run must not end it: without it, what was known stays known.
            Err(error) if trials.len() > self.given.len().max(1) => {
                trials.pop();
                if let Some(trial) = investigation.rounds.last_mut().and_then(|round| round.trial.as_mut()) {
                    trial.is_used = false;
                    trial.faults.push(format!("the diagnosis cannot take it: {error:#}"));
                }
                diagnose(self.rig, self.origin, &trials, &[], seed, self.say)?
            }
            Err(error) => return Err(error),
        };
        let noise = noise(self.rig, &trials, &found);
        (self.say)("fitting the alternatives");
        let explanations = explanations_of(&found, &trials, &closed_loop, &noise);
        let questions = questions(&found, &explanations);
        Ok(Standing { found: Some(found), explanations, questions, noise, closed_loop, trials })
    }

    /// Writes what a diagnosis came to.
    fn note(&self, investigation: &mut Investigation, standing: &Standing) -> Result<()> {
        if let (Some(found), Some(round)) = (&standing.found, investigation.rounds.last_mut()) {
            let mut open: Vec<String> = standing.questions.iter().map(|(_, words)| words.clone()).collect();
            if has_unknown(&found.answer) {
                open.push("structure that no listed effect explains".to_owned());
            }
            round.state = Some(State::of(found, open));
            let folder = round_folder(self.folder, round.number);
            std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
            let json =
                serde_json::to_string_pretty(&found.answer).context("the diagnosis cannot be written as JSON")?;
            write(&folder.join("diagnosis.json"), (json + "\n").as_bytes())?;
            write(&folder.join("improved.toml"), found.improved.to_toml().as_bytes())?;
            (self.say)(&format!("round {}: {}", round.number, found.answer.summary));
        }
        investigation.save(self.folder)
    }

    /// Why it ends here, if it does.
    fn outcome(&self, investigation: &Investigation, standing: &Standing) -> Option<Outcome> {
        let failed = |round: &Round| {
            round.trial.as_ref().is_some_and(|trial| !trial.is_used && matches!(trial.ending, Ending::Failed(_)))
        };
        let rounds = &investigation.rounds;
        if rounds.len() >= 2 && rounds[rounds.len() - 2..].iter().all(failed) {
            return Some(Outcome::BedFailed);
        }
        let spent = rounds.len() as u64 > self.rounds;
        let closed = is_confirmed(investigation, standing);
        spent.then_some(if closed { Outcome::Decided } else { Outcome::RoundsSpent })
    }

    fn plan(&self, standing: &Standing, limits: &Limits, ease: f64) -> Option<Plan> {
        let questions: Vec<Question> = standing.questions.iter().map(|(question, _)| question.clone()).collect();
        let situation = Situation {
            explanations: &standing.explanations,
            questions: &questions,
            trials: &standing.trials,
            limits,
            noise: standing.noise,
            closed_loop: standing.closed_loop,
            ease,
            searches: true,
        };
        plan(&situation).filter(Plan::is_worth_running)
    }

    /// Runs `plan` on `bed`: what is noted of it, and the recording where it is of use.
    fn trial(
        &self,
        bed: &mut dyn TestBed,
        plan: &Plan,
        standing: &Standing,
        investigation: &Investigation,
        number: u64,
        ease: f64,
    ) -> Result<(TrialRecord, Option<Recording>)> {
        let folder = round_folder(self.folder, number);
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let rate_hz = standing.closed_loop.rate_hz;
        let reference_file = folder.join("reference.csv");
        write(&reference_file, reference_csv(&plan.reference, rate_hz, self.rig).as_bytes())?;
        let why = why(plan, standing);
        (self.say)(&format!("round {number}: {why}"));
        let recording_file = recording_file(self.folder, number);
        let request = TrialRequest {
            reference: &plan.reference,
            rate_hz,
            limits: &investigation.setup.limits,
            reference_file: &reference_file,
            recording_file: &recording_file,
            interrupted: self.interrupted,
            round: number,
        };
        let TrialOutcome { recording, mut ending } = bed.run(&request)?;
        let (violation, used_limits) = recording
            .as_ref()
            .map_or((None, [0.0; 4]), |recording| hold_against(recording, &investigation.setup.limits));
        if let (Some(violation), Ending::Completed) = (violation, &ending) {
            ending = Ending::Stopped(violation);
        }
        let faults = recording.as_ref().map_or_else(Vec::new, |recording| self.faults(recording, standing, plan));
        let recording =
            recording.map(|recording| Recording { name: format!("round-{number}/recording.csv"), ..recording });
        if let Some(recording) = &recording {
            recording.write(&recording_file, self.rig)?;
        }
        let usable = recording.filter(is_long_enough);
        let questions = standing.questions.iter().map(|(_, words)| words.clone()).zip(plan.expected.iter().copied());
        let record = TrialRecord {
            why,
            motions: plan.motions.clone(),
            questions: questions.collect(),
            new_states: plan.new_states,
            ease,
            ending,
            faults,
            is_used: usable.is_some(),
            used_limits,
        };
        Ok((record, usable))
    }

    /// What is wrong with a recording, in words.
    fn faults(&self, recording: &Recording, standing: &Standing, plan: &Plan) -> Vec<String> {
        let mut faults = Vec::new();
        if !is_long_enough(recording) {
            faults.push(format!("less than {MIN_SECONDS} s of it: it is left out"));
        } else if recording.time.len() + 1 < plan.reference.len() {
            let share = 100.0 * recording.time.len() as f64 / plan.reference.len() as f64;
            faults.push(format!("only the first {share:.0} % of it were recorded"));
        }
        if saturated_share(recording) > SATURATED_SHARE {
            faults.push("the effort is at its limit for long: the next trial is gentler".to_owned());
        }
        let contact = standing.explanations[0].rig.contact.filter(|contact| !contact.bilateral);
        let planned = plan.reference.iter().fold(f64::NEG_INFINITY, |most, x| most.max(*x));
        let quiet = |force: &Vec<f64>| {
            let peak = force.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            standing.noise.force.is_some_and(|noise| peak < 5.0 * noise)
        };
        if contact.is_some_and(|contact| planned > contact.surface) && recording.force.as_ref().is_some_and(quiet) {
            faults.push("nothing was touched".to_owned());
        }
        faults
    }
}

/// Whether nothing is open, and a trial that was made against the answer has left it as it was.
fn is_confirmed(investigation: &Investigation, standing: &Standing) -> bool {
    let Some(found) = &standing.found else { return false };
    let open = has_unknown(&found.answer) || !found.answer.alternatives.is_empty() || !standing.questions.is_empty();
    let states: Vec<&State> = investigation.rounds.iter().filter_map(|round| round.state.as_ref()).collect();
    !open && matches!(states.as_slice(), [.., before, now] if before.physics == now.physics)
}

/// Where the recording of round `number` is.
fn recording_file(folder: &Path, number: u64) -> PathBuf {
    round_folder(folder, number).join("recording.csv")
}

fn is_long_enough(recording: &Recording) -> bool {
    let [first, .., last] = recording.time.as_slice() else { return false };
    last - first >= MIN_SECONDS
}

/// Share of rows at the greatest effort, where that is met more than once.
fn saturated_share(recording: &Recording) -> f64 {
    let Some(effort) = &recording.effort else { return 0.0 };
    let most = effort.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let count = effort.iter().filter(|value| value.abs() >= 0.9999 * most).count();
    if most > 0.0 { count as f64 / effort.len() as f64 } else { 0.0 }
}

/// Share of speed and depth that the next trial may use: less after each that was cut off or saturated.
fn ease(investigation: &Investigation) -> f64 {
    let last = investigation.rounds.iter().rev().find_map(|round| round.trial.as_ref());
    last.map_or(1.0, |trial| {
        let harsh =
            matches!(trial.ending, Ending::Stopped(_)) || trial.faults.iter().any(|fault| fault.contains("gentler"));
        if harsh { EASE_AFTER_STOP * trial.ease } else { 1.0 }
    })
}

/// Why this motion, in a sentence.
fn why(plan: &Plan, standing: &Standing) -> String {
    let answered = standing.questions.iter().zip(&plan.expected).filter(|(_, energy)| **energy >= 1.0);
    let mut reasons: Vec<String> = answered.map(|((_, words), _)| words.clone()).collect();
    let unasked = standing.questions.len() - reasons.len();
    if plan.new_states >= 0.01 {
        reasons.push(format!("{:.0} % of the states in reach were not visited yet", 100.0 * plan.new_states));
    }
    if plan.departures >= 0.01 {
        let times = (2.0 * plan.departures).exp();
        reasons.push(format!(
            "listed effects could still be hidden, of which the recordings will then tell {times:.1} times as much"
        ));
    }
    let mut text = capitalized(&plan.motions.join("; then "));
    text.push_str(&format!(", because this is open: {}", reasons.join("; ")));
    if unasked > 0 {
        text.push_str(&format!("; {unasked} of the open questions it does not answer within the limits"));
    }
    if standing.found.as_ref().is_some_and(|found| has_unknown(&found.answer)) {
        text.push_str("; unknown structure is searched for in states that were not visited");
    }
    let names: Vec<String> = standing.explanations.iter().map(|one| words(&one.physics)).collect();
    text + &format!(
        ". The predicted motion keeps the limits with a margin under every explanation ({}).",
        names.join(", ")
    )
}

/// What a file calls the positions of a reference.
#[must_use]
pub fn reference_column(rig: &Rig) -> &'static str {
    if rig.coordinate == Coordinate::Rotary { "reference_rad" } else { "reference_m" }
}

/// The reference as a file: `t_s` and `reference_m` or `reference_rad`.
#[must_use]
pub fn reference_csv(reference: &[f64], rate_hz: f64, rig: &Rig) -> String {
    let mut text = format!("t_s,{}\n", reference_column(rig));
    for (row, position) in reference.iter().enumerate() {
        text += &format!("{},{position}\n", row as f64 / rate_hz);
    }
    text
}

/// The limits of an investigation without a file of them.
///
/// # Errors
/// There is no recording in which anything moves.
pub fn default_limits(given: &[Recording]) -> Result<Limits> {
    match Limits::of_recordings(given) {
        Some(limits) => Ok(limits),
        None => bail!(crate::error::UsageError::new(
            "--limits",
            "none, and no recording to take them from",
            "a file of limits, or a recording in which the rig moves"
        )),
    }
}
