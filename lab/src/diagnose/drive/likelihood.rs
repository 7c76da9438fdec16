//! The likelihood of a model: that of its innovations over all rows of the trials.

use rayon::prelude::*;

use super::filter::innovations_under;
use super::innovations::Innovations;
use super::input::Inputs;
use super::law::DriveLaw;
use super::model::Model;
use super::noise::Noise;
use super::trial::DriveTrial;

/// The trials that a model is fitted to.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a> {
    /// Every trial.
    pub trials: &'a [DriveTrial],
    /// Least variance of an encoder row that is believed, m^2 or rad^2.
    pub least_encoder_variance: f64,
}

/// Rows after a start that are not scored: the velocity is not known yet.
const SETTLING_ROWS: usize = 3;

impl Data<'_> {
    /// Density of all that `model` leaves to chance under `noise`, N^2 s: what acts on a rigid body as its disturbance holds the force sensor's
    /// noise, which beside a link acts on the load as a part of its own.
    #[must_use]
    pub fn unexplained_density(&self, model: &Model, noise: &Noise) -> f64 {
        let of_force = self.trials.iter().map(|trial| trial.force_density).fold(0.0, f64::max);
        noise.disturbance() + if model.has_link() { of_force } else { 0.0 }
    }

    /// Density of the white noise that is recorded with the effort, N^2 s, that of each trial counted by its rows: an effort of variance s^2 that is held
    /// for a row of dt has s^2 dt.
    #[must_use]
    pub fn effort_noise_density(&self) -> f64 {
        let of = |trial: &DriveTrial| trial.effort_variance() * trial.recorded_period_s;
        let rows: f64 = self.trials.iter().map(|trial| trial.len() as f64).sum();
        self.trials.iter().map(|trial| of(trial) * trial.len() as f64).sum::<f64>() / rows.max(1.0)
    }

    /// Innovations of every trial under `model`.
    #[must_use]
    pub fn innovations(&self, model: &Model, values: &[f64], noise: &Noise) -> Vec<Innovations> {
        let law = model.law(values);
        self.innovations_under(&Inputs::of_all(self.trials, &law), &law, noise)
    }

    /// The same under `inputs`, those of `law`.
    #[must_use]
    pub fn innovations_under(&self, inputs: &[Inputs], law: &DriveLaw, noise: &Noise) -> Vec<Innovations> {
        let each = self.trials.par_iter().zip(inputs);
        each.map(|(trial, inputs)| innovations_under(trial, inputs, law, noise, false)).collect()
    }

    /// ln of the likelihood and the prior, with the common scale of both variances at its best, and ln of that scale.
    #[must_use]
    pub fn log_likelihood(&self, model: &Model, values: &[f64], noise: &Noise) -> (f64, f64) {
        let (rows, scale) = self.profiled(&self.innovations(model, values, noise), noise);
        (rows + model.ln_prior(values), scale)
    }

    /// ln of the likelihood of `passes`, and of its scale:
    /// -1/2 sum (ln(2 pi s S) + e^2 / (s S)) with s = mean(e^2 / S), which is best, or as small as the encoder allows.
    #[must_use]
    pub fn profiled(&self, passes: &[Innovations], noise: &Noise) -> (f64, f64) {
        let (mut rows, mut squares, mut logs) = (0usize, 0.0, 0.0);
        // A filter that has settled has one variance for thousands of rows.
        let (mut latest, mut ln_latest) = (1.0, 0.0);
        self.scored(passes, |innovation, variance| {
            if variance != latest {
                (latest, ln_latest) = (variance, variance.ln());
            }
            rows += 1;
            squares += innovation * innovation / variance;
            logs += ln_latest;
        });
        let count = rows.max(1) as f64;
        let scale = (squares / count).max(self.least_encoder_variance / noise.encoder());
        let log_likelihood = -0.5 * (logs + count * (scale.ln() + std::f64::consts::TAU.ln()) + squares / scale);
        (if log_likelihood.is_finite() { log_likelihood } else { f64::NEG_INFINITY }, scale.ln())
    }

    /// Gives `each` scored innovation with its variance.
    pub fn scored(&self, passes: &[Innovations], mut each: impl FnMut(f64, f64)) {
        for (pass, trial) in passes.iter().zip(self.trials) {
            for (row, since) in trial.rows_since_restart().enumerate() {
                if since >= SETTLING_ROWS {
                    each(pass.innovation[row], pass.variance[row]);
                }
            }
        }
    }

    /// Innovations over the deviations of `reference`.
    #[must_use]
    pub fn standardised(&self, passes: &[Innovations], reference: &[Innovations]) -> Vec<f64> {
        let mut out = Vec::new();
        for ((pass, base), trial) in passes.iter().zip(reference).zip(self.trials) {
            for (row, since) in trial.rows_since_restart().enumerate() {
                if since >= SETTLING_ROWS {
                    out.push(pass.innovation[row] / base.variance[row].sqrt());
                }
            }
        }
        out
    }

    /// ln of the likelihood of each scored row, but for a constant, under the noise as it stands.
    #[must_use]
    pub fn row_log_likelihoods(&self, model: &Model, values: &[f64], noise: &Noise) -> Vec<f64> {
        let mut rows = Vec::new();
        let passes = self.innovations(model, values, noise);
        self.scored(&passes, |innovation, variance| {
            rows.push(-0.5 * (variance.ln() + innovation * innovation / variance));
        });
        rows
    }

    /// Scored rows of each trial.
    pub fn scored_rows(&self) -> impl Iterator<Item = usize> {
        self.trials.iter().map(|trial| trial.rows_since_restart().filter(|since| *since >= SETTLING_ROWS).count())
    }
}
