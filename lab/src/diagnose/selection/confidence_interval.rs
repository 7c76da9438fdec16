//! How far a value can be trusted: by what twins of the answer make of it.

use statrs::statistics::Statistics as _;

use super::verdict::Judgement;
use crate::diagnose::bootstrap::fitted_model::{Stand, near};
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data};
use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Channels, index};

/// A value without the bias that twins show, and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Ends of the interval.
    pub ends: [f64; 2],
}

/// Of every value of `stand`'s model.
///
/// A twin is made from known values; what the fit makes of it, less those, is the error of the method: its mean is a bias,
/// which is taken off, its spread the interval. What the recording shows beyond the twins' residual widens the interval, and
/// so does what two halves of it disagree about, what the law leaves beside what it takes, and a fraction of a sample that
/// the fit gave to a clock: it may belong to the value as well.
#[must_use]
pub fn estimates(study: &Study, stand: &Stand, judgement: &Judgement) -> Vec<Estimate> {
    let axes = levenberg_marquardt::axes(&stand.model, &stand.values, &stand.scene);
    let count = stand.twins.len().max(2) as f64;
    let wider = stand.power_ratio().max(1.0).sqrt();
    let (clocks, laws) = (clocks(study, stand), laws(study, stand, judgement));
    let cut = stand.model.effort_limit(&stand.values, 0).is_some();
    (0..stand.values.len())
        .map(|at| {
            let mean = stand.twins.iter().map(|view| view.shift[at]).sum::<f64>() / count;
            let variance = stand.twins.iter().map(|view| (view.shift[at] - mean).powi(2)).sum::<f64>() / (count - 1.0);
            let noise = student(count - 1.0) * wider * (variance * (1.0 + 1.0 / count)).sqrt();
            // Two halves of the data that differ by more than noise say how far the law itself can be trusted: half their
            // difference is the deviation of their mean.
            let apart = match judgement.improved.taught.as_slice() {
                [first, second] => Z * 0.5 * (first[at] - second[at]).abs(),
                _ => 0.0,
            };
            let half = noise.hypot(apart).hypot(laws[at]) + clocks[at];
            let (low, high) = (axes[at].low, axes[at].high);
            // Twins of a drive that was cut keep its commands, which no filter has passed, beside a motion that has passed
            // one: what they are biased by is not what the recording is.
            let fitted =
                if cut { stand.values[at] } else { near(&stand.model, &stand.values, at, stand.origin[at] - mean) };
            let value = fitted.clamp(low, high);
            // What was fitted is not excluded by what twins say of its bias: they are only as good as the law.
            let (first, last) = ((value - half).min(stand.values[at]), (value + half).max(stand.values[at]));
            Estimate { value, ends: [first.max(low), last.min(high)] }
        })
        .collect()
}

/// By how much each value would move if the clocks ran as the recording says, to first order: what the fit gave to them is
/// told apart from the values by the shape of the laws alone, and sensors sample as they like.
fn clocks(study: &Study, stand: &Stand) -> Vec<f64> {
    let (model, values) = (&stand.model, &stand.values);
    let mut moves = vec![0.0; values.len()];
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let axes = levenberg_marquardt::axes(model, values, &stand.scene);
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
fn laws(study: &Study, stand: &Stand, judgement: &Judgement) -> Vec<f64> {
    let energies: Vec<f64> = stand.twins.iter().map(|view| view.energy).collect();
    let (mean, deviation) = (energies.iter().mean(), energies.iter().std_dev());
    let left = (stand.view.energy - mean - 2.0 * deviation).max(0.0);
    let mut missed = vec![0.0; stand.values.len()];
    let trials = study.nominal.trials();
    for named in &judgement.named {
        let share = (left / named.gain.max(f64::MIN_POSITIVE)).min(1.0).sqrt();
        let own = missed.iter_mut().zip(&stand.values).skip(stand.model.start_of(named.at));
        own.take(named.term.all_parameters(trials).len()).for_each(|(missed, value)| *missed = share * value.abs());
    }
    missed
}

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_964;

/// The 97.5 % point of Student's t with `freedom` degrees, to a part in a thousand from 8 on (Abramowitz and Stegun 26.7.5).
fn student(freedom: f64) -> f64 {
    Z + (Z.powi(3) + Z) / (4.0 * freedom) + (5.0 * Z.powi(5) + 16.0 * Z.powi(3) + 3.0 * Z) / (96.0 * freedom * freedom)
}
