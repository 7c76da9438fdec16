//! Two halves of the data, each judged by what the other half taught.
//!
//! Every trial is cut into stretches that belong to one half and the other in turn, so that early and late, deep and
//! shallow are in both. Hidden states run through all of it; only the residuals are kept apart.

use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData};
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::linalg::energy;
use crate::diagnose::model::{Channels, Model, Residual};
use crate::diagnose::thresholds::cross_validation::FOLD_SEGMENTS;
use crate::effects::{ExcitationStats, Place};

/// What a model leaves of data that its fit did not see.
#[derive(Debug, Clone)]
pub struct HeldOut {
    /// Whitened energy over all rows.
    pub energy: f64,
    /// Mean square of the residual over its expected noise, its memory left in, of force and effort.
    pub powers: [f64; 2],
    /// Residuals of every trial, each row by the values of the other half.
    pub residuals: Vec<Residual>,
    /// The values that each half taught; none where nothing was fitted.
    pub taught: Vec<Vec<f64>>,
}

/// Which half a moment belongs to.
fn fold_of(time: f64, duration: f64, trial: usize) -> usize {
    let stretch = (FOLD_SEGMENTS * time / duration.max(f64::MIN_POSITIVE)).floor().max(0.0) as usize;
    (stretch + trial) % 2
}

/// Fits `model` to either half from `start` and judges each by the other.
#[must_use]
pub fn cross_validate(
    problem: &IdentificationProblem,
    whitener: &Whitener,
    model: &Model,
    start: &[f64],
    excitation: &ExcitationStats,
) -> HeldOut {
    let trials = &problem.sampler.trials;
    let origins = whitener.origins();
    let halves: Vec<usize> = origins
        .iter()
        .map(|row| {
            let filtered = trials[row.trial].filtered(row.effort);
            fold_of(row.row as f64 * filtered.step, filtered.len() as f64 * filtered.step, row.trial)
        })
        .collect();
    let values: Vec<Vec<f64>> = [0, 1]
        .iter()
        .map(|taught| {
            let rows: Vec<bool> = halves.iter().map(|half| half == taught).collect();
            let data = FitData { trials, whitener, rows: Some(&rows) };
            levenberg_marquardt::fit_with_prior(&data, model, start, excitation).values
        })
        .collect();
    evaluate_folds(problem, whitener, model, &values, &halves)
}

/// Residuals of `model` with `values[h]` taught by half h, each row judged by the half it is not in.
fn evaluate_folds(
    problem: &IdentificationProblem,
    whitener: &Whitener,
    model: &Model,
    values: &[Vec<f64>],
    halves: &[usize],
) -> HeldOut {
    let trials = &problem.sampler.trials;
    let by: Vec<Vec<Residual>> = values
        .iter()
        .map(|values| trials.iter().map(|trial| model.residual(values, trial, Channels::BOTH)).collect())
        .collect();
    let judged = |whitener: &Whitener| -> Vec<f64> {
        let whites = [whitener.whiten(&by[0]), whitener.whiten(&by[1])];
        halves.iter().enumerate().map(|(row, half)| whites[1 - half][row]).collect()
    };
    let energy = energy(&judged(whitener));
    let powers = whitener.powers(&judged(&whitener.without_autocorrelation()));
    let mix = |trial: usize, effort: bool| {
        let pick = |residual: &Residual| if effort { residual.effort.clone() } else { residual.force.clone() };
        let filtered = trials[trial].filtered(effort);
        let (first, second) = (pick(&by[0][trial]), pick(&by[1][trial]));
        let duration = filtered.len() as f64 * filtered.step;
        let judged = (0..first.len())
            .map(|at| if fold_of(at as f64 * filtered.step, duration, trial) == 0 { second[at] } else { first[at] });
        judged.collect()
    };
    let residuals =
        (0..trials.len()).map(|trial| Residual { force: mix(trial, false), effort: mix(trial, true) }).collect();
    HeldOut { energy, powers, residuals, taught: values.to_vec() }
}

/// The same for values that nothing was fitted to.
#[must_use]
pub fn as_given(problem: &IdentificationProblem, whitener: &Whitener, model: &Model, values: &[f64]) -> HeldOut {
    let residuals: Vec<Residual> =
        problem.sampler.trials.iter().map(|trial| model.residual(values, trial, Channels::BOTH)).collect();
    let powers = whitener.powers(&whitener.without_autocorrelation().whiten(&residuals));
    HeldOut { energy: energy(&whitener.whiten(&residuals)), powers, residuals, taught: Vec::new() }
}

/// Root mean square of the expected noise over the rows of a channel that were seen whole; `None` where the channel is not there.
#[must_use]
pub fn expected_noise_rms(problem: &IdentificationProblem, whitener: &Whitener, effort: bool) -> Option<f64> {
    let noise_model = if effort { whitener.effort.as_ref()? } else { whitener.force.as_ref()? };
    let residual = |values: &Vec<f64>| {
        if effort {
            Residual { force: Vec::new(), effort: values.clone() }
        } else {
            Residual { force: values.clone(), effort: Vec::new() }
        }
    };
    Some(rms(problem, &noise_model.deviation.iter().map(residual).collect::<Vec<_>>(), effort))
}

/// Root mean square over the rows of a channel that were seen whole.
#[must_use]
pub fn rms(problem: &IdentificationProblem, residuals: &[Residual], effort: bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0f64);
    for (trial, residual) in problem.sampler.trials.iter().zip(residuals) {
        let values = if effort { &residual.effort } else { &residual.force };
        for (value, _) in values.iter().zip(&trial.filtered(effort).valid).filter(|(_, valid)| **valid) {
            sum += value * value;
            count += 1.0;
        }
    }
    (sum / count.max(1.0)).sqrt()
}

/// Share of the energy on unseen data that is gone from `without` to `with`, in the channel in which it is more of those that an
/// effect at `place` reaches.
#[must_use]
pub fn explained_variance(problem: &IdentificationProblem, without: &HeldOut, with: &HeldOut, place: Place) -> f64 {
    let reach = problem.nominal.affected_channels(place);
    let share = |effort: bool| {
        let (before, after) = (rms(problem, &without.residuals, effort), rms(problem, &with.residuals, effort));
        if before > 0.0 { 1.0 - (after / before).powi(2) } else { 0.0 }
    };
    match (reach.force, reach.effort) {
        (true, true) => share(false).max(share(true)),
        (_, effort) => share(effort),
    }
}
