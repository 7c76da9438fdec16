//! A level that wanders under white noise.
//!
//! The local level model (A. C. Harvey, *Forecasting, Structural Time Series Models and the Kalman Filter*, 1989): `level' = w` with `w` white
//! of a density that is fitted by maximum likelihood, and rows `level + e` of known variance at any instants. Kalman's filter and the
//! smoother of H. E. Rauch, F. Tung and C. T. Striebel (1965).

use super::linalg::energy;
use super::median::median;
use crate::golden_section::least_between;

/// Precision of the logarithm of the density.
const LN_PRECISION: f64 = 0.1;

/// The smoothed level behind `values` at the instants `time`, s; row `i` has the variance `variance[i]`, infinite where it is no measurement.
///
/// Zero everywhere where no row is one.
#[must_use]
pub fn level(time: &[f64], values: &[f64], variance: &[f64]) -> Vec<f64> {
    LocalLevel::fitted(time, values, variance).map_or_else(|| vec![0.0; values.len()], |level| level.smoothed(values))
}

/// A level of the most likely density, for rows at these instants.
pub struct LocalLevel {
    steps: Vec<Step>,
    /// Log likelihood of the rows that it was fitted to, nats.
    pub log_likelihood: f64,
    /// How much more that is than of a level that stays.
    pub gain: f64,
}

/// How well the level is known about a row, and the row's own variance.
struct Step {
    /// Variance of the level before the row.
    before: f64,
    /// And behind it.
    behind: f64,
    /// That of the row.
    row: f64,
}

impl Step {
    /// Whether the row is a measurement.
    const fn measures(&self) -> bool {
        self.row.is_finite()
    }

    /// Whether the level was known before it.
    const fn is_known(&self) -> bool {
        self.before.is_finite()
    }
}

impl LocalLevel {
    /// That behind `values` at the instants `time`, s, of these variances; `None` where no row is a measurement.
    #[must_use]
    pub fn fitted(time: &[f64], values: &[f64], variance: &[f64]) -> Option<Self> {
        let usual = usual_variance(variance).filter(|usual| *usual > 0.0 && time.last() > time.first())?;
        let duration = time[time.len() - 1] - time[0];
        let of = |density: f64| Self { steps: steps(time, variance, density), log_likelihood: 0.0, gain: 0.0 };
        // From a level that stays within a thousandth of a row's deviation to one that is new in each row.
        let [low, high] = [1e-6 * usual / duration, usual * time.len() as f64 / duration].map(f64::ln);
        let most_likely =
            least_between([low, high], LN_PRECISION, |ln_density| -of(ln_density.exp()).log_likelihood_of(values));
        let mut level = of(most_likely.exp());
        level.log_likelihood = level.log_likelihood_of(values);
        level.gain = level.log_likelihood - of(0.0).log_likelihood_of(values);
        Some(level)
    }

    /// The level before each row and behind it.
    fn filtered(&self, values: &[f64]) -> Vec<[f64; 2]> {
        let mut now = 0.0;
        let rows = self.steps.iter().zip(values).map(|(step, value)| {
            let before = now;
            // The first row says where the level begins.
            let gain = if step.is_known() { step.before / (step.before + step.row) } else { 1.0 };
            if step.measures() {
                now += gain * (value - now);
            }
            [before, now]
        });
        rows.collect()
    }

    /// What each row tells that the rows before it did not, in deviations: of rows that share the level's errors, rows that share none (T. Kailath,
    /// *IEEE Trans. Autom. Control* 13, 1968). Zero where it tells nothing of that kind.
    #[must_use]
    pub fn innovations(&self, values: &[f64]) -> Vec<f64> {
        let rows = self.filtered(values).into_iter().zip(&self.steps).zip(values);
        let told = |(([before, _], step), value): (([f64; 2], &Step), &f64)| {
            if step.is_known() && step.measures() { (value - before) / (step.before + step.row).sqrt() } else { 0.0 }
        };
        rows.map(told).collect()
    }

    fn log_likelihood_of(&self, values: &[f64]) -> f64 {
        let told = self.steps.iter().filter(|step| step.is_known() && step.measures());
        let spread: f64 = told.map(|step| (step.before + step.row).ln()).sum();
        -0.5 * (spread + energy(&self.innovations(values)))
    }

