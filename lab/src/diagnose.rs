//! `palpate diagnose`: where simulation and recording differ, and why.
//!
//! The recordings are checked ([`check`]) and brought onto one clock, every channel through the same filter ([`signals`]).
//! The rig's model ([`model`]) is fitted ([`estimation`]); simulated replicas of it show what the sensors alone would leave
//! ([`bootstrap`]). Effects are added until nothing worth it is left, and a verdict is given ([`selection`]), with the
//! experiment that would separate what is left undecided ([`experiment`]). [`report`] writes it down.
//!
//! Dependencies run one way, in this order: [`linalg`], [`signals`], [`model`], [`estimation`], [`bootstrap`], [`selection`],
//! [`report`], [`command`]. [`check`] depends on [`signals`] alone; [`experiment`] on all up to [`bootstrap`].

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

use anyhow::{Context as _, Result};

pub use command::{DiagnoseArgs, run};
pub use signals::prepare::sensed;

use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use bootstrap::problem::Study;
use bootstrap::sampler::Studio;
use report::build_report::{self, Parts};
use report::diagnosis::{Answer, Pictures};
use report::refined_rig;
use selection::{confidence_interval, forward_selection, verdict};
use signals::bandwidth::lenses;
use signals::prepare::{afforded, common_period};
use signals::uniform_trial::Raw;

/// What `diagnose` found.
pub struct Found {
    /// As JSON.
    pub answer: Answer,
    /// For the page.
    pub pictures: Pictures,
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
    let raws = sensed(rig, origin, trials)?;
    let findings = check::check(rig, trials, &raws);
    let study = study(rig, origin, raws, seed)?;
    let mut search = forward_selection::search(&study, say);
    let judgement = verdict::judge(&study, &mut search, say).context("nothing was searched")?;
    say("the report");
    let handed = (!simulation.is_empty()).then(|| {
        let period = common_period(trials);
        let parts = (study.studio.lens.period / period).round() as usize;
        let simulated = |run: &Recording| Raw::of(run, Figures::of(rig, run), period).thinned(parts);
        let simulated: Vec<Raw> = simulation.iter().map(simulated).collect();
        build_report::handed_rests(&study, &simulated)
    });
    let stand = &search.rounds.last().context("nothing was searched")?.stand;
    let estimates = confidence_interval::estimates(&study, stand, &judgement);
    let improved = refined_rig::rig_of(rig, &study, stand, &judgement, &estimates);
    let (study, search, judgement, estimates) = (&study, &search, &judgement, &estimates);
    let parts = Parts { rig, study, search, judgement, estimates, handed, findings };
    let (answer, pictures) = build_report::compose(parts).context("no channel was left to look at")?;
    Ok(Found { answer, pictures, improved })
}

/// The trials `raws` as they are looked at, and the nominal model that they are held against.
///
/// # Errors
/// Effects in the rig file that cannot be.
pub fn study(rig: &Rig, origin: &str, raws: Vec<Raw>, seed: u64) -> Result<Study> {
    let raws = afforded(rig, raws);
    let (contact, drive) = lenses(rig, &raws);
    Ok(Study::new(rig, origin, Studio::new(raws, contact, drive, seed))?)
}
