//! A fitted model with its replicates, and what they say of the noise.

use rayon::prelude::*;

use super::problem::IdentificationProblem;
use super::sampler::TrialNoise;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData, FitResult};
use crate::diagnose::estimation::projection::ProjectedResidual;
use crate::diagnose::estimation::residual_summary::{ResidualSummary, summarize};
use crate::diagnose::estimation::whitener::{NoiseModel, Whitener, filtered_trials};
use crate::diagnose::linalg::energy;
use crate::diagnose::model::{Channels, Model, Residual, Term, index};
use crate::diagnose::signals::filtered_trial::AnalysisTrial;
use crate::diagnose::thresholds::fitted_model::{
    CONTACT_QUANTIZATION_FACTOR, DIVERGENCE_RATIO, DRIVE_QUANTIZATION_FACTOR, LARGE_MISFIT_RATIO, MAX_BIAS_FRACTION,
    MAX_REFITS, MIN_QUANTIZATION_POWER, NOISE_REPLICATES,
};
use crate::effects::ExcitationStats;

/// A fitted model and what noise alone would leave of it.
pub struct FittedModel {
    /// The model.
    pub model: Model,
    /// Its fitted values.
    pub values: Vec<f64>,
    /// The values that replicates are made from: those whose replicates, fitted, give the fitted values in the mean.
    pub generating_values: Vec<f64>,
    /// The measures of the trials under it.
    pub excitation: ExcitationStats,
    /// Floors told by replicates.
    pub whitener: Whitener,
    /// White noise of each trial.
    pub noise: Vec<TrialNoise>,
    /// What the model leaves, whitened.
    pub summary: ResidualSummary,
    /// The same of each replicate.
    pub replicates: Vec<ResidualSummary>,
}

impl FittedModel {
    /// Power of what is left over that of what replicates leave, in the channel in which it is greater.
    #[must_use]
    pub fn power_ratio(&self) -> f64 {
        let [force, effort] = self.power_ratios();
        force.max(effort)
    }

    /// Power of what is left over that of what replicates leave, of force and effort.
    #[must_use]
    pub fn power_ratios(&self) -> [f64; 2] {
        [0, 1].map(|channel| {
            let replicates = self.replicates.iter().map(|summary| summary.powers[channel]).sum::<f64>();
            if replicates > 0.0 {
                self.summary.powers[channel] * self.replicates.len() as f64 / replicates
            } else {
                0.0
            }
        })
    }
}

/// A first look at replicates, for the expected noise.
struct PilotReplicates {
    noise: Vec<TrialNoise>,
    replicates: Vec<Vec<AnalysisTrial>>,
    residuals: Vec<Vec<Residual>>,
}

/// `moved`, no further from the fitted value than a bias is believed: one of more than half an effect's value is not told from replicates,
/// and the effect is not turned off by it.
#[must_use]
pub fn near(model: &Model, values: &[f64], at: usize, moved: f64) -> f64 {
    let part = if at < model.nominal_count() { f64::INFINITY } else { MAX_BIAS_FRACTION * values[at].abs() };
    moved.max(values[at] - part).min(values[at] + part)
}

impl IdentificationProblem {
    /// Stands on `model`: fits it under noise models told by replicates, and asks the recording and `count` replicates the same questions.
    ///
    /// A better model does not make the sensors worse: no moment's expected noise rises far above what it was `before`.
    #[must_use]
    pub fn fit_with_replicates(
        &self,
        model: &Model,
        start: &[f64],
        count: usize,
        before: Option<&Whitener>,
    ) -> FittedModel {
        let first = self.pilot(model, start, start);
        let noise_models = self.noise_models_of(model, &first, before);
        let fitted = self.fit_under(model, start, &noise_models);
        let mut generating_values = self.correct_bias(model, &fitted, start, &noise_models, &first.replicates);
        let mut second = self.pilot(model, &fitted, &generating_values);
        if residual_energy(&second.residuals) > DIVERGENCE_RATIO * residual_energy(&first.residuals) {
            // Values that next to nothing tells apart were led astray.
            generating_values.clone_from(&fitted);
            second = self.pilot(model, &fitted, &generating_values);
        }
        let mut noise_models = self.noise_models_of(model, &second, before);
        let mut values = self.fit_under(model, &fitted, &noise_models);
        // The expected noise depends on the values and they on the expected noise, weakly: twice is enough. Where much is missing they may yet have
        // gone on, and replicates of where they were would show that way as the sensors' noise.
        for _ in 0..MAX_REFITS {
            if !self.has_diverged(model, &values, &second, &noise_models) {
                break;
            }
            generating_values.clone_from(&values);
            second = self.pilot(model, &values, &generating_values);
            noise_models = self.noise_models_of(model, &second, before);
            values = self.fit_under(model, &values, &noise_models);
        }
        let noise = second.noise;
        let whitener = noise_models.with_fitted_ar(&self.rests(model, &values, &self.sampler.trials));
        let excitation = self.excitation_stats(model, &values);
        let noise_free = self.sampler.noise_free(model, &generating_values);
        let own_summary =
            summarize(&self.sampler.trials, &whitener, model, &values, &excitation, &|term| !term.refines());
        let promising: Vec<Term> = own_summary.promising().map(|score| score.term).collect();
        let asked = |term: &Term| promising.iter().any(|other| other.is(term));
        let replicates = (0..count as u64)
            .into_par_iter()
            .map(|number| {
                let replicate = self.sampler.replicate(&noise_free, &noise, number);
                let own = noise_models.with_fitted_ar(&self.rests(model, &values, &replicate));
                summarize(&replicate, &own, model, &values, &excitation, &asked)
            })
            .collect();
        FittedModel {
            model: model.clone(),
            values,
            generating_values,
            excitation,
            whitener,
            noise,
            summary: own_summary,
            replicates,
        }
    }

