//! A fitted model with its twins, and what they say of the noise.

use rayon::prelude::*;

use super::problem::Study;
use super::sampler::Noise;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data, Fit};
use crate::diagnose::estimation::projection::Remainder;
use crate::diagnose::estimation::residual_summary::{View, view};
use crate::diagnose::estimation::whitener::{Floor, Whitener, tracks};
use crate::diagnose::linalg::energy;
use crate::diagnose::model::{Channels, Model, Rest, Term, index};
use crate::diagnose::signals::filtered_trial::Trial;
use crate::effects::Scene;

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

/// A first look at twins, for the floor.
struct Glimpse {
    noise: Vec<Noise>,
    twins: Vec<Vec<Trial>>,
    rests: Vec<Vec<Rest>>,
}

/// Share of its scale by which a value may be biased.
const FAR: f64 = 0.5;

/// Growth of what twins leave beyond which their origin is astray.
const LOUD: f64 = 2.0;

/// Times that twins follow values that go on.
const PURSUED: usize = 2;

/// Twins that tell the floor.
const FOR_FLOOR: usize = 24;

/// Power over the noise's from which much is missing.
const MUCH: f64 = 30.0;

/// Doubt from which a residual within it is not looked into.
const DOUBTFUL: f64 = 1.2;

/// Part of a rounding's power that is taken for possible.
const DOUBT: f64 = 1.4;

/// The same of a rounding's power in the balance of the drive.
const SHAKEN: f64 = 0.02;

/// `moved`, no further from the fitted value than a bias is believed: one of more than half an effect's value is not told from twins,
/// and the effect is not turned off by it.
#[must_use]
pub fn near(model: &Model, values: &[f64], at: usize, moved: f64) -> f64 {
    let part = if at < model.nominals() { f64::INFINITY } else { FAR * values[at].abs() };
    moved.max(values[at] - part).min(values[at] + part)
}

