//! 95 % intervals of a fitted drive: from the curvature of the likelihood, from blocks of the recording, and from its halves.

use nalgebra::{DMatrix, DVector};

use super::criteria::{BLOCK_ROWS, BLOCK_S};
use super::fit::{Data, Fit};
use super::term::Step;
use crate::diagnose::linalg::dot;

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_964;

/// The interval of each value of `fit`; `halves` are the values that two halves of the recordings gave.
///
/// The covariance is H^-1 with H the curvature of the likelihood, or, where that is larger, the sandwich H^-1 B H^-1 with B the
/// scatter of the score over blocks: it holds where innovations of an imperfect law remember (White, *Econometrica* 50, 1982).
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, halves: &[Vec<f64>; 2]) -> Vec<[f64; 2]> {
    let (innovations, columns) = data.linearised(fit);
    let ranges = fit.model.ranges();
    let block = ((BLOCK_S / fit.model.scales.period_s) as usize).max(BLOCK_ROWS);
    let deviations = deviations(&innovations, &columns, block);
    let each = fit.values.iter().enumerate().map(|(at, value)| {
        let steps = Z * deviations[at];
        // Two halves that differ by more than noise say how far the law can be trusted.
        let apart = 0.5 * Z * (halves[0][at] - halves[1][at]).abs();
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
    each.collect()
}

/// Deviation of each value in steps of its range.
fn deviations(innovations: &[f64], columns: &[Vec<f64>], block: usize) -> Vec<f64> {
    let count = columns.len();
    // Values of unlike size: each direction is taken as long as one.
    let sizes: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt().max(f64::MIN_POSITIVE)).collect();
    let mut curvature = DMatrix::from_fn(count, count, |i, j| dot(&columns[i], &columns[j]) / (sizes[i] * sizes[j]));
    for at in 0..count {
        curvature[(at, at)] += 1e-9;
    }
    let Some(factors) = curvature.cholesky() else { return vec![f64::INFINITY; count] };
    let plain = factors.inverse();
    let mut scatter = DMatrix::zeros(count, count);
    for start in (0..innovations.len()).step_by(block) {
        let rows = start..(start + block).min(innovations.len());
        let score =
            DVector::from_fn(count, |at, _| dot(&columns[at][rows.clone()], &innovations[rows.clone()]) / sizes[at]);
        scatter += &score * score.transpose();
    }
    let sandwich = &plain * scatter * &plain;
    (0..count).map(|at| plain[(at, at)].max(sandwich[(at, at)]).sqrt() / sizes[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_noise_has_the_deviation_of_least_squares_and_repeated_noise_a_larger_one() {
        // A constant told from 4000 rows of unit noise: 1 / sqrt(4000) where rows are independent.
        let rows = 4000;
        let column = vec![vec![1.0; rows]];
        let mut state = 7u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt()
        };
        let independent: Vec<f64> = (0..rows).map(|_| uniform()).collect();
        let plain = 1.0 / (rows as f64).sqrt();
        let found = deviations(&independent, &column, 50)[0];
        // The scatter over 80 blocks is known to 16 %, so that the larger of both lies within three of that.
        assert!(found >= 0.999 * plain && found < 1.5 * plain, "{found} {plain}");
        // Each value held for 25 rows: 25 times fewer observations, five times the deviation.
        let held: Vec<f64> = independent.iter().take(rows / 25).flat_map(|value| [*value; 25]).collect();
        let found = deviations(&held, &column, 50)[0];
        assert!(found > 3.5 * plain && found < 6.5 * plain, "{found} {plain}");
    }
}
