//! `palpate diagnose`: where simulation and recording differ, and why.
//!
//! The recordings are checked ([`check`]) and brought onto one clock, every channel through the same filter ([`signals`]).
//! The rig's model ([`model`]) is fitted ([`estimation`]); simulated replicas of it show what the sensors alone would leave
//! ([`bootstrap`]). Effects are added until nothing worth it is left, and a verdict is given ([`selection`]), with the
//! experiment that would separate what is left undecided ([`experiment`]). [`report`] writes it down.
//!
//! Dependencies run one way, in this order: [`linalg`], [`signals`], [`model`], [`estimation`], [`bootstrap`], [`selection`],
//! [`report`], [`command`]; the tuned numbers of all stand in [`thresholds`]. [`check`] depends on [`signals`] alone; [`experiment`] on all up to [`bootstrap`].

pub mod bootstrap;
pub mod check;
pub mod command;
pub mod contact;
pub mod drive;
pub mod estimation;
pub mod experiment;
pub mod linalg;
pub mod model;
pub mod report;
pub mod selection;
pub mod signals;
pub mod thresholds;

use anyhow::{Context as _, Result, bail};

pub use command::{DiagnoseArgs, run};
pub use signals::prepare::sensed;

use crate::effects::{self, Place};
use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use bootstrap::problem::IdentificationProblem;
use bootstrap::sampler::BootstrapSampler;
use drive::named::NamedEffect;
use drive::outcome::Outcome;
use report::build_report::{self, DiagnosisInputs};
pub use report::diagnosis::Diagnosis;
use report::diagnosis::PlotData;
use report::merge::{self, Report};
use report::{drive_report, refined_rig};
use selection::{confidence_interval, forward_selection, verdict};
use signals::bandwidth::analysis_filters;
use signals::prepare::{common_period, decimate_to_need};
use signals::uniform_trial::UniformTrial;

/// What `diagnose` found.
pub struct Found {
    /// As JSON.
    pub answer: Diagnosis,
    /// For the page.
    pub pictures: PlotData,
    /// The improved rig.
    pub improved: Rig,
}

/// Diagnoses `trials` against `rig`; `origin` names the rig file in errors, `say` is told how it goes.
///
/// The same input and seed give the same answer to the bit.
///
/// # Errors
/// No channel that the rig predicts and every trial holds, trials too short to tell anything, or effects in the rig file
/// that cannot be.
pub fn diagnose(
    rig: &Rig,
    origin: &str,
    trials: &[Recording],
    simulation: &[Recording],
    seed: u64,
    say: &dyn Fn(&str),
) -> Result<Found> {
    say("reading the sensors");
    let uniform_trials = sensed(rig, origin, trials)?;
    let findings = check::check(rig, trials, &uniform_trials);
    let known = effects::resolve_all(rig, origin)?;
    let is_touching = rig.contact.is_some() && trials.iter().all(|trial| trial.force.is_some());
    let by_force = |rig: &Rig| contact(rig, origin, trials, simulation, seed, say);
    let mut contact = is_touching.then(|| by_force(&contact_rig(rig, &[]))).transpose()?;
    let drive = drive::prepare::is_recorded(rig, trials).then(|| {
        let zeroed = contact.as_ref().map(|contact| zeroed(&contact.improved, trials));
        identified(rig, zeroed.as_deref().unwrap_or(trials), known, seed, say)
    });
    let mut drive = drive.flatten();
    let found = drive.as_ref().map(drive_report::found).unwrap_or_default();
    let sensors: Vec<NamedEffect> =
        found.into_iter().filter(|found| CARRIED_BY_THE_DRIVE.contains(&found.name())).collect();
    if is_touching && !sensors.is_empty() {
        contact = Some(by_force(&contact_rig(rig, &sensors))?);
    }
    if let (Some(contact), Some(drive)) = (&contact, &mut drive) {
        drive.leave_to_the_contact(|name| told_by(&contact.answer, name));
    }
    let Some((mut report, improved)) = together(rig, contact, drive.as_ref()) else {
        bail!(InputError::new(origin, "recordings in which nothing moves, or of too few rows", NEEDED));
    };
    report.0.findings.splice(0..0, findings);
    let (answer, pictures) = report;
    Ok(Found { answer, pictures, improved })
}

/// What a diagnosis needs.
const NEEDED: &str = "a force in contact, or some hundred rows of an effort that moves the drive";

/// What the recordings say of the drive; effects that the rig already holds are nominal.
fn identified(
    rig: &Rig,
    trials: &[Recording],
    known: Vec<effects::Resolved>,
    seed: u64,
    say: &dyn Fn(&str),
) -> Option<Outcome> {
    let nominal = drive::prepare::nominal(rig, trials, known)?;
    drive::outcome::identify(drive::prepare::trials(rig, trials), &nominal, seed, say)
}

/// Effects of the force sensor that the drive tells better than the contact does: force and position alone show them as other values.
const CARRIED_BY_THE_DRIVE: [&str; 2] = ["force_gain", "tool_inertia"];

