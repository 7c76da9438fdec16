//! What a residual is worth: scaled by the expected noise of its moment, prewhitened.
//!
//! The noise that the sensors leave in a residual differs from moment to moment (touching, turning) and is autocorrelated
//! over several rows, for every channel was smoothed. Divided by the expected noise of its moment and passed through the predictor
//! error filter that makes the expected noise white, a residual counts for what it is worth: 7500 coarse rows for a hundred.

use nalgebra::{DMatrix, DVector};

use crate::diagnose::linalg::{dot, energy};
use crate::diagnose::model::Residual;
use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};
use crate::diagnose::thresholds::whitener::{AR_ORDER, OWN_AUTOCORRELATION_POWER_RATIO};

/// The expected noise of one channel over all trials.
#[derive(Debug, Clone)]
pub struct NoiseModel {
    /// Deviation of what noise leaves, row by row, a vector a trial.
    pub deviation: Vec<Vec<f64>>,
    /// Weights of the rows before in the predictor error filter; the row itself counts one.
    predictor: Vec<f64>,
    /// Deviation of the predictor's error.
    scale: f64,
    /// Rows of each trial that count.
    pub rows: Vec<Vec<usize>>,
    /// Covariance of noise alone over the first lags, in squares of its deviation.
    noise: [f64; AR_ORDER + 1],
}

/// The noise models of both channels and the rows that count.
#[derive(Debug, Clone)]
pub struct Whitener {
    /// Of the force reading.
    pub force: Option<NoiseModel>,
    /// Of the drive's balance.
    pub effort: Option<NoiseModel>,
}

/// Rows of both channels, one after the other: force of all trials, then effort.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowOrigin {
    /// Trial.
    pub trial: usize,
    /// Row in it.
    pub row: usize,
    /// Whether of the effort channel.
    pub effort: bool,
}

impl NoiseModel {
    /// A expected noise that is the same everywhere and has no memory.
    #[must_use]
    pub fn even(filtered_trials: &[&FilteredTrial], deviation: f64) -> Self {
        let deviation = filtered_trials.iter().map(|filtered| vec![deviation; filtered.len()]).collect();
        Self { deviation, predictor: Vec::new(), scale: 1.0, rows: rows(filtered_trials), noise: [0.0; AR_ORDER + 1] }
    }

    /// The expected noise that `samples`, residuals of noise alone, leave: a vector of trials each.
    #[must_use]
    pub fn of(filtered_trials: &[&FilteredTrial], samples: &[Vec<Vec<f64>>]) -> Self {
        let mut deviation: Vec<Vec<f64>> =
            (0..filtered_trials.len()).map(|trial| local_deviation(filtered_trials[trial], samples, trial)).collect();
        // No moment is known better than a fraction of the rest of them.
        let mut all: Vec<f64> = deviation.iter().zip(filtered_trials).flat_map(|(d, t)| seen(d, t)).collect();
        // A stretch without any noise at all, a sensor that is off, does not tell what is typical.
        all.retain(|value| *value > 0.0);
        all.sort_unstable_by(f64::total_cmp);
        let typical = all.get(all.len() / 2).copied().unwrap_or(1.0);
        let least = (0.3 * typical).max(f64::MIN_POSITIVE);
        deviation.iter_mut().flatten().for_each(|value| *value = if *value > least { *value } else { least });
        let mut noise_model = Self {
            deviation,
            predictor: Vec::new(),
            scale: 1.0,
            rows: rows(filtered_trials),
            noise: [0.0; AR_ORDER + 1],
        };
        for sample in samples {
            let own = noise_model.covariance(sample.iter());
            noise_model.noise.iter_mut().zip(own).for_each(|(sum, own)| *sum += own / samples.len() as f64);
        }
        noise_model
    }

