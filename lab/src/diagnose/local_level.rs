//! A level that wanders under white noise.
//!
//! The local level model (A. C. Harvey, *Forecasting, Structural Time Series Models and the Kalman Filter*, 1989): `level' = w` with `w` white
//! of a density that is fitted by maximum likelihood, and rows `level + e` of known variance at any instants. Kalman's filter and the
//! smoother of H. E. Rauch, F. Tung and C. T. Striebel (1965).

use super::golden_section::least_between;

/// Precision of the logarithm of the density.
const LN_PRECISION: f64 = 0.1;

/// The smoothed level behind `values` at the instants `time`, s; row `i` has the variance `variance[i]`, infinite where it is no measurement.
///
/// Zero everywhere where no row is one.
#[must_use]
pub fn level(time: &[f64], values: &[f64], variance: &[f64]) -> Vec<f64> {
    let rows = Rows { time, values, variance };
    let Some(usual) = rows.usual_variance() else { return vec![0.0; values.len()] };
    let duration = time[time.len() - 1] - time[0];
    // From a level that stays within a thousandth of a row's deviation to one that is new in each row.
    let [low, high] = [1e-6 * usual / duration, usual * time.len() as f64 / duration].map(f64::ln);
    let most_likely = least_between([low, high], LN_PRECISION, |ln_density| -rows.log_likelihood(ln_density.exp()));
    rows.smoothed(most_likely.exp())
}

struct Rows<'a> {
    time: &'a [f64],
    values: &'a [f64],
    variance: &'a [f64],
}

/// Mean and variance of the level before a row and behind it.
struct Step {
    before: [f64; 2],
    behind: [f64; 2],
}

impl Rows<'_> {
    /// Median of the variances of rows that are measurements, where time goes on.
    fn usual_variance(&self) -> Option<f64> {
        let mut known: Vec<f64> = self.variance.iter().copied().filter(|variance| variance.is_finite()).collect();
        let goes_on = self.time.last() > self.time.first();
        known.sort_by(f64::total_cmp);
        known.get(known.len() / 2).copied().filter(|variance| *variance > 0.0 && goes_on)
    }

    fn filtered(&self, density: f64) -> Vec<Step> {
        let mut now = [0.0, f64::INFINITY];
        let steps = (0..self.values.len()).map(|row| {
            let passed = if row == 0 { 0.0 } else { self.time[row] - self.time[row - 1] };
            let before = [now[0], now[1] + density * passed];
            now = match (before[1].is_finite(), self.variance[row].is_finite()) {
                (_, false) => before,
                // The first row says where the level begins.
                (false, true) => [self.values[row], self.variance[row]],
                (true, true) => {
                    let gain = before[1] / (before[1] + self.variance[row]);
                    [before[0] + gain * (self.values[row] - before[0]), (1.0 - gain) * before[1]]
                }
            };
            Step { before, behind: now }
        });
        steps.collect()
    }

    fn log_likelihood(&self, density: f64) -> f64 {
        let steps = self.filtered(density);
        let rows = steps.iter().zip(self.values).zip(self.variance);
        rows.filter(|((step, _), variance)| step.before[1].is_finite() && variance.is_finite())
            .map(|((step, value), variance)| {
                let spread = step.before[1] + variance;
                -0.5 * (spread.ln() + (value - step.before[0]).powi(2) / spread)
            })
            .sum()
    }

    fn smoothed(&self, density: f64) -> Vec<f64> {
        let steps = self.filtered(density);
        let mut levels: Vec<f64> = steps.iter().map(|step| step.behind[0]).collect();
        for row in (0..levels.len().saturating_sub(1)).rev() {
            let (now, next) = (&steps[row], &steps[row + 1]);
            // Before the first measurement the level is what it is there.
            let gain = if now.behind[1].is_finite() { now.behind[1] / next.before[1] } else { 1.0 };
            let ahead = if next.before[1].is_finite() { next.before[0] } else { levels[row] };
            levels[row] += gain * (levels[row + 1] - ahead);
        }
        levels
    }
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
