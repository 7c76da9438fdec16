//! 95 % intervals of a fitted contact: from the curvature of least squares, from blocks of the recording, and from its halves.

use nalgebra::{DMatrix, DVector};

use super::fit::{Data, Fit, Rest};
use crate::diagnose::linalg::dot;

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_964;

/// Blocks that the score's scatter is taken over, and integrated autocorrelation times that one is long at the least.
const BLOCKS: usize = 40;
const BLOCK_TIMES: f64 = 3.0;

/// The interval of each value of `fit`; `halves` are the values that two halves of the rows gave.
///
/// The covariance is H^-1 times the residual's power over the sensors', with H the curvature, or, where that is larger, the sandwich
/// H^-1 B H^-1 with B the scatter of the score over blocks: it holds where the residual of an imperfect law remembers (White,
/// *Econometrica* 50, 1982).
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, rest: &Rest, halves: &[Vec<f64>; 2]) -> Vec<[f64; 2]> {
    let ranges = fit.model.ranges(&fit.values);
    let free: Vec<usize> = (0..fit.values.len()).filter(|at| ranges[*at].free).collect();
    let columns = data.columns(&fit.model, &fit.values, &ranges, &free, &rest.rows);
    let priors: Vec<f64> =
        free.iter().map(|at| ranges[*at].prior.map_or(0.0, |(_, sigma)| (ranges[*at].size / sigma).powi(2))).collect();
    let block = (data.rows() / BLOCKS).max((BLOCK_TIMES * rest.correlated_rows) as usize).max(4);
    let found = deviations(&rest.rows, &columns, &priors, rest.power, block);
    let mut all: Vec<[f64; 2]> = fit.values.iter().map(|value| [*value; 2]).collect();
    for (&at, steps) in free.iter().zip(found) {
        let (range, value) = (&ranges[at], fit.values[at]);
        let steps = Z * steps;
        // Two halves that differ by more than noise say how far the law can be trusted.
        let apart = 0.5 * Z * (halves[0][at] - halves[1][at]).abs();
        let [low, high] = if range.by_factors {
            let factor = steps.hypot(apart / value.abs().max(f64::MIN_POSITIVE)).min(50.0).exp();
            [value / factor, value * factor]
        } else {
            let half = (range.size * steps).hypot(apart);
            [value - half, value + half]
        };
        all[at] = [low.max(range.low), high.min(range.high)];
    }
    all
}

/// Deviation of each value in steps of its range.
fn deviations(residual: &[f64], columns: &[Vec<f64>], priors: &[f64], power: f64, block: usize) -> Vec<f64> {
    let count = columns.len();
    // Values of unlike size: each direction is taken as long as one.
    let sizes: Vec<f64> = columns
        .iter()
        .zip(priors)
        .map(|(column, prior)| (dot(column, column) + prior).sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let mut curvature = DMatrix::from_fn(count, count, |i, j| dot(&columns[i], &columns[j]) / (sizes[i] * sizes[j]));
    for at in 0..count {
        curvature[(at, at)] += 1e-9 + priors[at] / (sizes[at] * sizes[at]);
    }
    let Some(factors) = curvature.cholesky() else { return vec![f64::INFINITY; count] };
    let plain = factors.inverse();
    let mut scatter = DMatrix::zeros(count, count);
    for start in (0..residual.len()).step_by(block) {
        let rows = start..(start + block).min(residual.len());
        let score =
            DVector::from_fn(count, |at, _| dot(&columns[at][rows.clone()], &residual[rows.clone()]) / sizes[at]);
        scatter += &score * score.transpose();
    }
    let sandwich = &plain * scatter * &plain;
    (0..count).map(|at| (power * plain[(at, at)]).max(sandwich[(at, at)]).sqrt() / sizes[at]).collect()
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
        let found = deviations(&independent, &column, &[0.0], 1.0, 50)[0];
        // The scatter over 80 blocks is known to 16 %, so that the larger of both lies within three of that.
        assert!(found >= 0.999 * plain && found < 1.5 * plain, "{found} {plain}");
        // Each value held for 25 rows: 25 times fewer observations, five times the deviation.
        let held: Vec<f64> = independent.iter().take(rows / 25).flat_map(|value| [*value; 25]).collect();
        let found = deviations(&held, &column, &[0.0], 1.0, 50)[0];
        assert!(found > 3.5 * plain && found < 6.5 * plain, "{found} {plain}");
        // A prior as sharp as the data halves the variance.
        let found = deviations(&independent, &column, &[rows as f64], 1.0, 50)[0];
        assert!(found < 0.95 * plain, "{found} {plain}");
    }
}
