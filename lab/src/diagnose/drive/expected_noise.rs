//! What the noise of encoder, force sensor and recorded effort alone shows as missing force.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

use super::filter::innovations;
use super::fit::Fit;
use super::held_out::rms;
use super::law::DriveLaw;
use super::likelihood::Data;
use super::model::index;
use super::noise::{Noise, robust_white_variance, white_variance};
use super::trial::DriveTrial;

/// Where an encoder begins within its step is drawn so often: a slow motion passes few steps, and what their rounding leaves differs by a third.
const BEGINNINGS: usize = 8;

/// Missing force that the sensors' noise alone would show: the encoder's and the force sensor's, drawn and passed through the same
/// filter and smoother. An encoder of a `step`, m or rad, rounds the motion that the law saw: while that is slow the error repeats from row to row, and of what it
/// amounts to as a force far more lies where the drive's forces do than of white noise of the same size.
/// It is no less than of white noise: where much is missing the law's path follows the encoder's own steps.
#[must_use]
pub fn expected_noise(data: &Data<'_>, fit: &Fit, common: &Noise, step: f64, seed: u64) -> f64 {
    let law = fit.model.law(&fit.values);
    let paths: Vec<Vec<f64>> = data.trials.iter().map(|trial| predicted_path(trial, &law, &fit.noise)).collect();
    let mut draw = Draw::new(seed);
    let mut of_steps = |step: f64| {
        let mut paths = paths.iter();
        passed(data, fit, common, |trial| {
            let mut noise = trial.clone().without_effort();
            noise.position = draw.encoder(paths.next().map_or(&[], Vec::as_slice), fit.noise.encoder(), step);
            if let Some(force) = &mut noise.force {
                let variance = taken_out(trial, 1).max(white_variance(force));
                *force = draw.white(variance, force.len());
            }
            as_denoised(trial, noise)
        })
    };
    let white = of_steps(0.0);
    let rounded: Vec<f64> = (0..BEGINNINGS).map(|_| of_steps(step).powi(2)).collect();
    white.max((rounded.iter().sum::<f64>() / BEGINNINGS as f64).sqrt())
}

/// The same of white noise in the recorded effort, which may be its sensor's: what is left below it is not told as physics. Where a
/// controller commands such noise it moves the drive and nothing of it is left; so it is no part of the expected noise.
#[must_use]
pub fn effort_noise(data: &Data<'_>, fit: &Fit, common: &Noise, seed: u64) -> f64 {
    let mut draw = Draw::new(seed);
    passed(data, fit, common, |trial| {
        let mut noise = trial.clone().without_effort();
        noise.position.fill(0.0);
        let variance = taken_out(trial, 0).max(robust_white_variance(&trial.effort));
        noise.effort = draw.white(variance, trial.effort.len());
        noise.force = None;
        as_denoised(trial, noise)
    })
}

/// Each row's position as `law` predicts it from the rows before, which knows it to less than a step of a coarse encoder.
fn predicted_path(trial: &DriveTrial, law: &DriveLaw, noise: &Noise) -> Vec<f64> {
    let pass = innovations(trial, law, noise, false);
    trial.position.iter().zip(&pass.innovation).map(|(measured, innovation)| measured - innovation).collect()
}

/// Variance of the noise that was taken out of effort (0) or force (1); zero where none was: then what is recorded has all of it.
fn taken_out(trial: &DriveTrial, of: usize) -> f64 {
    trial.noise_filter.as_ref().map_or(0.0, |filter| filter.noise[of])
}

/// What the filter of `trial` leaves of the `noise` that was drawn for effort and force.
fn as_denoised(trial: &DriveTrial, noise: DriveTrial) -> DriveTrial {
    let Some(filter) = &trial.noise_filter else { return noise };
    let force = noise.force.clone().unwrap_or_else(|| vec![0.0; noise.effort.len()]);
    let [effort, force] = filter.passed(&[noise.effort.clone(), force]);
    DriveTrial { effort, force: noise.force.is_some().then_some(force), ..noise }
}

/// Missing force of what `noise` makes of each trial under the rigid law of `fit`, N or N m in root mean square.
fn passed(data: &Data<'_>, fit: &Fit, common: &Noise, noise: impl FnMut(&DriveTrial) -> DriveTrial) -> f64 {
    let law = DriveLaw::nominal(fit.values[index::INERTIA], fit.values[index::VISCOUS], 0.0);
    let drawn = data.trials.iter().map(noise);
    rms(&drawn.map(|trial| innovations(&trial, &law, common, true).disturbance).collect::<Vec<_>>())
}

