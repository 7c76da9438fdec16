//! What a drive shows as missing force while it stands still: noise of every colour that is recorded with effort and force, and no law of a motion.

use super::criteria::{FEWEST_STILL_WINDOWS, STILL_PART, STILL_PERIODS, STILL_STEPS};
use super::held_out::rms;
use super::trial::DriveTrial;
use crate::diagnose::ends::ends;
use crate::diagnose::median::median;

/// Root mean square of the force `missing`, a column a trial, about its trend in windows in which the drive stands still, N or N m: that of the median window, so
/// that a push does not count. What holds a drive at rest is constant there, or goes with its trend. `None` where it hardly ever stands still.
#[must_use]
pub fn noise_at_rest(
    trials: &[DriveTrial],
    missing: &[Vec<f64>],
    band_hz: f64,
    resolution: f64,
    travel: f64,
) -> Option<f64> {
    let still = (STILL_STEPS * resolution).value().max((STILL_PART * travel).value());
    let mut powers = Vec::new();
    for (trial, force) in trials.iter().zip(missing) {
        let rows = ((STILL_PERIODS / (band_hz * trial.period_s)).value().ceil() as usize).max(4);
        for start in (0..trial.len().saturating_sub(rows)).step_by(rows) {
            let window = start..start + rows;
            let is_whole = !trial.restart[window.clone()].iter().skip(1).any(|restart| *restart);
            if is_whole && range(&trial.position[window.clone()]) <= still {
                powers.push(rms(&[detrended(&force[window])]).powi(2));
            }
        }
    }
    (powers.len() as f64 >= FEWEST_STILL_WINDOWS.value()).then(|| median(powers.into_iter())).flatten().map(f64::sqrt)
}

fn range(values: &[f64]) -> f64 {
    let [low, high] = ends(values.iter().copied());
    high - low
}

/// `values` less the straight line that is closest to them.
fn detrended(values: &[f64]) -> Vec<f64> {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count;
    let along = |row: usize| row as f64 - middle;
    let squares: f64 = (0..values.len()).map(|row| along(row).powi(2)).sum();
    let slope = values.iter().enumerate().map(|(row, value)| along(row) * value).sum::<f64>() / squares;
    values.iter().enumerate().map(|(row, value)| value - mean - slope * along(row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten seconds still, ten in motion: a triangle of 0.2 N at 20 Hz, on a force that rises by 1 N; and a push of 5 N for half a second.
    #[test]
    fn noise_at_rest_is_that_about_the_trend_and_without_a_push() {
        let rows = 20_000;
        let time: Vec<f64> = (0..rows).map(|row| 1e-3 * row as f64).collect();
        let position: Vec<f64> = time.iter().map(|t| if *t < 10.0 { 0.0 } else { 0.01 * (t - 10.0) }).collect();
        let triangle = |t: f64| 0.2 * (4.0 * ((20.0 * t).fract() - 0.5).abs() - 1.0);
        let force: Vec<f64> = time.iter().map(|t| triangle(*t) + 0.1 * t).collect();
        let trial = DriveTrial::new("still.csv".into(), time.clone(), &position, vec![0.0; rows], None, 1);
        let at_rest =
            |force: Vec<f64>, travel: f64| noise_at_rest(std::slice::from_ref(&trial), &[force], 40.0, 1e-6, travel);
        // Root mean square of a triangle over its size: a root of a third. Five of its periods are a window, and a line follows some of them.
        let expected = 0.2 / 3.0f64.sqrt();
        let found = at_rest(force.clone(), 0.1).expect("it stands still");
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        let pushed = force.iter().zip(&time).map(|(force, t)| if (4.0..4.5).contains(t) { 5.0 * t } else { *force });
        assert!((at_rest(pushed.collect(), 0.1).expect("it stands still") / expected - 1.0).abs() < 0.02);
        // A drive that always moves.
        let moving = DriveTrial { position: time.iter().map(|t| 0.01 * t).collect(), ..trial.clone() };
        assert_eq!(noise_at_rest(&[moving], &[force], 40.0, 1e-6, 0.2), None);
    }
}
