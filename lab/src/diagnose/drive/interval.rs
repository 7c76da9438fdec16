//! 95 % intervals of a fitted drive: from the curvature of the likelihood, from blocks of the recording, and from its halves.

use super::criteria::{BLOCK_ROWS, BLOCK_S};
use super::fit::{Data, Fit};
use super::term::Step;
use crate::diagnose::interval::{Intervals, NORMAL_97_5, spread};

/// The interval of each value of `fit`; `halves` are the values that two halves of the recordings gave.
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, halves: &[Vec<f64>; 2]) -> Intervals {
    let (innovations, columns) = data.linearised(fit);
    let ranges = fit.model.ranges();
    let block = ((BLOCK_S / fit.model.scales.period_s) as usize).max(BLOCK_ROWS);
    // Standardised innovations have a power of one, and nothing is known of a value beforehand.
    let found = spread(&innovations, &columns, &vec![0.0; columns.len()], 1.0, block);
    let each = fit.values.iter().enumerate().map(|(at, value)| {
        let steps = NORMAL_97_5 * found.deviations[at];
        // Two halves that differ by more than noise say how far the law can be trusted.
        let apart = 0.5 * NORMAL_97_5 * (halves[0][at] - halves[1][at]).abs();
        let range = &ranges[at];
        let half = (range.slope(*value).abs() * steps).hypot(apart);
        let [low, high] = match range.step {
            Step::Relative => {
                let factor = (half / value.abs().max(f64::MIN_POSITIVE)).min(50.0).exp();
                [value / factor, value * factor]
            }
            Step::Absolute(_) => [value - half, value + half],
        };
        [low.max(range.low), high.min(range.high)]
    });
    let all: Vec<usize> = (0..fit.values.len()).collect();
    let slopes: Vec<f64> = ranges.iter().zip(&fit.values).map(|(range, value)| range.slope(*value)).collect();
    Intervals { ends: each.collect(), covariance: found.covariance_of(all.len(), &all, &slopes) }
}
