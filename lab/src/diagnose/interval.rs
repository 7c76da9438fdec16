//! 95 % intervals of fitted values, from the curvature of least squares and from leaving out stretches of the recording.

use nalgebra::{DMatrix, DVector};

use super::jackknife::{Stretch, jackknife, scatter, student_97_5};
use super::linalg::dot;

/// The 97.5 % point of the normal distribution.
pub const NORMAL_97_5: f64 = 1.959_964;

/// How far fitted values can be trusted.
#[derive(Debug, Clone)]
pub struct Spread {
    /// Half the width of each value's 95 % interval, in steps.
    pub half_widths: Vec<f64>,
    /// Step of Gauss's and Newton's method that is left at the values; zero where they are those of least squares.
    pub remaining: Vec<f64>,
    /// Covariance of the steps by the curvature alone; empty where it has no inverse.
    pub covariance: Vec<Vec<f64>>,
    /// How many times the variance by the curvature each value's own is, by the stretches; at least one, and one where it is not known.
    pub inflations: Vec<f64>,
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

impl Intervals {
    /// Changes of the values along as many independent directions that together have the values' covariance by the curvature, times the mean of
    /// the squares of how much wider each value's interval is. One factor for all: with one for each, values that make up for each other in what
    /// is predicted would no longer do so. Empty where the covariance is not known.
    #[must_use]
    pub fn directions(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let told: Vec<usize> = (0..self.covariance.len()).filter(|at| self.covariance[*at][*at] > 0.0).collect();
        let deviation = |at: usize| self.covariance[at][at].sqrt();
        let correlation = DMatrix::from_fn(told.len(), told.len(), |i, j| {
            let ridge = if i == j { 1e-9 } else { 0.0 };
            self.covariance[told[i]][told[j]] / (deviation(told[i]) * deviation(told[j])) + ridge
        });
        let Some(factors) = correlation.cholesky() else { return Vec::new() };
        let wider = |at: &usize| {
            let half = 0.5 * (self.ends[*at][1] - self.ends[*at][0]);
            (half / (NORMAL_97_5 * deviation(*at))).powi(2)
        };
        let factor = (told.iter().map(wider).sum::<f64>() / told.len().max(1) as f64).sqrt();
        let of_direction = |direction: usize| {
            let mut change = vec![0.0; values.len()];
            for (row, &at) in told.iter().enumerate() {
                change[at] = factor * factors.l()[(row, direction)] * deviation(at);
            }
            change
        };
        (0..told.len()).map(of_direction).collect()
    }
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

/// What the rows of a residual share.
#[derive(Debug, Clone, Copy)]
pub struct Clusters<'a> {
    /// Stretch of the recording that each row is in.
    pub stretch: &'a [usize],
    /// Place of each row, as its step of the encoder, whose rounding is the same whenever it is visited; empty where nothing is shared.
    pub place: &'a [i64],
    /// By how much one deviation of its place's rounding changes each row of the residual; empty as `place` is.
    pub rounding: &'a [f64],
}

/// Half-widths and covariance of each value, of the linearised least squares of `residual` with the derivatives `columns` by one step of
/// each value.
///
/// The covariance is H^-1 times `power`, the mean square of the residual, with H the curvature. The half-width is that of the normal
/// distribution by this covariance, or, where that is larger, that of Student's by the jackknife over the stretches of `rows`: it holds
/// where the residual of an imperfect law remembers. What rows of one place share beyond those of one stretch and place comes on top
/// (clusters of two kinds: A. C. Cameron, J. B. Gelbach, D. L. Miller, *J. Bus. Econ. Stat.* 29, 2011), no less than what the encoder's rounding
/// alone does: where a motion stays at few places, the values take its error up, and the residual does not show it. `priors` are what is
/// known of each value beforehand, one over its variance in squared steps; zero where nothing is. Infinite where the curvature has no inverse.
#[must_use]
pub fn spread(residual: &[f64], columns: &[Vec<f64>], priors: &[f64], power: f64, rows: Clusters<'_>) -> Spread {
    let count = columns.len();
    // Values of unlike size: each direction is taken as long as one. A value that is held changes nothing and takes nothing from the others.
    let size = |(column, prior): (&Vec<f64>, &f64)| {
        let size = (dot(column, column) + prior).sqrt();
        if size > 0.0 { size } else { 1.0 }
    };
    let sizes: Vec<f64> = columns.iter().zip(priors).map(size).collect();
    let stretches = stretches(residual, columns, &sizes, rows.stretch);
    let mut curvature =
        DMatrix::from_diagonal(&DVector::from_fn(count, |at, _| 1e-9 + priors[at] / (sizes[at] * sizes[at])));
    stretches.iter().for_each(|stretch| curvature += &stretch.products);
    let Some(factors) = curvature.clone().cholesky() else {
        return Spread {
            half_widths: vec![f64::INFINITY; count],
            remaining: vec![0.0; count],
            covariance: Vec::new(),
            inflations: vec![1.0; count],
        };
    };
    let plain = factors.inverse();
    let score = stretches.iter().fold(DVector::zeros(count), |sum, stretch| sum + &stretch.score);
    let [by_scatter, by_rounding] = [shared_by_place(residual, columns, &sizes, rows), rounded(columns, &sizes, rows)];
    let [by_scatter, by_rounding] = [by_scatter, by_rounding].map(|scores| &plain * scores * &plain);
    let shared = |at: usize| by_scatter[(at, at)].max(by_rounding[(at, at)]).max(0.0);
    let mut half_widths: Vec<f64> = (0..count).map(|at| NORMAL_97_5 * (power * plain[(at, at)]).sqrt()).collect();
    let mut inflations = vec![1.0; count];
    if let Some(found) = jackknife(&stretches, &curvature) {
        for (at, half) in half_widths.iter_mut().enumerate() {
            let deviation = found.deviations[at].hypot(shared(at).sqrt());
            *half = half.max(student_97_5(found.freedoms[at]) * deviation);
            inflations[at] = (deviation * deviation / (power * plain[(at, at)])).max(1.0);
        }
    }
    half_widths.iter_mut().zip(&sizes).for_each(|(half, size)| *half /= size);
    let covariance = |i: usize, j: usize| power * plain[(i, j)] / (sizes[i] * sizes[j]);
    let remaining = (&plain * score).iter().zip(&sizes).map(|(step, size)| -step / size).collect();
    Spread {
        half_widths,
        remaining,
        covariance: (0..count).map(|i| (0..count).map(|j| covariance(i, j)).collect()).collect(),
        inflations,
    }
}

/// Difference that a derivative is first taken over, in steps of the value.
const FIRST_DIFFERENCE: f64 = 1e-4;

/// Rounds in which half-widths and the differences that they come from are brought together: a width that is a hundred times too small grows
/// to its own within three.
const ROUNDS: usize = 4;

/// Longest difference to either side, in steps: a factor of e^0.5, or half a size.
const LONGEST_DIFFERENCE: f64 = 0.5;

/// The spread of values whose derivatives are differences over their own intervals: `linearised` gives the residual and the derivatives
/// by one step of each value, taken over so many steps to either side. The residual has a power of one; `priors` are as in [`spread`].
///
/// For a smooth law the difference is the tangent. The likelihood of a play has a step wherever a side strikes one row earlier, and a tangent
/// beside such a step says nothing of what a larger change does: its intervals are up to a hundred times too narrow. The difference of a
/// function that is not smooth has to be as long as what it is used for (J. J. Moré, S. M. Wild, *ACM Trans. Math. Softw.* 38, 2012).
pub fn spread_over_own_width(
    priors: &[f64],
    rows: Clusters<'_>,
    linearised: impl Fn(&[f64]) -> (Vec<f64>, Vec<Vec<f64>>),
) -> Spread {
    let spread_over = |apart: &[f64]| {
        let (residual, columns) = linearised(apart);
        spread(&residual, &columns, priors, 1.0, rows)
    };
    let mut found = spread_over(&vec![FIRST_DIFFERENCE; priors.len()]);
    for _ in 1..ROUNDS {
        let clamped = |half: &f64| half.clamp(FIRST_DIFFERENCE, LONGEST_DIFFERENCE);
        found = spread_over(&found.half_widths.iter().map(clamped).collect::<Vec<_>>());
    }
    found
}

/// How much the score scatters over places beyond what it does over the parts of each that lie in one stretch.
fn shared_by_place(residual: &[f64], columns: &[Vec<f64>], sizes: &[f64], rows: Clusters<'_>) -> DMatrix<f64> {
    if rows.place.is_empty() {
        return DMatrix::zeros(sizes.len(), sizes.len());
    }
    let score = |row: usize| DVector::from_fn(sizes.len(), |at, _| columns[at][row] * residual[row] / sizes[at]);
    let places = scatter(rows.place.iter().enumerate().map(|(row, place)| ((*place, 0), score(row))), sizes.len());
    let parts = rows.place.iter().zip(rows.stretch).enumerate();
    places - scatter(parts.map(|(row, (place, stretch))| ((*place, *stretch), score(row))), sizes.len())
}

/// Covariance of the score by the rounding of the encoder, which is one error for all rows of a place and another for each place (B. Widrow,
/// I. Kollár, *Quantization Noise*, 2008, ch. 5).
fn rounded(columns: &[Vec<f64>], sizes: &[f64], rows: Clusters<'_>) -> DMatrix<f64> {
    let score = |row: usize| DVector::from_fn(sizes.len(), |at, _| columns[at][row] * rows.rounding[row] / sizes[at]);
    scatter(rows.place.iter().enumerate().map(|(row, place)| (*place, score(row))), sizes.len())
}

/// What each stretch brings, with columns as long as one.
fn stretches(residual: &[f64], columns: &[Vec<f64>], sizes: &[f64], stretch_of: &[usize]) -> Vec<Stretch> {
    let rows = stretch_of.chunk_by(|before, after| before == after).scan(0, |first, chunk| {
        let rows = *first..*first + chunk.len();
        *first = rows.end;
        Some(rows)
    });
    let count = columns.len();
    rows.map(|rows| Stretch {
        products: DMatrix::from_fn(count, count, |i, j| {
            dot(&columns[i][rows.clone()], &columns[j][rows.clone()]) / (sizes[i] * sizes[j])
        }),
        score: DVector::from_fn(count, |at, _| dot(&columns[at][rows.clone()], &residual[rows.clone()]) / sizes[at]),
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen stretches of equal length.
    fn in_sixteen(rows: usize) -> Vec<usize> {
        (0..rows).map(|row| row * 16 / rows).collect()
    }

    #[test]
    fn independent_noise_has_the_width_of_least_squares_and_repeated_noise_a_larger_one() {
        // A constant told from 4000 rows of unit noise: 1.96 / sqrt(4000) where rows are independent.
        let rows = 4000;
        let column = vec![vec![1.0; rows]];
        let mut state = 7u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt()
        };
        let independent: Vec<f64> = (0..rows).map(|_| uniform()).collect();
        let plain = NORMAL_97_5 / (rows as f64).sqrt();
        let stretch = in_sixteen(rows);
        let told = Clusters { stretch: &stretch, place: &[], rounding: &[] };
        let half = |residual: &[f64], prior: f64| spread(residual, &column, &[prior], 1.0, told).half_widths[0];
        let found = half(&independent, 0.0);
        // The deviation from sixteen stretches is known to 18 %, Student's point is 9 % above the normal one.
        assert!(found >= 0.999 * plain && found < 1.65 * plain, "{found} {plain}");
        // Each value held for 25 rows: 25 times fewer observations, five times the deviation.
        let held: Vec<f64> = independent.iter().take(rows / 25).flat_map(|value| [*value; 25]).collect();
        let found = half(&held, 0.0);
        assert!(found > 3.0 * plain && found < 8.0 * plain, "{found} {plain}");
        // Its variance is that of 25 rows that say the same, by stretches that know it to a third.
        let inflation = |residual: &[f64]| spread(residual, &column, &[0.0], 1.0, told).inflations[0];
        let (white, remembering) = (inflation(&independent), inflation(&held));
        assert!((1.0..2.5).contains(&white) && (9.0..50.0).contains(&remembering), "{white} {remembering}");
        // A prior three times as sharp as the data halves the width.
        let found = half(&vec![0.0; rows], 3.0 * rows as f64);
        assert!((found / plain - 0.5).abs() < 1e-6, "{found} {plain}");
    }

    /// An effort's delay is held at zero beside its lag: the lag is no less certain for it.
    #[test]
    fn a_value_that_is_held_takes_nothing_from_the_interval_of_another() {
        let rows = 400;
        let residual: Vec<f64> = (0..rows).map(|row| if row % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let stretch = in_sixteen(rows);
        let told = Clusters { stretch: &stretch, place: &[], rounding: &[] };
        let alone = spread(&residual, &[vec![1.0; rows]], &[0.0], 1.0, told);
        let beside = spread(&residual, &[vec![0.0; rows], vec![1.0; rows]], &[0.0; 2], 1.0, told);
        assert!((alone.half_widths[0] * (rows as f64).sqrt() / NORMAL_97_5 - 1.0).abs() < 1e-6);
        assert!((beside.half_widths[1] / alone.half_widths[0] - 1.0).abs() < 1e-9, "{:?}", beside.half_widths);
        assert!(beside.half_widths[0] > 1e4, "nothing is known of what is held");
    }

    /// A law that is wrong by one part at each of fifty places and that is visited over and over: stretches agree about it, places do not.
    #[test]
    fn what_a_place_repeats_in_every_stretch_is_no_less_uncertain_for_it() {
        let rows = 4000;
        let place: Vec<i64> = (0..rows).map(|row| (row % 50) as i64).collect();
        let column = vec![place.iter().map(|place| if place % 2 == 0 { 1.0 } else { 0.5 }).collect::<Vec<f64>>()];
        // +1 and -1 in pairs of places, so that the residual has no part along the column.
        let residual: Vec<f64> = place.iter().map(|place| if (place / 2) % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let stretch = in_sixteen(rows);
        let half = |place: &[i64]| {
            spread(&residual, &column, &[0.0], 1.0, Clusters { stretch: &stretch, place, rounding: &vec![0.0; rows] })
                .half_widths[0]
        };
        let (alone, shared) = (half(&[]), half(&place));
        // As though each place were one row: sqrt(4000 / 50) = 8.9 times as wide, times Student's 2.13 / 1.96.
        assert!(shared / alone > 7.0 && shared / alone < 11.0, "{alone} {shared}");
    }

    /// A tool that stays at one place for 70 of 100 rows and goes to another each row else: the value takes up 0.7 of the one's rounding, of
    /// which the residual shows nothing.
    #[test]
    fn where_a_motion_stays_its_rounding_stays_in_the_value() {
        let rows = 4000;
        let place: Vec<i64> = (0..rows).map(|row| if row % 10 < 7 { -1 } else { row as i64 }).collect();
        let stretch = in_sixteen(rows);
        let rows = Clusters { stretch: &stretch, place: &place, rounding: &vec![3.0; rows] };
        let half = spread(&vec![0.0; 4000], &[vec![1.0; 4000]], &[0.0], 0.0, rows).half_widths[0];
        let student = student_97_5(15.0);
        assert!((half / (student * 3.0 * 0.7) - 1.0).abs() < 1e-3, "{half}");
    }

    /// Three values, of which one was not fitted: the directions have the covariance times 6.5, the mean of 4 and 9, where one interval is
    /// twice and the other three times as wide as the curvature has it.
    #[test]
    fn independent_directions_have_the_covariance_as_wide_as_the_intervals_are() {
        let covariance = vec![vec![4.0, 0.0, -1.2], vec![0.0; 3], vec![-1.2, 0.0, 1.0]];
        let half = [2.0 * 2.0, 0.0, 3.0 * 1.0].map(|deviations: f64| deviations * NORMAL_97_5);
        let ends = half.iter().map(|half| [1.0 - half, 1.0 + half]).collect();
        let directions = Intervals { ends, covariance: covariance.clone() }.directions(&[1.0; 3]);
        let sum = |i: usize, j: usize| directions.iter().map(|direction| direction[i] * direction[j]).sum::<f64>();
        assert_eq!(directions.len(), 2);
        for (i, j) in [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2)] {
            assert!((sum(i, j) - 6.5 * covariance[i][j]).abs() < 1e-6, "{i} {j}: {}", sum(i, j));
        }
    }

    #[test]
    fn what_a_step_would_still_gain_is_told_and_is_no_scatter() {
        // A constant that is fitted wrong by 0.3: the residual is 0.3 throughout, and a step of -1 a unit takes it off.
        let column = vec![vec![-1.0; 800]];
        let stretch = in_sixteen(800);
        let found =
            spread(&[0.3; 800], &column, &[0.0], 1e-6, Clusters { stretch: &stretch, place: &[], rounding: &[] });
        assert!((found.remaining[0] - 0.3).abs() < 1e-6, "{:?}", found.remaining);
        assert!(found.half_widths[0] < 1e-4, "{:?}", found.half_widths);
    }

    /// Rows that go up by steps of 0.02 with the value, each at places of its own, as a side strikes a row earlier or later: a slope of one over
    /// more than a step, and none or a hundred over less.
    #[test]
    fn a_value_that_acts_by_steps_is_told_as_well_as_its_slope_over_many_of_them_has_it() {
        let (rows, deviation) = (2000, 0.5);
        let mut state = 3u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let phases: Vec<f64> = (0..rows).map(|_| uniform()).collect();
        let noise: Vec<f64> = (0..rows).map(|_| (uniform() - 0.5) * 12f64.sqrt()).collect();
        let predicted = |value: f64| -> Vec<f64> {
            phases.iter().map(|phase| 0.02 * (value / 0.02 + phase).floor() / deviation).collect()
        };
        let linearised = |apart: &[f64]| {
            let [below, above] = [predicted(-apart[0]), predicted(apart[0])];
            let slope = below.iter().zip(&above).map(|(below, above)| (below - above) / (2.0 * apart[0])).collect();
            (noise.clone(), vec![slope])
        };
        let stretch = in_sixteen(rows);
        let told = Clusters { stretch: &stretch, place: &[], rounding: &[] };
        let plain = NORMAL_97_5 * deviation / (rows as f64).sqrt();
        let found = spread_over_own_width(&[0.0], told, linearised).half_widths[0];
        // See above: sixteen stretches tell it to 18 %.
        assert!(found > 0.95 * plain && found < 1.65 * plain, "{found} {plain}");
        let (residual, columns) = linearised(&[FIRST_DIFFERENCE]);
        let tangent = spread(&residual, &columns, &[0.0], 1.0, told).half_widths[0];
        assert!(tangent < 0.4 * plain, "{tangent} {plain}");
    }

    #[test]
    fn two_columns_that_overlap_are_told_against_each_other_as_the_normal_equations_have_it() {
        // Columns of 100 ones each that share 60 rows: X'X = [[100, 60], [60, 100]], so that the correlation of the values is -0.6.
        let column =
            |first: usize| (0..140).map(|row| f64::from(u8::from((first..first + 100).contains(&row)))).collect();
        let columns: [Vec<f64>; 2] = [column(0), column(40)];
        let stretch = in_sixteen(140);
        let found =
            spread(&[0.0; 140], &columns, &[0.0; 2], 1.0, Clusters { stretch: &stretch, place: &[], rounding: &[] });
        let at = |i: usize, j: usize| found.covariance[i][j];
        assert!((at(0, 1) / (at(0, 0) * at(1, 1)).sqrt() + 0.6).abs() < 1e-6, "{:?}", found.covariance);
        // 100 / (100^2 - 60^2)
        assert!((at(0, 0) - 0.015_625).abs() < 1e-9, "{:?}", found.covariance);
        let moved = found.covariance_of(3, &[0, 2], &[2.0, -1.0]);
        assert_eq!((moved[0][2], moved[2][2], moved[1][1]), (-2.0 * at(0, 1), at(1, 1), 0.0));
    }
}