    /// Covariance over the first lags of residuals, a vector a trial, in squares of the expected noise's deviation.
    fn covariance<'a>(&self, residuals: impl Iterator<Item = &'a Vec<f64>>) -> [f64; AR_ORDER + 1] {
        let mut covariance = [0.0; AR_ORDER + 1];
        let mut count = 0.0f64;
        for (trial, values) in residuals.enumerate() {
            let scaled: Vec<f64> = values.iter().zip(&self.deviation[trial]).map(|(v, d)| v / d).collect();
            for &at in &self.rows[trial] {
                count += 1.0;
                for (lag, sum) in covariance.iter_mut().enumerate() {
                    *sum += scaled[at] * scaled[at - lag];
                }
            }
        }
        covariance.map(|sum| sum / count.max(1.0))
    }

    /// The predictor by the Yule-Walker equations, from residuals of a recording or a replicate.
    ///
    /// A residual that is about as large as noise tells its own memory, and so is worth what it is worth whatever its
    /// colour. One that is far larger is no noise: what is left out would pass for memory and be taken off. There the
    /// memory is that of the replicates.
    fn fit_ar<'a>(&mut self, residuals: impl Iterator<Item = &'a Vec<f64>>) {
        let own = self.covariance(residuals);
        if own[0] <= 0.0 || !own[0].is_finite() {
            return;
        }
        let share = if self.noise[0] > 0.0 {
            (OWN_AUTOCORRELATION_POWER_RATIO * self.noise[0] / own[0]).min(1.0).powi(2)
        } else {
            1.0
        };
        let mix = |lag: usize| {
            let noise = if self.noise[0] > 0.0 { self.noise[lag] / self.noise[0] } else { 0.0 };
            share * own[lag] / own[0] + (1.0 - share) * noise
        };
        let covariance: [f64; AR_ORDER + 1] = std::array::from_fn(mix);
        // A thousandth of white noise beside: no spectrum is known to be empty anywhere.
        let matrix =
            DMatrix::from_fn(AR_ORDER, AR_ORDER, |i, j| covariance[i.abs_diff(j)] + if i == j { 1e-3 } else { 0.0 });
        let right = DVector::from_fn(AR_ORDER, |i, _| covariance[i + 1]);
        let Some(solved) = matrix.cholesky().map(|factors| factors.solve(&right)) else { return };
        self.predictor = solved.iter().copied().collect();
        let weight = |k: usize| if k == 0 { 1.0 } else { -self.predictor[k - 1] };
        let mut energy = 0.0;
        for i in 0..=AR_ORDER {
            for j in 0..=AR_ORDER {
                energy += weight(i) * weight(j) * covariance[i.abs_diff(j)];
            }
        }
        // In the units of the smaller of the two: a residual beyond noise is to count for more than noise.
        let size =
            if self.noise[0] > 0.0 { own[0].min(OWN_AUTOCORRELATION_POWER_RATIO * self.noise[0]) } else { own[0] };
        self.scale = (energy * size).max(f64::MIN_POSITIVE).sqrt();
    }

    /// Whitened `values` of a trial, on those rows that count: before each of them all rows are there that the predictor
    /// asks for.
    fn whiten<'a>(&'a self, trial: usize, values: &[f64]) -> impl Iterator<Item = f64> + use<'a> {
        let scaled: Vec<f64> = values.iter().zip(&self.deviation[trial]).map(|(v, d)| v / d).collect();
        let backwards: Vec<f64> = self.predictor.iter().rev().copied().collect();
        let ahead = move |at: &usize| {
            let expected = dot(&backwards, &scaled[at - backwards.len()..*at]);
            (scaled[*at] - expected) / self.scale
        };
        self.rows[trial].iter().map(ahead)
    }
}

/// Deviation over the samples and a few rows either side.
fn local_deviation(filtered: &FilteredTrial, samples: &[Vec<Vec<f64>>], trial: usize) -> Vec<f64> {
    let rows = filtered.len();
    let mut energy = vec![0.0; rows + 1];
    for at in 0..rows {
        let square: f64 = samples.iter().map(|sample| sample[trial][at] * sample[trial][at]).sum();
        energy[at + 1] = energy[at] + square / samples.len() as f64;
    }
    (0..rows)
        .map(|at| {
            let (from, to) = (at.saturating_sub(2), (at + 3).min(rows));
            ((energy[to] - energy[from]) / (to - from) as f64).max(0.0).sqrt()
        })
        .collect()
}

fn seen(values: &[f64], filtered: &FilteredTrial) -> Vec<f64> {
    values.iter().zip(&filtered.valid).filter(|(_, valid)| **valid).map(|(value, _)| *value).collect()
}