/// Draws of white Gaussian noise.
struct Draw(ChaCha12Rng);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(ChaCha12Rng::seed_from_u64(seed))
    }

    /// Noise of an encoder whose rows have so much `variance` along a `path`: the error of rounding to a `step`, of which it begins anywhere within one, and
    /// white noise of what that lacks. Where it has less than rounding has, the error is as much smaller.
    fn encoder(&mut self, path: &[f64], variance: f64, step: f64) -> Vec<f64> {
        let of_step = step * step / 12.0;
        let rounded = of_step.min(variance);
        let begins = step * self.0.random::<f64>();
        let mut noise = self.white(variance - rounded, path.len());
        if rounded > 0.0 {
            let size = (rounded / of_step).sqrt();
            let error = |x: f64| ((x + begins) / step).round() * step - (x + begins);
            noise.iter_mut().zip(path).for_each(|(noise, x)| *noise += size * error(*x));
        }
        noise
    }

    fn white(&mut self, variance: f64, count: usize) -> Vec<f64> {
        let deviation = variance.sqrt();
        (0..count).map(|_| deviation * Distribution::<f64>::sample(&StandardNormal, &mut self.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::held_out::missing_forces;
    use super::super::levenberg_marquardt::Ended;
    use super::super::model::Model;
    use super::super::testing::{SCALES, TestDrive};
    use super::*;

    /// A drive that goes half a millimetre to and fro behind an encoder of a tenth, with nothing missing: what its rounding leaves is expected, and white
    /// noise of the same variance would leave far less.
    #[test]
    fn rounding_of_a_slow_motion_is_expected_as_it_is() {
        const STEP: f64 = 1e-4;
        let moved = TestDrive { encoder: 0.0, ..TestDrive::PLAIN }.trial(40.0, 4);
        let slow = |values: &[f64]| -> Vec<f64> { values.iter().map(|value| 0.02 * value).collect() };
        let position = slow(&moved.position).iter().map(|x| (x / STEP).round() * STEP).collect();
        let trials = [DriveTrial { position, effort: slow(&moved.effort), ..moved }];
        let data = Data { trials: &trials, least_encoder_variance: 0.0 };
        let noise = Noise { ln_disturbance: (1e-7f64).ln(), ln_encoder: (STEP * STEP / 12.0).ln() };
        let model = Model { terms: Vec::new(), scales: SCALES };
        let values = vec![0.8, 4.0, 0.0, 0.0];
        let fit = Fit { model, values, noise, log_likelihood: 0.0, ended: Ended::Converged };
        let common = noise.with_crossing(15.0, 1e-3, 0.8);
        let left = rms(&missing_forces(&data, &fit, &common));
        // Of 40 s below 15 Hz, some 600 independent values: 3 %, and where the encoder begins within its step.
        let expected = expected_noise(&data, &fit, &common, STEP, 1);
        assert!((expected / left - 1.0).abs() < 0.25, "{expected} for {left}");
        let as_white = expected_noise(&data, &fit, &common, 0.0, 1);
        assert!(as_white < 0.7 * left, "{as_white} for {left}");
    }

    /// What was taken out is gone, and what was not is still there: a force of 0.5 N of noise beside an effort of 1 N of noise.
    #[test]
    fn noise_that_was_left_in_is_expected_and_noise_that_was_taken_out_is_not() {
        let recorded = TestDrive { effort_noise: 1.0, ..TestDrive::PLAIN }.trial(6.0, 21);
        let force = Draw::new(3).white(0.25, recorded.effort.len());
        let recorded = DriveTrial { force: Some(force), ..recorded };
        let noise = Noise { ln_disturbance: -8.0, ln_encoder: (25e-12f64).ln() };
        let fit = Fit {
            model: Model { terms: Vec::new(), scales: SCALES },
            values: vec![0.8, 4.0, 0.0, 0.0],
            noise,
            log_likelihood: 0.0,
            ended: Ended::Converged,
        };
        let common = noise.with_crossing(60.0, 1e-3, 0.8);
        let of = |levels: Option<[f64; 2]>| {
            let trials = [levels.map_or_else(|| recorded.clone(), |levels| recorded.denoised(levels))];
            let data = Data { trials: &trials, least_encoder_variance: 0.0 };
            (
                expected_noise(&data, &fit, &common, SCALES.resolution, 1),
                effort_noise(&data, &fit, &common, 1),
                data.effort_noise_density(),
            )
        };
        let (force, effort, density) = of(None);
        let (same_force, less_effort, less_density) = of(Some([1.0, 0.0]));
        // It passes whole, and some more is left as effort (an eighth was seen): by 33 frequencies, of which one in two is free, two noises that have
        // nothing in common seem to share a sixteenth of their power, a quarter of their size.
        assert!((same_force / force - 1.0).abs() < 0.2, "{same_force} {force}");
        assert!(less_effort < 0.7 * effort && less_density < 0.2 * density, "{less_effort} {effort} {less_density}");
        let (less_force, same_effort, same_density) = of(Some([0.0, 1.0]));
        assert!(less_force < 0.7 * force, "{less_force} {force}");
        assert!((same_effort / effort - 1.0).abs() < 0.2 && (same_density / density - 1.0).abs() < 0.02);
    }
}
