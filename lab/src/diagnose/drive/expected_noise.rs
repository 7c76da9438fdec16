//! What the noise of encoder, force sensor and recorded effort alone shows as missing force.

use rand::SeedableRng as _;
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

/// Missing force that the sensors' noise alone would show: the encoder's and the force sensor's, drawn and passed through the same
/// filter and smoother.
#[must_use]
pub fn expected_noise(data: &Data<'_>, fit: &Fit, common: &Noise, seed: u64) -> f64 {
    let mut draw = Draw::new(seed);
    passed(data, fit, common, |trial| {
        let mut noise = trial.clone().without_effort();
        noise.position = draw.white(fit.noise.encoder(), trial.len());
        if let Some(force) = &mut noise.force {
            let variance = trial.denoised.as_ref().map_or_else(|| white_variance(force), |filter| filter.noise[1]);
            *force = draw.white(variance, force.len());
        }
        as_denoised(trial, noise)
    })
}

/// The same of white noise in the recorded effort, which may be its sensor's: what is left below it is not told as physics. Where a
/// controller commands such noise it moves the drive and nothing of it is left; so it is no part of the expected noise.
#[must_use]
pub fn effort_noise(data: &Data<'_>, fit: &Fit, common: &Noise, seed: u64) -> f64 {
    let mut draw = Draw::new(seed);
    passed(data, fit, common, |trial| {
        let mut noise = trial.clone().without_effort();
        noise.position.fill(0.0);
        let variance =
            trial.denoised.as_ref().map_or_else(|| robust_white_variance(&trial.effort), |filter| filter.noise[0]);
        noise.effort = draw.white(variance, trial.effort.len());
        noise.force = None;
        as_denoised(trial, noise)
    })
}

/// What the filter of `trial` leaves of the `noise` that was drawn for effort and force.
fn as_denoised(trial: &DriveTrial, noise: DriveTrial) -> DriveTrial {
    let Some(filter) = &trial.denoised else { return noise };
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

    fn white(&mut self, variance: f64, count: usize) -> Vec<f64> {
        let deviation = variance.sqrt();
        (0..count).map(|_| deviation * Distribution::<f64>::sample(&StandardNormal, &mut self.0)).collect()
    }
}