/// The rig without its drive, which has a model of its own; `sensors` is what that found of the force sensor, and known to the contact.
fn contact_rig(rig: &Rig, sensors: &[NamedEffect]) -> Rig {
    let mut contact = rig.clone();
    contact.drive = None;
    contact.effects.retain(|table| effects::find(&table.name).is_none_or(|e| e.spec().place != Place::Drive));
    contact.effects.extend(sensors.iter().map(|effect| drive_report::table(effect, rig.coordinate)));
    contact
}

/// `trials` with the zero of the force sensor taken off, as the contact found it: the drive would take it for a load.
fn zeroed(improved: &Rig, trials: &[Recording]) -> Vec<Recording> {
    let zeros: Vec<effects::Resolved> = effects::resolve_all(improved, "the improved rig")
        .unwrap_or_default()
        .into_iter()
        .filter(|effect| ["force_bias", "force_drift"].contains(&effect.effect.spec().name))
        .collect();
    let zeroed = |trial: &Recording| {
        let mut trial = trial.clone();
        let Some(force) = &mut trial.force else { return trial };
        let (start, step) = (0.0, (trial.time[trial.time.len() - 1] - trial.time[0]) / (trial.time.len() - 1) as f64);
        for zero in &zeros {
            // What the sensor shows of no force at all.
            let mut shown = vec![0.0; force.len()];
            let acceleration = vec![0.0; force.len()];
            let mut reading = effects::Reading {
                start,
                step,
                filter_width: 0.0,
                added_filter_width: 0.0,
                acceleration: &acceleration,
                force: &mut shown,
            };
            zero.effect.act_on_reading(zero.form, &zero.values, &mut reading);
            force.iter_mut().zip(&shown).for_each(|(force, shown)| *force -= shown);
        }
        trial
    };
    if zeros.is_empty() { trials.to_vec() } else { trials.iter().map(zeroed).collect() }
}

/// Whether `answer` names `name`, or what a slow sensor and a late one have in common.
fn told_by(answer: &Diagnosis, name: &str) -> bool {
    let names = |name: &str| answer.physics.iter().any(|physics| physics.name == name);
    names(name) || (name == "channel_delay" && names("force_lag"))
}

/// One report and one rig from those of the contact and of the drive.
fn together(rig: &Rig, contact: Option<Found>, drive: Option<&Outcome>) -> Option<(Report, Rig)> {
    let drive = drive.map(|outcome| (drive_report::drive_report(outcome, rig), outcome));
    match (contact, drive) {
        (None, None) => None,
        (Some(contact), None) => {
            let improved = Rig { drive: rig.drive, ..contact.improved };
            Some(((contact.answer, contact.pictures), improved))
        }
        (None, Some((report, outcome))) => Some((report, drive_report::refined(rig, rig, outcome))),
        (Some(contact), Some((report, outcome))) => {
            let improved = drive_report::refined(rig, &contact.improved, outcome);
            let both = merge::merged((contact.answer, contact.pictures), report, rig.coordinate);
            Some((both, improved))
        }
    }
}

/// Diagnoses the contact of `trials` by their force alone.
fn contact(
    rig: &Rig,
    origin: &str,
    trials: &[Recording],
    simulation: &[Recording],
    seed: u64,
    say: &dyn Fn(&str),
) -> Result<Found> {
    let without_effort = |trials: &[Recording]| -> Vec<Recording> {
        trials.iter().map(|trial| Recording { effort: None, ..trial.clone() }).collect()
    };
    let (trials, simulation) = (&without_effort(trials), &without_effort(simulation));
    let problem = problem(rig, origin, sensed(rig, origin, trials)?, seed)?;
    let mut search = forward_selection::search(&problem, say);
    let assessment = verdict::assess(&problem, &mut search, say).context("nothing was searched")?;
    say("the report");
    let handed = (!simulation.is_empty()).then(|| {
        let period = common_period(trials);
        let parts = (problem.sampler.contact_filter.period / period).round() as usize;
        let simulated = |run: &Recording| UniformTrial::of(run, Figures::of(rig, run), period).thinned(parts);
        let simulated: Vec<UniformTrial> = simulation.iter().map(simulated).collect();
        build_report::residuals_of_simulation(&problem, &simulated)
    });
    let fitted_model = &search.rounds.last().context("nothing was searched")?.fitted_model;
    let estimates = confidence_interval::estimates(&problem, fitted_model, &assessment);
    let improved = refined_rig::refined_rig(rig, &problem, fitted_model, &assessment, &estimates);
    let (problem, search, assessment, estimates) = (&problem, &search, &assessment, &estimates);
    let parts = DiagnosisInputs { rig, problem, search, assessment, estimates, handed };
    let (answer, pictures) = build_report::build_report(parts).context("no channel was left to look at")?;
    Ok(Found { answer, pictures, improved })
}

/// The trials `uniform_trials` as they are looked at, and the nominal model that they are held against.
///
/// # Errors
/// Effects in the rig file that cannot be.
pub fn problem(rig: &Rig, origin: &str, uniform_trials: Vec<UniformTrial>, seed: u64) -> Result<IdentificationProblem> {
    let uniform_trials = decimate_to_need(rig, uniform_trials);
    let (contact, drive) = analysis_filters(rig, &uniform_trials);
    Ok(IdentificationProblem::new(rig, origin, BootstrapSampler::new(uniform_trials, contact, drive, seed))?)
}
