//! Two halves of the data, each judged by what the other half taught.
//!
//! Every trial is cut into stretches that belong to one half and the other in turn, so that early and late, deep and
//! shallow are in both. Hidden states run through all of it; only the residuals are kept apart.

use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data};
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::linalg::energy;
use crate::diagnose::model::{Channels, Model, Rest};
use crate::effects::{Place, Scene};

/// Stretches a trial is cut into.
const STRETCHES: f64 = 10.0;

/// What a model leaves of data that its fit did not see.
#[derive(Debug, Clone)]
pub struct HeldOut {
    /// Whitened energy over all rows.
    pub energy: f64,
    /// Mean square of the residual over its floor, its memory left in, of force and effort.
    pub powers: [f64; 2],
    /// Residuals of every trial, each row by the values of the other half.
    pub rests: Vec<Rest>,
    /// The values that each half taught; none where nothing was fitted.
    pub taught: Vec<Vec<f64>>,
}

/// Which half a moment belongs to.
fn half(time: f64, duration: f64, trial: usize) -> usize {
    let stretch = (STRETCHES * time / duration.max(f64::MIN_POSITIVE)).floor().max(0.0) as usize;
    (stretch + trial) % 2
}

/// Fits `model` to either half from `start` and judges each by the other.
#[must_use]
pub fn held_out(study: &Study, whitener: &Whitener, model: &Model, start: &[f64], scene: &Scene) -> HeldOut {
    let trials = &study.studio.trials;
    let origins = whitener.origins();
    let halves: Vec<usize> = origins
        .iter()
        .map(|row| {
            let track = trials[row.trial].track(row.effort);
            half(row.row as f64 * track.step, track.len() as f64 * track.step, row.trial)
        })
        .collect();
    let values: Vec<Vec<f64>> = [0, 1]
        .iter()
        .map(|taught| {
            let rows: Vec<bool> = halves.iter().map(|half| half == taught).collect();
            let data = Data { trials, whitener, rows: Some(&rows) };
            levenberg_marquardt::fit_part(&data, model, start, scene).values
        })
        .collect();
    frozen(study, whitener, model, &values, &halves)
}

/// Residuals of `model` with `values[h]` taught by half h, each row judged by the half it is not in.
fn frozen(study: &Study, whitener: &Whitener, model: &Model, values: &[Vec<f64>], halves: &[usize]) -> HeldOut {
    let trials = &study.studio.trials;
    let by: Vec<Vec<Rest>> = values
        .iter()
        .map(|values| trials.iter().map(|trial| model.rest(values, trial, Channels::BOTH)).collect())
        .collect();
    let judged = |whitener: &Whitener| -> Vec<f64> {
        let whites = [whitener.white(&by[0]), whitener.white(&by[1])];
        halves.iter().enumerate().map(|(row, half)| whites[1 - half][row]).collect()
    };
    let energy = energy(&judged(whitener));
    let powers = whitener.powers(&judged(&whitener.forgetful()));
    let mix = |trial: usize, effort: bool| {
        let pick = |rest: &Rest| if effort { rest.effort.clone() } else { rest.force.clone() };
        let track = trials[trial].track(effort);
        let (first, second) = (pick(&by[0][trial]), pick(&by[1][trial]));
        let duration = track.len() as f64 * track.step;
        let judged = (0..first.len())
            .map(|at| if half(at as f64 * track.step, duration, trial) == 0 { second[at] } else { first[at] });
        judged.collect()
    };
    let rests = (0..trials.len()).map(|trial| Rest { force: mix(trial, false), effort: mix(trial, true) }).collect();
    HeldOut { energy, powers, rests, taught: values.to_vec() }
}

/// The same for values that nothing was fitted to.
#[must_use]
pub fn as_given(study: &Study, whitener: &Whitener, model: &Model, values: &[f64]) -> HeldOut {
    let rests: Vec<Rest> = study.studio.trials.iter().map(|trial| model.rest(values, trial, Channels::BOTH)).collect();
    let powers = whitener.powers(&whitener.forgetful().white(&rests));
    HeldOut { energy: energy(&whitener.white(&rests)), powers, rests, taught: Vec::new() }
}

/// Root mean square of the floor over the rows of a channel that were seen whole; `None` where the channel is not there.
#[must_use]
pub fn floor(study: &Study, whitener: &Whitener, effort: bool) -> Option<f64> {
    let floor = if effort { whitener.effort.as_ref()? } else { whitener.force.as_ref()? };
    let rest = |values: &Vec<f64>| {
        if effort {
            Rest { force: Vec::new(), effort: values.clone() }
        } else {
            Rest { force: values.clone(), effort: Vec::new() }
        }
    };
    Some(rms(study, &floor.deviation.iter().map(rest).collect::<Vec<_>>(), effort))
}

/// Root mean square over the rows of a channel that were seen whole.
#[must_use]
pub fn rms(study: &Study, rests: &[Rest], effort: bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0f64);
    for (trial, rest) in study.studio.trials.iter().zip(rests) {
        let values = if effort { &rest.effort } else { &rest.force };
        for (value, _) in values.iter().zip(&trial.track(effort).seen).filter(|(_, seen)| **seen) {
            sum += value * value;
            count += 1.0;
        }
    }
    (sum / count.max(1.0)).sqrt()
}

/// Share of the energy on unseen data that is gone from `without` to `with`, in the channel in which it is more of those that an
/// effect at `place` reaches.
#[must_use]
pub fn gone(study: &Study, without: &HeldOut, with: &HeldOut, place: Place) -> f64 {
    let reach = study.nominal.reach(place);
    let share = |effort: bool| {
        let (before, after) = (rms(study, &without.rests, effort), rms(study, &with.rests, effort));
        if before > 0.0 { 1.0 - (after / before).powi(2) } else { 0.0 }
    };
    match (reach.force, reach.effort) {
        (true, true) => share(false).max(share(true)),
        (_, effort) => share(effort),
    }
}
