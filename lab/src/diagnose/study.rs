//! One state of the investigation: a model, fitted, with its twins and what they say of the noise.

use rayon::prelude::*;

use super::fit::{self, Data, Fit};
use super::lens::Lens;
use super::measure::scene;
use super::model::{Channels, Model, Rest, Term, index};
use super::score::Remainder;
use super::track::{Track, Trial};
use super::twin::{Noise, Studio};
use super::view::{View, view};
use super::whiten::{Floor, Whitener, tracks};
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

/// A fitted model and what noise alone would leave of it.
pub struct Stand {
    /// The model.
    pub model: Model,
    /// Its fitted values.
    pub values: Vec<f64>,
    /// The values that twins are made from: those whose twins, fitted, give the fitted values in the mean.
    pub origin: Vec<f64>,
    /// The measures of the trials under it.
    pub scene: Scene,
    /// Floors told by twins.
    pub whitener: Whitener,
    /// White noise of each trial.
    pub noise: Vec<Noise>,
    /// What the model leaves, whitened.
    pub view: View,
    /// The same of each twin.
    pub twins: Vec<View>,
}

impl Stand {
    /// Power of what is left over that of what twins leave, in the channel in which it is greater.
    #[must_use]
    pub fn power_ratio(&self) -> f64 {
        let [force, effort] = self.power_ratios();
        force.max(effort)
    }

    /// Power of what is left over that of what twins leave, of force and effort.
    #[must_use]
    pub fn power_ratios(&self) -> [f64; 2] {
        [0, 1].map(|channel| {
            let twins = self.twins.iter().map(|view| view.powers[channel]).sum::<f64>();
            if twins > 0.0 { self.view.powers[channel] * self.twins.len() as f64 / twins } else { 0.0 }
        })
    }
}

/// Power over the noise's from which much is missing.
const MUCH: f64 = 30.0;

/// Doubt from which a residual within it is not looked into.
const DOUBTFUL: f64 = 1.2;

/// Part of a rounding's power that is taken for possible.
const DOUBT: f64 = 1.0;

/// The same of a rounding's power in the balance of the drive.
const SHAKEN: f64 = 0.012;

/// Share of its scale by which a value may be biased.
const FAR: f64 = 0.5;

/// Growth of what twins leave beyond which their origin is astray.
const LOUD: f64 = 2.0;