impl Study {
    /// Stands on `model`: fits it under floors told by twins, and asks the recording and `count` twins the same questions.
    ///
    /// A better model does not make the sensors worse: no moment's floor rises far above what it was `before`.
    #[must_use]
    pub fn stand(&self, model: &Model, start: &[f64], count: usize, before: Option<&Whitener>) -> Stand {
        let first = self.glimpse(model, start, start);
        let floors = self.floors_of(model, &first, before);
        let fitted = self.fit_under(model, start, &floors);
        let mut origin = self.unbiased(model, &fitted, start, &floors, &first.twins);
        let mut second = self.glimpse(model, &fitted, &origin);
        if loudness(&second.rests) > LOUD * loudness(&first.rests) {
            // Values that next to nothing tells apart were led astray.
            origin.clone_from(&fitted);
            second = self.glimpse(model, &fitted, &origin);
        }
        let mut floors = self.floors_of(model, &second, before);
        let mut values = self.fit_under(model, &fitted, &floors);
        // The floor depends on the values and they on the floor, weakly: twice is enough. Where much is missing they may yet have
        // gone on, and twins of where they were would show that way as the sensors' noise.
        for _ in 0..PURSUED {
            if !self.has_left(model, &values, &second, &floors) {
                break;
            }
            origin.clone_from(&values);
            second = self.glimpse(model, &values, &origin);
            floors = self.floors_of(model, &second, before);
            values = self.fit_under(model, &values, &floors);
        }
        let noise = second.noise;
        let whitener = floors.learnt(&self.rests(model, &values, &self.studio.trials));
        let scene = self.scene(model, &values);
        let truth = self.studio.truth(model, &origin);
        let own_view = view(&self.studio.trials, &whitener, model, &values, &scene, &|term| !term.refines());
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

    /// Whether `values` leave far more of the twins than those do that the twins were seen by, in a channel.
    fn has_left(&self, model: &Model, values: &[f64], glimpse: &Glimpse, floors: &Whitener) -> bool {
        let plain = floors.forgetful();
        let power = |rests: &[Vec<Rest>]| {
            let powers = rests.iter().map(|rests| plain.powers(&plain.white(rests)));
            powers.fold([0.0; 2], |sum, powers| [0, 1].map(|channel| sum[channel] + powers[channel]))
        };
        let rests: Vec<Vec<Rest>> = glimpse.twins.par_iter().map(|twin| self.rests(model, values, twin)).collect();
        let (now, then) = (power(&rests), power(&glimpse.rests));
        (0..2).any(|channel| now[channel] > LOUD * then[channel])
    }

    /// Twins made from `origin`, and what `values` leave of them.
    fn glimpse(&self, model: &Model, values: &[f64], origin: &[f64]) -> Glimpse {
        let truth = self.studio.truth(model, origin);
        let noise = self.studio.noise(model, values, &truth);
        let numbers = (0..FOR_FLOOR as u64).into_par_iter();
        let twins: Vec<Vec<Trial>> = numbers.map(|number| self.studio.twin(&truth, &noise, 1000 + number)).collect();
        let rests = twins.par_iter().map(|twin| self.rests(model, values, twin)).collect();
        Glimpse { noise, twins, rests }
    }

    fn floors_of(&self, model: &Model, glimpse: &Glimpse, before: Option<&Whitener>) -> Whitener {
        let floors = self.floors(model, &glimpse.rests);
        match before {
            Some(before) => floors.no_worse_than(before),
            None => floors,
        }
    }

    fn fit_under(&self, model: &Model, start: &[f64], floors: &Whitener) -> Vec<f64> {
        let own = floors.learnt(&self.rests(model, start, &self.studio.trials));
        self.fit(model, start, &own).values
    }

    /// `origin`, which `twins` were made from, moved by what their fits miss `values` in the mean; `values` of a drive that was
    /// cut, for its twins keep the recorded commands.
    ///
    /// A fit to noisy motion is biased: noise in the acceleration weakens the mass. So are the fits to twins, and those of
    /// twins that are made from what the bias hides come out as the recording does (indirect inference: C. Gourieroux,
    /// A. Monfort, E. Renault, J. Appl. Econom. 8 (1993) S85).
    fn unbiased(
        &self,
        model: &Model,
        values: &[f64],
        origin: &[f64],
        floors: &Whitener,
        twins: &[Vec<Trial>],
    ) -> Vec<f64> {
        if model.effort_limit(values, 0).is_some() {
            return values.to_vec();
        }
        let scene = self.scene(model, values);
        let shifts: Vec<Vec<f64>> = twins
            .par_iter()
            .map(|twin| {
                let whitener = floors.learnt(&self.rests(model, values, twin));
                let data = Data { trials: twin, whitener: &whitener, rows: None };
                Remainder::of(data, model, values, &scene).shift
            })
            .collect();
        let axes = levenberg_marquardt::axes(model, values, &scene);
        let moved = origin.iter().zip(axes).enumerate().map(|(at, (origin, axis))| {
            let mean = shifts.iter().map(|shift| shift[at]).sum::<f64>() / shifts.len().max(1) as f64;
            let most = FAR * axis.scale;
            let moved = (origin - mean.max(-most).min(most)).clamp(axis.low, axis.high);
            near(model, values, at, moved)
        });
        moved.collect()
    }

    /// The best values of `model`, which is that of `stand` and one more effect that starts at `own`.
    ///
    /// Where much is missing, the nominal values were bent to make up for it, the surface above all: the search then starts
    /// from other surfaces as well.
    #[must_use]
    pub fn search_fit(&self, data: &Data<'_>, stand: &Stand, model: &Model, own: &[f64]) -> Fit {
        let from = |values: &[f64]| {
            let start: Vec<f64> = values.iter().chain(own).copied().collect();
            levenberg_marquardt::fit(data, model, &start, &stand.scene)
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
    samples.iter().flatten().map(|rest| energy(&rest.force) + energy(&rest.effort)).sum()
}