    /// Whether `values` leave far more of the replicates than those do that the replicates were seen by, in a channel.
    fn has_diverged(&self, model: &Model, values: &[f64], pilot: &PilotReplicates, noise_models: &Whitener) -> bool {
        let plain = noise_models.without_autocorrelation();
        let power = |residuals: &[Vec<Residual>]| {
            let powers = residuals.iter().map(|residuals| plain.powers(&plain.whiten(residuals)));
            powers.fold([0.0; 2], |sum, powers| [0, 1].map(|channel| sum[channel] + powers[channel]))
        };
        let residuals: Vec<Vec<Residual>> =
            pilot.replicates.par_iter().map(|replicate| self.rests(model, values, replicate)).collect();
        let (now, then) = (power(&residuals), power(&pilot.residuals));
        (0..2).any(|channel| now[channel] > DIVERGENCE_RATIO * then[channel])
    }

    /// Replicates made from `generating_values`, and what `values` leave of them.
    fn pilot(&self, model: &Model, values: &[f64], generating_values: &[f64]) -> PilotReplicates {
        let noise_free = self.sampler.noise_free(model, generating_values);
        let noise = self.sampler.noise(model, values, &noise_free);
        let numbers = (0..NOISE_REPLICATES as u64).into_par_iter();
        let replicates: Vec<Vec<AnalysisTrial>> =
            numbers.map(|number| self.sampler.replicate(&noise_free, &noise, 1000 + number)).collect();
        let residuals = replicates.par_iter().map(|replicate| self.rests(model, values, replicate)).collect();
        PilotReplicates { noise, replicates, residuals }
    }

    fn noise_models_of(&self, model: &Model, pilot: &PilotReplicates, before: Option<&Whitener>) -> Whitener {
        let noise_models = self.noise_models(model, &pilot.residuals);
        match before {
            Some(before) => noise_models.limited_by(before),
            None => noise_models,
        }
    }

    fn fit_under(&self, model: &Model, start: &[f64], noise_models: &Whitener) -> Vec<f64> {
        let own = noise_models.with_fitted_ar(&self.rests(model, start, &self.sampler.trials));
        self.fit(model, start, &own).values
    }

    /// `generating_values`, which `replicates` were made from, moved by what their fits miss `values` in the mean; `values` of a drive that was
    /// cut, for its replicates keep the recorded commands.
    ///
    /// A fit to noisy motion is biased: noise in the acceleration weakens the mass. So are the fits to replicates, and those of
    /// replicates that are made from what the bias hides come out as the recording does (indirect inference: C. Gourieroux,
    /// A. Monfort, E. Renault, J. Appl. Econom. 8 (1993) S85).
    fn correct_bias(
        &self,
        model: &Model,
        values: &[f64],
        generating_values: &[f64],
        noise_models: &Whitener,
        replicates: &[Vec<AnalysisTrial>],
    ) -> Vec<f64> {
        if model.effort_limit(values, 0).is_some() {
            return values.to_vec();
        }
        let excitation = self.excitation_stats(model, values);
        let surface_shifts: Vec<Vec<f64>> = replicates
            .par_iter()
            .map(|replicate| {
                let whitener = noise_models.with_fitted_ar(&self.rests(model, values, replicate));
                let data = FitData { trials: replicate, whitener: &whitener, rows: None };
                ProjectedResidual::of(data, model, values, &excitation).shift
            })
            .collect();
        let axes = levenberg_marquardt::parameter_bounds(model, values, &excitation);
        let moved = generating_values.iter().zip(axes).enumerate().map(|(at, (generating_values, axis))| {
            let mean = surface_shifts.iter().map(|shift| shift[at]).sum::<f64>() / surface_shifts.len().max(1) as f64;
            let most = MAX_BIAS_FRACTION * axis.scale;
            let moved = (generating_values - mean.max(-most).min(most)).clamp(axis.low, axis.high);
            near(model, values, at, moved)
        });
        moved.collect()
    }

