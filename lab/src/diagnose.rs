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
pub mod estimation;
pub mod experiment;
pub mod linalg;
pub mod model;
pub mod report;
pub mod selection;
pub mod signals;
pub mod thresholds;

use anyhow::{Context as _, Result};

pub use command::{DiagnoseArgs, run};
pub use signals::prepare::sensed;

use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use bootstrap::problem::IdentificationProblem;
use bootstrap::sampler::BootstrapSampler;
use report::build_report::{self, DiagnosisInputs};
pub use report::diagnosis::Diagnosis;
use report::diagnosis::PlotData;
use report::refined_rig;
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
    let problem = problem(rig, origin, uniform_trials, seed)?;
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
    let parts = DiagnosisInputs { rig, problem, search, assessment, estimates, handed, findings };
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