/// Rows that were seen whole together with those before them that the predictor asks for.
fn rows(filtered_trials: &[&FilteredTrial]) -> Vec<Vec<usize>> {
    let whole = |filtered: &&FilteredTrial| {
        (AR_ORDER..filtered.len()).filter(|at| filtered.valid[at - AR_ORDER..=*at].iter().all(|valid| *valid)).collect()
    };
    filtered_trials.iter().map(whole).collect()
}

impl Whitener {
    /// The same noise models, the memory told by `residuals`: that of a recording by its own residual, that of a replicate by its own.
    #[must_use]
    pub fn with_fitted_ar(&self, residuals: &[Residual]) -> Self {
        let mut fresh = self.clone();
        if let Some(noise_model) = &mut fresh.force {
            noise_model.fit_ar(residuals.iter().map(|residual| &residual.force));
        }
        if let Some(noise_model) = &mut fresh.effort {
            noise_model.fit_ar(residuals.iter().map(|residual| &residual.effort));
        }
        fresh
    }

    /// The same, no moment's expected noise half as much again above that of `before`.
    #[must_use]
    pub fn limited_by(mut self, before: &Self) -> Self {
        let channels = [(&mut self.force, &before.force), (&mut self.effort, &before.effort)];
        for (noise_model, before) in
            channels.into_iter().filter_map(|(noise_model, before)| Some((noise_model.as_mut()?, before.as_ref()?)))
        {
            let pairs = noise_model.deviation.iter_mut().flatten().zip(before.deviation.iter().flatten());
            pairs.for_each(|(deviation, before)| *deviation = deviation.min(1.5 * before));
        }
        self
    }

    /// The same noise models without their memory.
    #[must_use]
    pub fn without_autocorrelation(&self) -> Self {
        let plain = |noise_model: &Option<NoiseModel>| {
            noise_model.as_ref().map(|noise_model| NoiseModel {
                predictor: Vec::new(),
                scale: 1.0,
                ..noise_model.clone()
            })
        };
        Self { force: plain(&self.force), effort: plain(&self.effort) }
    }

    /// Where each whitened value comes from.
    #[must_use]
    pub fn origins(&self) -> Vec<RowOrigin> {
        let channel = |effort: bool, noise_model: &Option<NoiseModel>| {
            let trials: Vec<Vec<usize>> = noise_model.iter().flat_map(|noise_model| noise_model.rows.clone()).collect();
            trials
                .into_iter()
                .enumerate()
                .flat_map(move |(trial, rows)| rows.into_iter().map(move |row| RowOrigin { trial, row, effort }))
        };
        channel(false, &self.force).chain(channel(true, &self.effort)).collect()
    }

    /// Rows of the force channel, which come first.
    #[must_use]
    pub fn force_rows(&self) -> usize {
        self.force.iter().flat_map(|noise_model| &noise_model.rows).map(Vec::len).sum()
    }

    /// Mean squares of whitened residuals of all trials, of force and of effort.
    #[must_use]
    pub fn powers(&self, white: &[f64]) -> [f64; 2] {
        let (force, effort) = white.split_at(self.force_rows());
        [force, effort].map(|rows| energy(rows) / rows.len().max(1) as f64)
    }

    /// The whitened residuals of all trials; a channel that was not asked for is zero.
    #[must_use]
    pub fn whiten(&self, residuals: &[Residual]) -> Vec<f64> {
        let mut out = Vec::new();
        let mut channel = |noise_model: &NoiseModel, pick: &dyn Fn(&Residual) -> &Vec<f64>| {
            for (trial, rows) in noise_model.rows.iter().enumerate() {
                let values = pick(&residuals[trial]);
                if values.is_empty() {
                    out.extend(std::iter::repeat_n(0.0, rows.len()));
                } else {
                    out.extend(noise_model.whiten(trial, values));
                }
            }
        };
        if let Some(noise_model) = &self.force {
            channel(noise_model, &|residual| &residual.force);
        }
        if let Some(noise_model) = &self.effort {
            channel(noise_model, &|residual| &residual.effort);
        }
        out
    }
}

/// The tracks of a channel.
#[must_use]
pub fn filtered_trials(trials: &[AnalysisTrial], effort: bool) -> Vec<&FilteredTrial> {
    trials.iter().map(|trial| trial.filtered(effort)).collect()
}