    /// The best values of `model`, which is that of `fitted_model` and one more effect that starts at `own`.
    ///
    /// Where much is missing, the nominal values were bent to make up for it, the surface above all: the search then starts
    /// from other surfaces as well.
    #[must_use]
    pub fn fit_from_surfaces(
        &self,
        data: &FitData<'_>,
        fitted_model: &FittedModel,
        model: &Model,
        own: &[f64],
    ) -> FitResult {
        let from = |values: &[f64]| {
            let start: Vec<f64> = values.iter().chain(own).copied().collect();
            levenberg_marquardt::fit(data, model, &start, &fitted_model.excitation)
        };
        let mut best = from(&fitted_model.values);
        if self.nominal.contact == Some(false) && fitted_model.power_ratio() > LARGE_MISFIT_RATIO {
            for surface in self.surfaces() {
                let mut values = fitted_model.values.clone();
                values[index::SURFACE] = surface;
                values[index::STIFFNESS] = self.given[index::STIFFNESS];
                let fit = from(&values);
                if fit.energy < best.energy {
                    best = fit;
                }
            }
        }
        best
    }

    /// Power over the expected noise's, of force and effort, that an encoder's steps alone may leave, which replicates of a smoothed motion
    /// do not show in full: a tool that creeps or rests is misplaced by part of a step for as long as it does, and a stiff
    /// contact turns that into a force far above the sensor's noise; and a drive that answers its encoder's steps shakes the
    /// tool by less than a step. One where the steps do not matter.
    #[must_use]
    pub fn quantization_power(&self, values: &[f64]) -> [f64; 2] {
        let [level, _, bend] = self.sampler.drive_filter.noise();
        let most = |share: &dyn Fn(f64, f64) -> f64| {
            let shares = self.sampler.uniform_trials.iter().map(|raw| {
                let force = raw.figures.force.map_or(f64::INFINITY, |force| force.noise);
                share(raw.figures.position.resolution / 12f64.sqrt(), force.max(f64::MIN_POSITIVE))
            });
            shares.filter(|share| share.is_finite()).fold(0.0, f64::max)
        };
        let spring = most(&|rounding, force| values[index::STIFFNESS] * rounding / force);
        let inertia = most(&|rounding, force| values[index::INERTIA] * rounding * bend / (force * level));
        [1.0 + CONTACT_QUANTIZATION_FACTOR * spring * spring, 1.0 + DRIVE_QUANTIZATION_FACTOR * inertia * inertia]
    }

    /// Whether what `fitted_model` leaves of force and of effort may be the encoder's.
    #[must_use]
    pub fn within_quantization(&self, fitted_model: &FittedModel) -> [bool; 2] {
        let (quantization_power, ratios) = (self.quantization_power(&fitted_model.values), fitted_model.power_ratios());
        [0, 1].map(|channel| {
            quantization_power[channel] > MIN_QUANTIZATION_POWER && ratios[channel] < quantization_power[channel]
        })
    }

    /// Power over the expected noise's in the channel in which it is greater, of those that can be trusted.
    #[must_use]
    pub fn trusted_ratio(&self, fitted_model: &FittedModel) -> f64 {
        let (within_quantization, ratios) = (self.within_quantization(fitted_model), fitted_model.power_ratios());
        (0..2).filter(|channel| !within_quantization[*channel]).map(|channel| ratios[channel]).fold(0.0, f64::max)
    }

    /// Residuals of a replicate of `fitted_model`.
    #[must_use]
    pub fn replicate_residuals(&self, fitted_model: &FittedModel) -> Vec<Residual> {
        let noise_free = self.sampler.noise_free(&fitted_model.model, &fitted_model.generating_values);
        self.rests(
            &fitted_model.model,
            &fitted_model.values,
            &self.sampler.replicate(&noise_free, &fitted_model.noise, 0),
        )
    }

    fn rests(&self, model: &Model, values: &[f64], trials: &[AnalysisTrial]) -> Vec<Residual> {
        trials.iter().map(|trial| model.residual(values, trial, Channels::BOTH)).collect()
    }

    fn noise_models(&self, model: &Model, samples: &[Vec<Residual>]) -> Whitener {
        let of = |effort: bool, pick: &dyn Fn(&Residual) -> Vec<f64>| {
            let values: Vec<Vec<Vec<f64>>> =
                samples.iter().map(|residuals| residuals.iter().map(pick).collect()).collect();
            NoiseModel::of(&filtered_trials(&self.sampler.trials, effort), &values)
        };
        Whitener {
            force: model.contact.map(|_| of(false, &|residual| residual.force.clone())),
            effort: model.drive.then(|| of(true, &|residual| residual.effort.clone())),
        }
    }
}

/// Energy of all that replicates leave, of both channels.
fn residual_energy(samples: &[Vec<Residual>]) -> f64 {
    samples.iter().flatten().map(|residual| energy(&residual.force) + energy(&residual.effort)).sum()
}
