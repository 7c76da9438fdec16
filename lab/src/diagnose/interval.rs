//! Deviations of fitted values, from the curvature of least squares and from blocks of the recording.

use nalgebra::{DMatrix, DVector};

use super::linalg::dot;

/// The 97.5 % point of the normal distribution.
pub const NORMAL_97_5: f64 = 1.959_964;

/// How far fitted values can be trusted.
#[derive(Debug, Clone)]
pub struct Spread {
    /// Deviation of each value in steps.
    pub deviations: Vec<f64>,
    /// Covariance of the steps by the curvature alone; empty where it has no inverse.
    pub covariance: Vec<Vec<f64>>,
}

/// 95 % intervals of fitted values, and how the values hang together.
#[derive(Debug, Clone)]
pub struct Intervals {
    /// Both ends for each value.
    pub ends: Vec<[f64; 2]>,
    /// Covariance of the values by the curvature of the fit, in their own units; zero for values that were not fitted, empty where it is not
    /// known.
    pub covariance: Vec<Vec<f64>>,
}

impl Spread {
    /// The covariance in the units of all values: step number `n` moves value `at[n]` of `count` by `slopes[n]`.
    #[must_use]
    pub fn covariance_of(&self, count: usize, at: &[usize], slopes: &[f64]) -> Vec<Vec<f64>> {
        if self.covariance.is_empty() {
            return Vec::new();
        }
        let mut all = vec![vec![0.0; count]; count];
        for (i, row) in self.covariance.iter().enumerate() {
            for (j, covariance) in row.iter().enumerate() {
                all[at[i]][at[j]] = slopes[i] * slopes[j] * covariance;
            }
        }
        all
    }
}

/// Deviation and covariance of each value, of the linearised least squares of `residual` with the derivatives `columns` by one step of
/// each value.
///
/// The covariance is H^-1 times `power`, the mean square of the residual, with H the curvature, or, where that is larger, the sandwich
/// H^-1 B H^-1 with B the scatter of the score over blocks of `block` rows: it holds where the residual of an imperfect law remembers
/// (White, *Econometrica* 50, 1982). `priors` are what is known of each value beforehand, one over its variance in squared steps; zero
/// where nothing is. Infinite where the curvature has no inverse.
#[must_use]
pub fn spread(residual: &[f64], columns: &[Vec<f64>], priors: &[f64], power: f64, block: usize) -> Spread {
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
    let Some(factors) = curvature.cholesky() else {
        return Spread { deviations: vec![f64::INFINITY; count], covariance: Vec::new() };
    };
    let plain = factors.inverse();
    let mut scatter = DMatrix::zeros(count, count);
    for start in (0..residual.len()).step_by(block) {
        let rows = start..(start + block).min(residual.len());
        let score =
            DVector::from_fn(count, |at, _| dot(&columns[at][rows.clone()], &residual[rows.clone()]) / sizes[at]);
        scatter += &score * score.transpose();
    }
    let sandwich = &plain * scatter * &plain;
    let deviation = |at: usize| (power * plain[(at, at)]).max(sandwich[(at, at)]).sqrt() / sizes[at];
    let covariance = |i: usize, j: usize| power * plain[(i, j)] / (sizes[i] * sizes[j]);
    Spread {
        deviations: (0..count).map(deviation).collect(),
        covariance: (0..count).map(|i| (0..count).map(|j| covariance(i, j)).collect()).collect(),
    }
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
        let found = spread(&independent, &column, &[0.0], 1.0, 50).deviations[0];
        // The scatter over 80 blocks is known to 16 %, so that the larger of both lies within three of that.
        assert!(found >= 0.999 * plain && found < 1.5 * plain, "{found} {plain}");
        // Each value held for 25 rows: 25 times fewer observations, five times the deviation.
        let held: Vec<f64> = independent.iter().take(rows / 25).flat_map(|value| [*value; 25]).collect();
        let found = spread(&held, &column, &[0.0], 1.0, 50).deviations[0];
        assert!(found > 3.5 * plain && found < 6.5 * plain, "{found} {plain}");
        // A prior as sharp as the data halves the variance.
        let found = spread(&independent, &column, &[rows as f64], 1.0, 50).deviations[0];
        assert!(found < 0.95 * plain, "{found} {plain}");
    }

    #[test]
    fn two_columns_that_overlap_are_told_against_each_other_as_the_normal_equations_have_it() {
        // Columns of 100 ones each that share 60 rows: X'X = [[100, 60], [60, 100]], so that the correlation of the values is -0.6.
        let column =
            |first: usize| (0..140).map(|row| f64::from(u8::from((first..first + 100).contains(&row)))).collect();
        let columns: [Vec<f64>; 2] = [column(0), column(40)];
        let found = spread(&[0.0; 140], &columns, &[0.0; 2], 1.0, 10);
        let at = |i: usize, j: usize| found.covariance[i][j];
        assert!((at(0, 1) / (at(0, 0) * at(1, 1)).sqrt() + 0.6).abs() < 1e-6, "{:?}", found.covariance);
        // 100 / (100^2 - 60^2)
        assert!((at(0, 0) - 0.015_625).abs() < 1e-9, "{:?}", found.covariance);
        let moved = found.covariance_of(3, &[0, 2], &[2.0, -1.0]);
        assert_eq!((moved[0][2], moved[2][2], moved[1][1]), (-2.0 * at(0, 1), at(1, 1), 0.0));
    }
}
