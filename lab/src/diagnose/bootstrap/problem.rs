//! What is investigated: trials, and the rig's nominal model that they are held against.

use rayon::prelude::*;

use super::sampler::Studio;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data, Fit};
use crate::diagnose::estimation::whitener::{Floor, Whitener, tracks};
use crate::diagnose::model::excitation::scene;
use crate::diagnose::model::{Model, Term, index};
use crate::diagnose::signals::derivative_filter::Lens;
use crate::diagnose::signals::filtered_trial::Track;
use crate::effects::{self, Scene};
use crate::error::InputError;
use crate::rig::{Coordinate, Rig};

/// The trials and the rig they are held against.
pub struct Study {
    /// Trials and their twins.
    pub studio: Studio,
    /// The rig's nominal model.
    pub nominal: Model,
    /// Values of the rig file.
    pub given: Vec<f64>,
    /// Whether the rig turns.
    pub is_rotary: bool,
}

impl Study {
    /// Prepares trials that have been looked at. Effects that the rig file already holds belong to its nominal model.
    ///
    /// # Errors
    /// An effect of the rig file that cannot be.
    pub fn new(rig: &Rig, origin: &str, studio: Studio) -> Result<Self, InputError> {
        let has = |pick: &dyn Fn(&Track) -> bool| studio.trials.iter().all(|trial| pick(&trial.contact));
        let force = has(&|track| track.force.is_some());
        let contact = rig.contact.filter(|_| force);
        let drive = rig.drive.filter(|_| has(&|track| track.effort.is_some()));
        let mut nominal = Model {
            contact: contact.map(|contact| contact.bilateral),
            drive: drive.is_some(),
            given_stiffness: contact.map_or(0.0, |contact| contact.stiffness),
            given_inertia: drive.map_or(0.0, |drive| drive.inertia),
            force_zero: rig.sensors.force_zero.unwrap_or(0.0),
            shifts: studio.raws.iter().skip(1).map(|raw| raw.figures.position.resolution).collect(),
            terms: Vec::new(),
        };
        let mut given = vec![0.0; nominal.nominals()];
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
            if nominal.takes(term.effect.card().place) {
                given.extend(term.spread(&known.values, nominal.trials()));
                nominal.terms.push(term);
            }
        }
        Ok(Self { studio, nominal, given, is_rotary: rig.coordinate == Coordinate::Rotary })
    }

    /// The measures of the trials under `model`.
    #[must_use]
    pub fn scene(&self, model: &Model, values: &[f64]) -> Scene {
        scene(&self.studio.trials, model, values, self.studio.lens.period, self.is_rotary)
    }

    /// The nominal model fitted under floors that are not known yet, from several places of the surface.
    #[must_use]
    pub fn first_fit(&self) -> Vec<f64> {
        let whitener = self.even_floors();
        let data = Data { trials: &self.studio.trials, whitener: &whitener, rows: None };
        let mut starts = vec![self.given.clone()];
        if self.nominal.contact == Some(false) {
            starts.extend(self.surfaces().into_iter().map(|surface| {
                let mut start = self.given.clone();
                start[index::SURFACE] = surface;
                start
            }));
        }
        let fits = starts
            .par_iter()
            .map(|start| levenberg_marquardt::fit(&data, &self.nominal, start, &self.scene(&self.nominal, start)));
        let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy));
        best.map_or_else(|| self.given.clone(), |fit| fit.values)
    }

    /// Positions at which the contact may begin: spread over those that were reached.
    #[must_use]
    pub fn surfaces(&self) -> Vec<f64> {
        let mut reached: Vec<f64> =
            self.studio.trials.iter().flat_map(|trial| trial.contact.position.iter().copied()).collect();
        reached.sort_unstable_by(f64::total_cmp);
        let last = reached.len().saturating_sub(1);
        [0.02, 0.2, 0.4, 0.6, 0.8].iter().map(|part| reached[(part * last as f64) as usize]).collect()
    }

    /// Floors that are the same everywhere and have no memory: the noise of the sensors behind the lenses.
    #[must_use]
    pub fn even_floors(&self) -> Whitener {
        let raws = &self.studio.raws;
        let noise = |lens: &Lens, pick: &dyn Fn(usize) -> Option<f64>| {
            let all: Vec<f64> = (0..raws.len()).filter_map(pick).collect();
            (all.iter().sum::<f64>() / all.len().max(1) as f64 * lens.noise()[0]).max(f64::MIN_POSITIVE.sqrt())
        };
        let figure = |at: usize| raws[at].figures.force.map(|force| force.noise);
        let force = noise(&self.studio.lens, &figure);
        let drive = &self.studio.drive_lens;
        let effort = noise(drive, &figure).max(noise(drive, &|at| raws[at].figures.effort.map(|effort| effort.noise)));
        let even = |effort: bool, deviation: f64| Floor::even(&tracks(&self.studio.trials, effort), deviation);
        Whitener {
            force: self.nominal.contact.map(|_| even(false, force)),
            effort: self.nominal.drive.then(|| even(true, effort)),
        }
    }

    /// The best values of `model` under `whitener`.
    #[must_use]
    pub fn fit(&self, model: &Model, start: &[f64], whitener: &Whitener) -> Fit {
        let data = Data { trials: &self.studio.trials, whitener, rows: None };
        levenberg_marquardt::fit(&data, model, start, &self.scene(model, start))
    }
}
