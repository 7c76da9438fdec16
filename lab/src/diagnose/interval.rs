//! Deviations of fitted values, from the curvature of least squares and from blocks of the recording.

use nalgebra::{DMatrix, DVector};

use super::linalg::dot;

/// The 97.5 % point of the normal distribution.
pub const NORMAL_97_5: f64 = 1.959_964;

/// Deviation of each value, of the linearised least squares of `residual` with the derivatives `columns` by one step of each value.
///
/// The covariance is H^-1 times `power`, the mean square of the residual, with H the curvature, or, where that is larger, the sandwich
/// H^-1 B H^-1 with B the scatter of the score over blocks of `block` rows: it holds where the residual of an imperfect law remembers
/// (White, *Econometrica* 50, 1982). `priors` are what is known of each value beforehand, one over its variance in squared steps; zero
/// where nothing is. Infinite where the curvature has no inverse.
#[must_use]
pub fn deviations(residual: &[f64], columns: &[Vec<f64>], priors: &[f64], power: f64, block: usize) -> Vec<f64> {
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
