//! What is investigated: trials, and the rig's nominal model that they are held against.

use rayon::prelude::*;

use super::sampler::BootstrapSampler;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData, FitResult};
use crate::diagnose::estimation::whitener::{NoiseModel, Whitener, filtered_trials};
use crate::diagnose::model::excitation::excitation_stats;
use crate::diagnose::model::{Model, Term, index};
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::effects::{self, ExcitationStats};
use crate::error::InputError;
use crate::rig::{Coordinate, Rig};

/// The trials and the rig they are held against.
pub struct IdentificationProblem {
    /// Trials and their replicates.
    pub sampler: BootstrapSampler,
    /// The rig's nominal model.
    pub nominal: Model,
    /// Values of the rig file.
    pub given: Vec<f64>,
    /// Whether the rig turns.
    pub is_rotary: bool,
}

impl IdentificationProblem {
    /// Prepares trials that have been looked at. Effects that the rig file already holds belong to its nominal model.
    ///
    /// # Errors
    /// An effect of the rig file that cannot be.
    pub fn new(rig: &Rig, origin: &str, sampler: BootstrapSampler) -> Result<Self, InputError> {
        let has = |pick: &dyn Fn(&FilteredTrial) -> bool| sampler.trials.iter().all(|trial| pick(&trial.contact));
        let force = has(&|filtered| filtered.force.is_some());
        let contact = rig.contact.filter(|_| force);
        let drive = rig.drive.filter(|_| has(&|filtered| filtered.effort.is_some()));
        let mut nominal = Model {
            contact: contact.map(|contact| contact.bilateral),
            drive: drive.is_some(),
            given_stiffness: contact.map_or(0.0, |contact| contact.stiffness),
            given_inertia: drive.map_or(0.0, |drive| drive.inertia),
            force_zero: rig.sensors.force_zero.unwrap_or(0.0),
            surface_shifts: sampler.uniform_trials.iter().skip(1).map(|raw| raw.figures.position.resolution).collect(),
            terms: Vec::new(),
        };
        let mut given = vec![0.0; nominal.nominal_count()];
        if let Some(contact) = contact {
            given[index::STIFFNESS] = contact.stiffness;
            given[index::DAMPING] = contact.damping;
            given[index::SURFACE] = contact.surface;
        }
        if let Some(drive) = drive {
            given[index::INERTIA] = drive.inertia;
            given[index::VISCOUS] = drive.viscous;
        }
        for known in effects::resolve_all(rig, origin)? {
            let term = Term { effect: known.effect, form: known.form };
            if nominal.takes(term.effect.spec().place) {
                given.extend(term.spread(&known.values, nominal.trials()));
                nominal.terms.push(term);
            }
        }
        Ok(Self { sampler, nominal, given, is_rotary: rig.coordinate == Coordinate::Rotary })
    }

    /// The measures of the trials under `model`.
    #[must_use]
    pub fn excitation_stats(&self, model: &Model, values: &[f64]) -> ExcitationStats {
        excitation_stats(&self.sampler.trials, model, values, self.sampler.contact_filter.period, self.is_rotary)
    }

    /// The nominal model fitted under noise models that are not known yet, from several places of the surface.
    #[must_use]
    pub fn initial_fit(&self) -> Vec<f64> {
        let whitener = self.uniform_noise_models();
        let data = FitData { trials: &self.sampler.trials, whitener: &whitener, rows: None };
        let mut starts = vec![self.given.clone()];
        if self.nominal.contact == Some(false) {
            starts.extend(self.surfaces().into_iter().map(|surface| {
                let mut start = self.given.clone();
                start[index::SURFACE] = surface;
                start
            }));
        }
        let fits = starts.par_iter().map(|start| {
            levenberg_marquardt::fit(&data, &self.nominal, start, &self.excitation_stats(&self.nominal, start))
        });
        let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy));
        best.map_or_else(|| self.given.clone(), |fit| fit.values)
    }

    /// Positions at which the contact may begin: spread over those that were reached.
    #[must_use]
    pub fn surfaces(&self) -> Vec<f64> {
        let mut reached: Vec<f64> =
            self.sampler.trials.iter().flat_map(|trial| trial.contact.position.iter().copied()).collect();
        reached.sort_unstable_by(f64::total_cmp);
        let last = reached.len().saturating_sub(1);
        [0.02, 0.2, 0.4, 0.6, 0.8].iter().map(|part| reached[(part * last as f64) as usize]).collect()
    }

    /// Floors that are the same everywhere and have no memory: the noise of the sensors behind the filters.
    #[must_use]
    pub fn uniform_noise_models(&self) -> Whitener {
        let uniform_trials = &self.sampler.uniform_trials;
        let noise = |filter: &DerivativeFilter, pick: &dyn Fn(usize) -> Option<f64>| {
            let all: Vec<f64> = (0..uniform_trials.len()).filter_map(pick).collect();
            (all.iter().sum::<f64>() / all.len().max(1) as f64 * filter.noise()[0]).max(f64::MIN_POSITIVE.sqrt())
        };
        let figure = |at: usize| uniform_trials[at].figures.force.map(|force| force.noise);
        let force = noise(&self.sampler.contact_filter, &figure);
        let drive = &self.sampler.drive_filter;
        let effort =
            noise(drive, &figure).max(noise(drive, &|at| uniform_trials[at].figures.effort.map(|effort| effort.noise)));
        let even =
            |effort: bool, deviation: f64| NoiseModel::even(&filtered_trials(&self.sampler.trials, effort), deviation);
        Whitener {
            force: self.nominal.contact.map(|_| even(false, force)),
            effort: self.nominal.drive.then(|| even(true, effort)),
        }
    }

    /// The best values of `model` under `whitener`.
    #[must_use]
    pub fn fit(&self, model: &Model, start: &[f64], whitener: &Whitener) -> FitResult {
        let data = FitData { trials: &self.sampler.trials, whitener, rows: None };
        levenberg_marquardt::fit(&data, model, start, &self.excitation_stats(model, start))
    }
}
