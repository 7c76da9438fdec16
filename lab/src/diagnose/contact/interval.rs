//! 95 % intervals of a fitted contact: from the curvature of least squares, from blocks of the recording, and from its halves.

use super::fit::{Data, Fit, Rest};
use crate::diagnose::interval::{Intervals, NORMAL_97_5, spread};

/// Blocks that the score's scatter is taken over, and integrated autocorrelation times that one is long at the least.
const BLOCKS: usize = 40;
const BLOCK_TIMES: f64 = 3.0;

/// The interval of each value of `fit`; `halves` are the values that two halves of the rows gave.
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, rest: &Rest, halves: &[Vec<f64>; 2]) -> Intervals {
    let ranges = fit.model.ranges(&fit.values);
    let free: Vec<usize> = (0..fit.values.len()).filter(|at| ranges[*at].free).collect();
    let columns = data.columns(&fit.model, &fit.values, &ranges, &free, &rest.rows);
    let priors: Vec<f64> =
        free.iter().map(|at| ranges[*at].prior.map_or(0.0, |(_, sigma)| (ranges[*at].size / sigma).powi(2))).collect();
    let block = (data.rows() / BLOCKS).max((BLOCK_TIMES * rest.correlated_rows) as usize).max(4);
    let found = spread(&rest.rows, &columns, &priors, rest.power, block);
    let mut all: Vec<[f64; 2]> = fit.values.iter().map(|value| [*value; 2]).collect();
    let slope = |at: &usize| if ranges[*at].by_factors { fit.values[*at] } else { ranges[*at].size };
    let covariance = found.covariance_of(fit.values.len(), &free, &free.iter().map(slope).collect::<Vec<_>>());
    for (&at, steps) in free.iter().zip(found.deviations) {
        let (range, value) = (&ranges[at], fit.values[at]);
        let steps = NORMAL_97_5 * steps;
        // Two halves that differ by more than noise say how far the law can be trusted.
        let apart = 0.5 * NORMAL_97_5 * (halves[0][at] - halves[1][at]).abs();
        let [low, high] = if range.by_factors {
            let factor = steps.hypot(apart / value.abs().max(f64::MIN_POSITIVE)).min(50.0).exp();
            [value / factor, value * factor]
        } else {
            let half = (range.size * steps).hypot(apart);
            [value - half, value + half]
        };
        all[at] = [low.max(range.low), high.min(range.high)];
    }
    Intervals { ends: all, covariance }
}
