//! How far a value can be trusted: by what replicates of the answer make of it.

use statrs::statistics::Statistics as _;

use super::verdict::Assessment;
use crate::diagnose::bootstrap::fitted_model::{FittedModel, near};
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData};
use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Channels, index};

/// A value without the bias that replicates show, and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalEstimate {
    /// The value.
    pub value: f64,
    /// Ends of the interval.
    pub ends: [f64; 2],
}

/// Of every value of `fitted_model`'s model.
///
/// A replicate is made from known values; what the fit makes of it, less those, is the error of the method: its mean is a bias,
/// which is taken off, its spread the interval. What the recording shows beyond the replicates' residual widens the interval, and
/// so does what two halves of it disagree about, what the law leaves beside what it takes, and a fraction of a sample that
/// the fit gave to a clock: it may belong to the value as well.
#[must_use]
pub fn estimates(
    problem: &IdentificationProblem,
    fitted_model: &FittedModel,
    assessment: &Assessment,
) -> Vec<IntervalEstimate> {
    let axes =
        levenberg_marquardt::parameter_bounds(&fitted_model.model, &fitted_model.values, &fitted_model.excitation);
    let count = fitted_model.replicates.len().max(2) as f64;
    let wider = fitted_model.power_ratio().max(1.0).sqrt();
    let (clocks, laws) = (timing_uncertainty(problem, fitted_model), model_error(problem, fitted_model, assessment));
    let cut = fitted_model.model.effort_limit(&fitted_model.values, 0).is_some();
    (0..fitted_model.values.len())
        .map(|at| {
            let mean = fitted_model.replicates.iter().map(|summary| summary.shift[at]).sum::<f64>() / count;
            let variance =
                fitted_model.replicates.iter().map(|summary| (summary.shift[at] - mean).powi(2)).sum::<f64>()
                    / (count - 1.0);
            let noise = student_quantile_975(count - 1.0) * wider * (variance * (1.0 + 1.0 / count)).sqrt();
            // Two halves of the data that differ by more than noise say how far the law itself can be trusted: half their
            // difference is the deviation of their mean.
            let apart = match assessment.improved.taught.as_slice() {
                [first, second] => NORMAL_QUANTILE_975 * 0.5 * (first[at] - second[at]).abs(),
                _ => 0.0,
            };
            let half = noise.hypot(apart).hypot(laws[at]) + clocks[at];
            let (low, high) = (axes[at].low, axes[at].high);
            // Replicates of a drive that was cut keep its commands, which no filter has passed, beside a motion that has passed
            // one: what they are biased by is not what the recording is.
            let fitted = if cut {
                fitted_model.values[at]
            } else {
                near(&fitted_model.model, &fitted_model.values, at, fitted_model.generating_values[at] - mean)
            };
            let value = fitted.clamp(low, high);
            // What was fitted is not excluded by what replicates say of its bias: they are only as good as the law.
            let (first, last) =
                ((value - half).min(fitted_model.values[at]), (value + half).max(fitted_model.values[at]));
            IntervalEstimate { value, ends: [first.max(low), last.min(high)] }
        })
        .collect()
}

/// By how much each value would move if the clocks ran as the recording says, to first order: what the fit gave to them is
/// told apart from the values by the shape of the laws alone, and sensors sample as they like.
fn timing_uncertainty(problem: &IdentificationProblem, fitted_model: &FittedModel) -> Vec<f64> {
    let (model, values) = (&fitted_model.model, &fitted_model.values);
    let mut moves = vec![0.0; values.len()];
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let axes = levenberg_marquardt::parameter_bounds(model, values, &fitted_model.excitation);
    let base = data.residual(model, values, Channels::BOTH);
    let columns = levenberg_marquardt::jacobian(&data, model, values, &axes, &base);
    let is_clock = |at: usize| at == index::FORCE_TIMING || at == index::EFFORT_TIMING;
    let (clocks, others): (Vec<_>, Vec<_>) = columns.into_iter().partition(|(at, _)| is_clock(*at));
    for (clock, column) in clocks {
        let Some(parts) = solve(&others, &column) else { continue };
        others.iter().zip(parts.iter()).for_each(|((at, _), part)| moves[*at] += (part * values[clock]).abs());
    }
    moves
}

/// What the laws may miss of each value of theirs: as much of it as they leave, beyond noise, of what they take.
fn model_error(problem: &IdentificationProblem, fitted_model: &FittedModel, assessment: &Assessment) -> Vec<f64> {
    let energies: Vec<f64> = fitted_model.replicates.iter().map(|summary| summary.energy).collect();
    let (mean, deviation) = (energies.iter().mean(), energies.iter().std_dev());
    let left = (fitted_model.summary.energy - mean - 2.0 * deviation).max(0.0);
    let mut missed = vec![0.0; fitted_model.values.len()];
    let trials = problem.nominal.trials();
    for named in &assessment.named {
        let share = (left / named.gain.max(f64::MIN_POSITIVE)).min(1.0).sqrt();
        let own = missed.iter_mut().zip(&fitted_model.values).skip(fitted_model.model.first_value_of(named.at));
        own.take(named.term.all_parameters(trials).len()).for_each(|(missed, value)| *missed = share * value.abs());
    }
    missed
}

/// The 97.5 % point of the normal distribution.
const NORMAL_QUANTILE_975: f64 = 1.959_964;

/// The 97.5 % point of Student's t with `freedom` degrees, to a part in a thousand from 8 on (Abramowitz and Stegun 26.7.5).
fn student_quantile_975(freedom: f64) -> f64 {
    NORMAL_QUANTILE_975
        + (NORMAL_QUANTILE_975.powi(3) + NORMAL_QUANTILE_975) / (4.0 * freedom)
        + (5.0 * NORMAL_QUANTILE_975.powi(5) + 16.0 * NORMAL_QUANTILE_975.powi(3) + 3.0 * NORMAL_QUANTILE_975)
            / (96.0 * freedom * freedom)
}
