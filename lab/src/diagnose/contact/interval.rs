//! 95 % intervals of a fitted contact: from the curvature of least squares, and from leaving out stretches of the recordings.

use super::data::Data;
use super::fit::Fit;
use super::rest::Rest;
use crate::diagnose::interval::{Clusters, Intervals, spread};
use crate::diagnose::jackknife::stretch_of_rows;

/// The interval of each value of `fit`.
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, rest: &Rest) -> Intervals {
    let ranges = fit.model.ranges(&fit.values);
    let free: Vec<usize> = (0..fit.values.len()).filter(|at| ranges[*at].free).collect();
    let columns = data.columns(&fit.model, &fit.values, &ranges, &free, &rest.rows);
    let priors: Vec<f64> =
        free.iter().map(|at| ranges[*at].prior.map_or(0.0, |(_, sigma)| (ranges[*at].size / sigma).powi(2))).collect();
    let counts: Vec<Vec<bool>> =
        data.weights.iter().map(|trial| trial.iter().map(|weight| *weight > 0.0).collect()).collect();
    let stretch = stretch_of_rows(&counts);
    // Rounding is a function of the place, the same in whatever trial and however long after.
    let is_stepped = data.trials.iter().all(|trial| trial.encoder_steps.len() == trial.len());
    let place: Vec<i64> =
        data.trials.iter().filter(|_| is_stepped).flat_map(|trial| trial.encoder_steps.iter().copied()).collect();
    let found = spread(&rest.rows, &columns, &priors, rest.power, Clusters { stretch: &stretch, place: &place });
    let mut all: Vec<[f64; 2]> = fit.values.iter().map(|value| [*value; 2]).collect();
    let slope = |at: &usize| if ranges[*at].by_factors { fit.values[*at] } else { ranges[*at].size };
    let covariance = found.covariance_of(fit.values.len(), &free, &free.iter().map(slope).collect::<Vec<_>>());
    for (&at, steps) in free.iter().zip(found.half_widths) {
        let (range, value) = (&ranges[at], fit.values[at]);
        let [low, high] = if range.by_factors {
            let factor = steps.min(50.0).exp();
            [value / factor, value * factor]
        } else {
            let half = range.size * steps;
            [value - half, value + half]
        };
        all[at] = [low.max(range.low), high.min(range.high)];
    }
    Intervals { ends: all, covariance }
}