/// Twins that tell the floor.
const FOR_FLOOR: usize = 24;

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

    /// Power over the floor's, of force and effort, that an encoder's steps alone may leave, which twins of a smoothed motion
    /// do not show in full: a tool that creeps or rests is misplaced by part of a step for as long as it does, and a stiff
    /// contact turns that into a force far above the sensor's noise; and a drive that answers its encoder's steps shakes the
    /// tool by less than a step. One where the steps do not matter.
    #[must_use]
    pub fn doubts(&self, values: &[f64]) -> [f64; 2] {
        let [level, _, bend] = self.studio.drive_lens.noise();
        let most = |share: &dyn Fn(f64, f64) -> f64| {
            let shares = self.studio.raws.iter().map(|raw| {
                let force = raw.figures.force.map_or(f64::INFINITY, |force| force.noise);
                share(raw.figures.position.resolution / 12f64.sqrt(), force.max(f64::MIN_POSITIVE))
            });
            shares.filter(|share| share.is_finite()).fold(0.0, f64::max)
        };
        let spring = most(&|rounding, force| values[index::STIFFNESS] * rounding / force);
        let inertia = most(&|rounding, force| values[index::INERTIA] * rounding * bend / (force * level));
        [1.0 + DOUBT * spring * spring, 1.0 + SHAKEN * inertia * inertia]
    }

    /// Whether what `stand` leaves of force and of effort may be the encoder's.
    #[must_use]
    pub fn doubtful(&self, stand: &Stand) -> [bool; 2] {
        let (doubts, ratios) = (self.doubts(&stand.values), stand.power_ratios());
        [0, 1].map(|channel| doubts[channel] > DOUBTFUL && ratios[channel] < doubts[channel])
    }

    /// Power over the floor's in the channel in which it is greater, of those that can be trusted.
    #[must_use]
    pub fn trusted_ratio(&self, stand: &Stand) -> f64 {
        let (doubtful, ratios) = (self.doubtful(stand), stand.power_ratios());
        (0..2).filter(|channel| !doubtful[*channel]).map(|channel| ratios[channel]).fold(0.0, f64::max)
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
        let fits =
            starts.par_iter().map(|start| fit::fit(&data, &self.nominal, start, &self.scene(&self.nominal, start)));
        let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy));
        best.map_or_else(|| self.given.clone(), |fit| fit.values)
    }

    /// Positions at which the contact may begin: spread over those that were reached.
    fn surfaces(&self) -> Vec<f64> {
        let mut reached: Vec<f64> =
            self.studio.trials.iter().flat_map(|trial| trial.contact.position.iter().copied()).collect();
        reached.sort_unstable_by(f64::total_cmp);
        let last = reached.len().saturating_sub(1);
        [0.02, 0.2, 0.4, 0.6, 0.8].iter().map(|part| reached[(part * last as f64) as usize]).collect()
    }

    fn even_floors(&self) -> Whitener {
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

    /// Stands on `model`: fits it under floors told by twins, and asks the recording and `count` twins the same questions.
    ///
    /// A better model does not make the sensors worse: no moment's floor rises far above what it was `before`.
    #[must_use]
    pub fn stand(&self, model: &Model, start: &[f64], count: usize, before: Option<&Whitener>) -> Stand {
        let (mut values, mut whitener, mut noise) = (start.to_vec(), None, Vec::new());
        let (mut origin, mut quiet) = (values.clone(), f64::INFINITY);
        // The floor depends on the values and they on the floor, weakly: twice is enough, and once more where values that
        // next to nothing tells apart were led astray.
        for pass in 0..3 {
            let truth = self.studio.truth(model, &origin);
            noise = self.studio.noise(model, &values, &truth);
            let twins: Vec<Vec<Trial>> = (0..FOR_FLOOR as u64)
                .into_par_iter()
                .map(|number| self.studio.twin(&truth, &noise, 1000 + number))
                .collect();
            let samples: Vec<Vec<Rest>> = twins.par_iter().map(|twin| self.rests(model, &values, twin)).collect();
            if pass == 1 && loudness(&samples) > LOUD * quiet {
                origin.clone_from(&values);
                continue;
            }
            quiet = loudness(&samples);
            let floors =
                before.map_or_else(|| self.floors(model, &samples), |b| self.floors(model, &samples).no_worse_than(b));
            let own = floors.learnt(&self.rests(model, &values, &self.studio.trials));
            values = self.fit(model, &values, &own).values;
            if pass == 0 {
                self.unbias(model, &values, &floors, &twins, &mut origin);
            }
            whitener = Some(floors);
            if pass == 1 {
                break;
            }
        }
        let floors = whitener.unwrap_or_else(|| self.even_floors());
        let whitener = floors.learnt(&self.rests(model, &values, &self.studio.trials));
        let scene = self.scene(model, &values);
        let truth = self.studio.truth(model, &origin);
        let own_view = view(&self.studio.trials, &whitener, model, &values, &scene, &|_| true);
        let promising: Vec<Term> = own_view.promising().map(|score| score.term).collect();
        let asked = |term: &Term| promising.iter().any(|other| other.is(term));
        let twins = (0..count as u64)
            .into_par_iter()
            .map(|number| {
                let twin = self.studio.twin(&truth, &noise, number);
                let own = floors.learnt(&self.rests(model, &values, &twin));
                view(&twin, &own, model, &values, &scene, &asked)
            })
            .collect();
        Stand { model: model.clone(), values, origin, scene, whitener, noise, view: own_view, twins }
    }

    /// Moves `origin`, which `twins` were made from, by what their fits miss `values` in the mean.
    ///
    /// A fit to noisy motion is biased: noise in the acceleration weakens the mass. So are the fits to twins, and those of
    /// twins that are made from what the bias hides come out as the recording does (indirect inference: C. Gourieroux,
    /// A. Monfort, E. Renault, J. Appl. Econom. 8 (1993) S85).
    fn unbias(&self, model: &Model, values: &[f64], floors: &Whitener, twins: &[Vec<Trial>], origin: &mut [f64]) {
        let scene = self.scene(model, values);
        let shifts: Vec<Vec<f64>> = twins
            .par_iter()
            .map(|twin| {
                let whitener = floors.learnt(&self.rests(model, values, twin));
                let data = Data { trials: twin, whitener: &whitener, rows: None };
                Remainder::of(data, model, values, &scene).shift
            })
            .collect();
        for ((at, origin), axis) in origin.iter_mut().enumerate().zip(fit::axes(model, values, &scene)) {
            let mean = shifts.iter().map(|shift| shift[at]).sum::<f64>() / shifts.len().max(1) as f64;
            let most = FAR * axis.scale;
            *origin = (*origin - mean.max(-most).min(most)).clamp(axis.low, axis.high);
        }
    }

    /// The best values of `model`, which is that of `stand` and one more effect that starts at `own`.
    ///
    /// Where much is missing, the nominal values were bent to make up for it, the surface above all: the search then starts
    /// from other surfaces as well.
    #[must_use]
    pub fn search_fit(&self, data: &Data<'_>, stand: &Stand, model: &Model, own: &[f64]) -> Fit {
        let from = |values: &[f64]| {
            let start: Vec<f64> = values.iter().chain(own).copied().collect();
            fit::fit(data, model, &start, &stand.scene)
        };
        let mut best = from(&stand.values);
        if self.nominal.contact == Some(false) && stand.power_ratio() > MUCH {
            for surface in self.surfaces() {
                let mut values = stand.values.clone();
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

    /// The best values of `model` under `whitener`.
    #[must_use]
    pub fn fit(&self, model: &Model, start: &[f64], whitener: &Whitener) -> Fit {
        let data = Data { trials: &self.studio.trials, whitener, rows: None };
        fit::fit(&data, model, start, &self.scene(model, start))
    }

    /// Residuals of a twin of `stand`.
    #[must_use]
    pub fn twin_rests(&self, stand: &Stand) -> Vec<Rest> {
        let truth = self.studio.truth(&stand.model, &stand.origin);
        self.rests(&stand.model, &stand.values, &self.studio.twin(&truth, &stand.noise, 0))
    }

    fn rests(&self, model: &Model, values: &[f64], trials: &[Trial]) -> Vec<Rest> {
        trials.iter().map(|trial| model.rest(values, trial, Channels::BOTH)).collect()
    }

    fn floors(&self, model: &Model, samples: &[Vec<Rest>]) -> Whitener {
        let of = |effort: bool, pick: &dyn Fn(&Rest) -> Vec<f64>| {
            let values: Vec<Vec<Vec<f64>>> = samples.iter().map(|rests| rests.iter().map(pick).collect()).collect();
            Floor::of(&tracks(&self.studio.trials, effort), &values)
        };
        Whitener {
            force: model.contact.map(|_| of(false, &|rest| rest.force.clone())),
            effort: model.drive.then(|| of(true, &|rest| rest.effort.clone())),
        }
    }
}

/// Energy of all that twins leave, of both channels.
fn loudness(samples: &[Vec<Rest>]) -> f64 {
    samples.iter().flatten().map(|rest| fit::energy(&rest.force) + fit::energy(&rest.effort)).sum()
}
