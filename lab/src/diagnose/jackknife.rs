//! How far fitted values move where a stretch of the recording is left out.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF as _, StudentsT};

use super::interval::NORMAL_97_5;

/// Stretches that all recordings together are parted into.
///
/// Many short ones forget what an imperfect law's residual remembers, few long ones tell a deviation badly: with sixteen the 97.5 % point of
/// Student's distribution is 2.13, 9 % above the normal one, and a stretch of two trials of 20 s lasts 2.5 s.
pub const STRETCHES: usize = 16;

/// What one stretch of rows brings to a linearised least squares.
pub struct Stretch {
    /// Products of the columns, X'X.
    pub products: DMatrix<f64>,
    /// Products of the columns with the residual, X'r.
    pub score: DVector<f64>,
}

/// Deviations of fitted values, and how well those are known.
pub struct Jackknife {
    /// Deviation of each value.
    pub deviations: Vec<f64>,
    /// Degrees of freedom of each deviation.
    pub freedoms: Vec<f64>,
}

/// Leaves out each of `stretches` in turn: the values of all the others are H_g^-1 s_g away, with s_g the score of the stretch and H_g the
/// curvature of the others, `curvature` less X_g'X_g. The variance is the sum of the squares of these, over what that sum would be for a white
/// residual times what the variance would be then. So it needs no model of what the residual remembers within a stretch, and where a few
/// stretches tell a value it is not too small, as White's sandwich is (the bias-reduced linearisation of R. M. Bell, D. F. McCaffrey, *Surv. Methodol.*
/// 28, 2002; J. G. MacKinnon, M. Ø. Nielsen, M. D. Webb, *J. Appl. Econom.* 38, 2023).
///
/// Its degrees of freedom are Satterthwaite's, of the scaled chi-square that has the sum's mean and variance where the residual is white: q - 1
/// where all stretches tell a value alike, about two where three of them do (G. W. Imbens, M. Kolesár, *Rev. Econ. Stat.* 98, 2016). `None`
/// where without a stretch the values are not told at all. The values need not be those of least squares: what Gauss's and Newton's step
/// would still take off the score is no scatter of it.
#[must_use]
pub fn jackknife(stretches: &[Stretch], curvature: &DMatrix<f64>) -> Option<Jackknife> {
    let (count, parts) = (curvature.nrows(), stretches.len());
    let whole = curvature.clone().cholesky()?.inverse();
    let others: Option<Vec<DMatrix<f64>>> =
        stretches.iter().map(|stretch| Some((curvature - &stretch.products).cholesky()?.inverse())).collect();
    let others = others?;
    let score = stretches.iter().fold(DVector::zeros(count), |sum, stretch| sum + &stretch.score);
    let step = &whole * score;
    let scores: Vec<DVector<f64>> =
        stretches.iter().map(|stretch| &stretch.score - &stretch.products * &step).collect();
    let mut found = Jackknife { deviations: Vec::new(), freedoms: Vec::new() };
    for at in 0..count {
        let directions: Vec<DVector<f64>> = others.iter().map(|inverse| inverse.column(at).into_owned()).collect();
        let squares: f64 = directions.iter().zip(&scores).map(|(direction, score)| direction.dot(score).powi(2)).sum();
        // The covariance of what the stretches move the value by, for a white residual: u_g' (X_g'X_g [g = h] - X_g'X_g H^-1 X_h'X_h) u_h.
        let told: Vec<DVector<f64>> =
            directions.iter().zip(stretches).map(|(direction, stretch)| &stretch.products * direction).collect();
        let covariance = DMatrix::from_fn(parts, parts, |g, h| {
            let own = if g == h { directions[g].dot(&told[g]) } else { 0.0 };
            own - told[g].dot(&(&whole * &told[h]))
        });
        let white = covariance.trace();
        found.deviations.push((squares / white * whole[(at, at)]).sqrt());
        found.freedoms.push((white.powi(2) / covariance.norm_squared()).max(1.0));
    }
    Some(found)
}