    fn smoothed(&self, values: &[f64]) -> Vec<f64> {
        let filtered = self.filtered(values);
        let mut levels: Vec<f64> = filtered.iter().map(|[_, behind]| *behind).collect();
        for row in (0..levels.len().saturating_sub(1)).rev() {
            let (now, next) = (&self.steps[row], &self.steps[row + 1]);
            // Before the first measurement the level is what it is there.
            let gain = if now.behind.is_finite() { now.behind / next.before } else { 1.0 };
            let ahead = if next.is_known() { filtered[row + 1][0] } else { levels[row] };
            levels[row] += gain * (levels[row + 1] - ahead);
        }
        levels
    }
}

/// Median of the variances of rows that are measurements.
fn usual_variance(variance: &[f64]) -> Option<f64> {
    median(variance.iter().copied().filter(|variance| variance.is_finite()))
}

/// How well a level of `density` is known along the rows.
fn steps(time: &[f64], variance: &[f64], density: f64) -> Vec<Step> {
    let mut now = f64::INFINITY;
    let rows = variance.iter().enumerate().map(|(row, of_row)| {
        let passed = if row == 0 { 0.0 } else { time[row] - time[row - 1] };
        let before = now + density * passed;
        now = match (before.is_finite(), of_row.is_finite()) {
            (_, false) => before,
            (false, true) => *of_row,
            (true, true) => before * of_row / (before + of_row),
        };
        Step { before, behind: now, row: *of_row }
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, Normal};

    const NOISE: f64 = 0.02;
    const STEP: f64 = 1e-3;

    /// A random walk of `per_root_second` under white noise, 20 s at 1 kHz, and what is found of it.
    fn found(per_root_second: f64, is_measured: impl Fn(usize) -> bool) -> (Vec<f64>, Vec<f64>) {
        let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(5);
        let normal = Normal::new(0.0, 1.0).unwrap();
        let mut at = 0.1;
        let truth: Vec<f64> = (0..20_000)
            .map(|_| {
                at += per_root_second * f64::sqrt(STEP) * normal.sample(&mut random);
                at
            })
            .collect();
        let time: Vec<f64> = (0..truth.len()).map(|row| row as f64 * STEP).collect();
        let values: Vec<f64> = truth.iter().map(|level| level + NOISE * normal.sample(&mut random)).collect();
        let variance: Vec<f64> =
            (0..truth.len()).map(|row| if is_measured(row) { NOISE * NOISE } else { f64::INFINITY }).collect();
        let level = level(&time, &values, &variance);
        (truth, level)
    }

    fn error(pairs: &(Vec<f64>, Vec<f64>)) -> f64 {
        let squares = pairs.0.iter().zip(&pairs.1).map(|(truth, level)| (truth - level).powi(2));
        (squares.sum::<f64>() / pairs.0.len() as f64).sqrt()
    }

    /// The smoothed level's variance is sqrt(q r) / 2 with r the noise's density (the steady state of the filter and its mirror): 0.03 N in
    /// a root second, 0.02 N a row at 1 kHz.
    #[test]
    fn a_walk_is_found_to_what_theory_allows() {
        let error = error(&found(0.03, |_| true));
        let theory = (0.03 * NOISE * f64::sqrt(STEP) / 2.0).sqrt();
        // Errors are alike over 20 ms: a thousand of them, so 2 %, and the density is known to a tenth of its logarithm.
        assert!((error / theory - 1.0).abs() < 0.1, "{error} for {theory}");
    }

    #[test]
    fn a_level_that_stays_is_the_mean() {
        let error = error(&found(0.0, |_| true));
        assert!(error < 3.0 * NOISE / f64::sqrt(20_000.0), "{error}");
    }

    /// Half a second without measurements in every second: between them the walk goes 0.03 sqrt(0.5 / 6) N in root mean square from its
    /// straight line.
    #[test]
    fn gaps_are_bridged_and_nothing_is_found_where_nothing_is_measured() {
        let error = error(&found(0.03, |row| row % 1000 < 500));
        assert!(error < 0.03 * f64::sqrt(0.5 / 6.0) && error > 1e-3, "{error}");
        assert_eq!(found(0.03, |_| false).1, vec![0.0; 20_000]);
        let late = found(0.0, |row| row > 5000).1;
        assert!((late[0] - 0.1).abs() < 1e-3, "{}", late[0]);
    }
}
