//! `palpate diagnose`: where simulation and recording differ, and why.
//!
//! The recordings are checked ([`check`]) and brought onto one clock ([`raw`], [`unround`]); every channel is looked at
//! through the same filter ([`lens`], [`track`]). The rig's model ([`model`]) is fitted ([`fit`]), twins of it tell what the
//! sensors alone would leave ([`twin`], [`whiten`], [`chance`]), and every effect is asked what it could take of the rest
//! ([`score`], [`tones`], [`texture`], [`fold`]). The best is added until nothing worth it is left ([`stand`], [`select`]);
//! the judge names it, or owns that nothing explains the rest ([`judge`]).

pub mod answer;
pub mod chance;
pub mod check;
pub mod command;
pub mod compose;
pub mod experiment;
pub mod fit;
pub mod fold;
pub mod hum;
pub mod improved;
pub mod interval;
pub mod judge;
pub mod lens;
pub mod locate;
pub mod measure;
pub mod model;
pub mod phase;
pub mod product;
pub mod raw;
pub mod report;
pub mod score;
pub mod select;
pub mod sentence;
pub mod sharpness;
pub mod stand;
pub mod study;
pub mod texture;
pub mod tones;
pub mod track;
pub mod twin;
pub mod unround;
pub mod view;
pub mod whiten;

use anyhow::{Context as _, Result};

pub use command::{DiagnoseArgs, Found, run};

use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use compose::Parts;
use raw::Raw;
use sharpness::lenses;
use study::Study;
use twin::Studio;

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
    let mut search = select::search(&study, say);
    let judgement = judge::judge(&study, &mut search, say).context("nothing was searched")?;
    say("the report");
    let handed = (!simulation.is_empty()).then(|| {
        let period = common_period(trials);
        let parts = (study.studio.lens.period / period).round() as usize;
        let simulated = |run: &Recording| Raw::of(run, Figures::of(rig, run), period).thinned(parts);
        let simulated: Vec<Raw> = simulation.iter().map(simulated).collect();
        compose::handed_rests(&study, &simulated)
    });
    let stand = &search.rounds.last().context("nothing was searched")?.stand;
    let estimates = interval::estimates(&study, stand, &judgement);
    let improved = improved::rig_of(rig, &study, stand, &judgement, &estimates);
    let (study, search, judgement, estimates) = (&study, &search, &judgement, &estimates);
    let parts = Parts { rig, study, search, judgement, estimates, handed, findings };
    let (answer, pictures) = compose::compose(parts).context("no channel was left to look at")?;
    Ok(Found { answer, pictures, improved })
}

/// What the sensors of `trials` show, on one clock.
///
/// # Errors
/// No channel that the rig predicts and every trial holds, or trials too short to tell anything.
pub fn sensed(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<Vec<Raw>> {
    command::ensure_usable(rig, trials, origin)?;
    let period = common_period(trials);
    Ok(trials.iter().map(|trial| listened(rig, Raw::of(trial, Figures::of(rig, trial), period), trial)).collect())
}

/// `raw` of `trial`, its figures told without a tone of the mains, which is no noise.
fn listened(rig: &Rig, raw: Raw, trial: &Recording) -> Raw {
    let Some(tone) = hum::heard(&raw) else { return raw };
    let mut quiet = trial.clone();
    if let Some(force) = &mut quiet.force {
        force.iter_mut().zip(&trial.time).for_each(|(force, time)| *force -= tone.at(time - raw.origin));
    }
    Raw { figures: Figures::of(rig, &quiet), hum: Some(tone.frequency), ..raw }
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

/// Rows that are looked at, a period of the sharpest filter's -3 dB frequency: their mean takes 0.4 % there, of all channels
/// alike.
const ENOUGH: f64 = 20.0;

/// `raws` at a rate that the filters need: twins of a million rows would show nothing that those of their means do not.
fn afforded(rig: &Rig, raws: Vec<Raw>) -> Vec<Raw> {
    let (contact, drive) = lenses(rig, &raws);
    let corner = contact.first().corner().max(drive.first().corner());
    let parts = raws.first().map_or(1.0, |raw| 1.0 / (raw.period * ENOUGH * corner)) as usize;
    if parts < 3 {
        return raws;
    }
    let odd = parts - 1 + parts % 2;
    raws.iter().map(|raw| raw.thinned(odd)).collect()
}

fn common_period(trials: &[Recording]) -> f64 {
    trials.iter().map(Recording::period).fold(0.0, f64::max)
}