/// Sum over clusters of s s', with s the sum of the cluster's `scores`, each of `count` values.
#[must_use]
pub fn scatter<K: Ord>(scores: impl Iterator<Item = (K, DVector<f64>)>, count: usize) -> DMatrix<f64> {
    let mut sums: BTreeMap<K, DVector<f64>> = BTreeMap::new();
    for (cluster, score) in scores {
        *sums.entry(cluster).or_insert_with(|| DVector::zeros(count)) += score;
    }
    sums.values().fold(DMatrix::zeros(count, count), |sum, score| sum + score * score.transpose())
}

/// The 97.5 % point of Student's distribution.
#[must_use]
pub fn student_97_5(freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(NORMAL_97_5, |student| student.inverse_cdf(0.975))
}

/// The stretch of each row: as many of those that count in each, in time, none across two trials. `counts` says of every row of each trial
/// whether it does.
#[must_use]
pub fn stretch_of_rows(counts: &[Vec<bool>]) -> Vec<usize> {
    let counted = |trial: &[bool]| trial.iter().filter(|counts| **counts).count();
    let all = counts.iter().map(|trial| counted(trial)).sum::<usize>().max(1);
    let (mut stretches, mut first) = (Vec::new(), 0);
    for trial in counts {
        let own = counted(trial);
        let parts = (STRETCHES * own).div_ceil(all).max(1);
        let mut before = 0;
        for row_counts in trial {
            stretches.push(first + (before * parts / own.max(1)).min(parts - 1));
            before += usize::from(*row_counts);
        }
        first += parts;
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::interval::{Clusters, spread};
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    const ROWS: usize = 4000;

    /// A constant, a slope, and what four short events alone tell, as contacts do of a recording that is mostly free motion.
    fn columns() -> Vec<Vec<f64>> {
        let of = |value: &dyn Fn(usize) -> f64| (0..ROWS).map(value).collect();
        let event = |row: usize| [300, 1250, 2300, 3300].iter().any(|first| (*first..*first + 40).contains(&row));
        vec![of(&|_| 1.0), of(&|row| row as f64 / ROWS as f64), of(&|row| f64::from(u8::from(event(row))))]
    }

    /// Noise of a deviation of one that forgets by a factor of `memory` a row.
    fn noise(memory: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut state: f64 = random.sample(StandardNormal);
        let next = |_| {
            let fresh: f64 = random.sample(StandardNormal);
            state = memory * state + (1.0 - memory * memory).sqrt() * fresh;
            state
        };
        (0..ROWS).map(next).collect()
    }

    /// Residual of least squares of `noise` on `columns`, and the values: the truth is zero.
    fn fitted(noise: &[f64], columns: &[Vec<f64>]) -> (Vec<f64>, DVector<f64>) {
        let design = DMatrix::from_fn(noise.len(), columns.len(), |row, at| columns[at][row]);
        let noise = DVector::from_column_slice(noise);
        let values = (design.transpose() * &design).cholesky().unwrap().solve(&(design.transpose() * &noise));
        ((noise - design * &values).as_slice().to_vec(), values)
    }

    /// White's sandwich over forty blocks with the normal distribution's point: the half-widths that were told before.
    fn sandwich(residual: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
        let products = DMatrix::from_fn(3, 3, |i, j| crate::diagnose::linalg::dot(&columns[i], &columns[j]));
        let inverse = products.cholesky().unwrap().inverse();
        let scores = (0..ROWS).map(|row| (row / 100, DVector::from_fn(3, |at, _| columns[at][row] * residual[row])));
        let covariance = &inverse * scatter(scores, 3) * &inverse;
        (0..3).map(|at| NORMAL_97_5 * covariance[(at, at)].sqrt()).collect()
    }

    /// How often each of three values' intervals holds the truth in `DRAWS` recordings: by stretches, and by the sandwich.
    fn coverage(memory: f64) -> [[f64; 3]; 2] {
        let (columns, stretch) = (columns(), stretch_of_rows(&[vec![true; ROWS / 2], vec![true; ROWS / 2]]));
        let mut random = ChaCha8Rng::seed_from_u64(17);
        let mut held = [[0.0; 3]; 2];
        for _ in 0..DRAWS {
            let (residual, values) = fitted(&noise(memory, &mut random), &columns);
            let rows = Clusters { stretch: &stretch, place: &[], rounding: &[] };
            let power = crate::diagnose::linalg::energy(&residual) / ROWS as f64;
            let told = spread(&residual, &columns, &[0.0; 3], power, rows).half_widths;
            for (held, half) in held.iter_mut().zip([told, sandwich(&residual, &columns)]) {
                (0..3).filter(|at| values[*at].abs() < half[*at]).for_each(|at| held[at] += 1.0 / DRAWS as f64);
            }
        }
        held
    }

    const DRAWS: usize = 400;

    /// Of 400 draws 95 % are held with a deviation of 1.1 %: 91.7 to 98.3 % are three of them. The larger of two intervals, of which each is
    /// right for white noise, holds more there.
    #[test]
    fn intervals_hold_the_truth_in_95_of_100_recordings_whose_noise_remembers() {
        let [white, _] = coverage(0.0);
        assert!(white.iter().all(|share| *share > 0.94), "{white:?}");
        let [told, before] = coverage(0.9);
        assert!(told.iter().all(|share| (0.917..0.983).contains(share)), "{told:?}");
        // The sandwich over blocks does not know that four events are few.
        assert!(before[2] < 0.88, "{before:?}");
    }

    #[test]
    fn stretches_that_tell_a_value_alike_have_one_degree_of_freedom_less_than_there_are() {
        let alike = |score: f64| Stretch {
            products: DMatrix::from_element(1, 1, 0.125),
            score: DVector::from_element(1, score),
        };
        // The mean of eight stretches that say +1 and -1 by turns: eight squares over seven, over eight.
        let stretches: Vec<Stretch> = (0..8).map(|at| alike(if at % 2 == 0 { 0.125 } else { -0.125 })).collect();
        let found = jackknife(&stretches, &DMatrix::from_element(1, 1, 1.0)).unwrap();
        assert!((found.freedoms[0] - 7.0).abs() < 1e-9, "{:?}", found.freedoms);
        assert!((found.deviations[0] - (1.0f64 / 7.0).sqrt()).abs() < 1e-9, "{:?}", found.deviations);
        // Where two of them hold all of it, there is one.
        let stretches = [0.5, 0.5, 0.0, 0.0]
            .map(|part| Stretch { products: DMatrix::from_element(1, 1, part), score: DVector::from_element(1, 0.0) });
        let found = jackknife(&stretches, &DMatrix::from_element(1, 1, 1.0)).unwrap();
        assert!((found.freedoms[0] - 1.0).abs() < 1e-9, "{:?}", found.freedoms);
        for (freedom, point) in [(1.0, 12.706), (15.0, 2.131), (1e6, NORMAL_97_5)] {
            assert!((student_97_5(freedom) - point).abs() < 1e-3, "{freedom}: {}", student_97_5(freedom));
        }
    }

    #[test]
    fn a_stretch_lies_in_one_trial_and_rows_that_do_not_count_are_no_part_of_its_length() {
        let stretch = stretch_of_rows(&[vec![true; 600], [vec![false; 1000], vec![true; 200]].concat()]);
        assert_eq!((stretch[0], stretch[599], stretch[600], stretch[1799]), (0, 11, 12, 15));
        assert_eq!(stretch[600..1600].iter().filter(|own| **own == 12).count(), 1000);
        assert!(stretch.is_sorted());
    }
}
