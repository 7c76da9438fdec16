//! From recordings to uniform trials: refuses what cannot be analysed, estimates the sensors' noise, sets the rate.

use anyhow::{Result, ensure};

use super::mains_tone;
use super::uniform_trial::UniformTrial;
use crate::diagnose::thresholds::prepare::MIN_TRIAL_ROWS;
use crate::error::{InputError, UsageError};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// What the sensors of `trials` show, on one clock.
///
/// # Errors
/// No channel that the rig predicts and every trial holds, or trials too short to tell anything.
pub fn sensed(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<Vec<UniformTrial>> {
    ensure_usable(rig, trials, origin)?;
    let period = common_period(trials);
    Ok(trials
        .iter()
        .map(|trial| without_mains_tone(rig, UniformTrial::of(trial, Figures::of(rig, trial), period), trial))
        .collect())
}

/// `raw` of `trial`, its figures estimated without a tone of the mains, which is no noise.
fn without_mains_tone(rig: &Rig, raw: UniformTrial, trial: &Recording) -> UniformTrial {
    let Some(tone) = mains_tone::detect(&raw) else { return raw };
    let mut quiet = trial.clone();
    if let Some(force) = &mut quiet.force {
        force.iter_mut().zip(&trial.time).for_each(|(force, time)| *force -= tone.at(time - raw.origin));
    }
    UniformTrial { figures: Figures::of(rig, &quiet), ..raw }
}

/// The longest period of `trials`, s.
#[must_use]
pub fn common_period(trials: &[Recording]) -> f64 {
    trials.iter().map(Recording::period).fold(0.0, f64::max)
}

/// Refuses trials that cannot be analysed.
///
/// # Errors
/// No trial, a trial of a few rows, or none of the rig's channels in them.
pub fn ensure_usable(rig: &Rig, trials: &[Recording], origin: &str) -> Result<()> {
    ensure!(!trials.is_empty(), UsageError::new("TRIAL.csv", "none", "at least one recording"));
    if let Some(short) = trials.iter().find(|trial| trial.time.len() < MIN_TRIAL_ROWS) {
        let found = format!("{} rows", short.time.len());
        let expected = format!("at least {MIN_TRIAL_ROWS}, and some hundreds to tell much");
        anyhow::bail!(InputError::new(&short.name, found, expected));
    }
    let has = |pick: &dyn Fn(&Recording) -> bool| trials.iter().all(pick);
    let force = rig.contact.is_some() && has(&|trial| trial.force.is_some());
    let effort = rig.drive.is_some() && has(&|trial| trial.effort.is_some());
    if !force && !effort {
        let found = "no [contact] with a force recorded in every trial, and no [drive] with an effort";
        anyhow::bail!(InputError::new(
            origin,
            found,
            "at least one channel that the rig predicts and every trial holds"
        ));
    }
    Ok(())
}
