//! Which effects the recordings ask for: sets grown from the best few, exchanged and pruned.

use rayon::prelude::*;

use super::circumstances::Circumstances;
use super::criteria::LEAST_GAIN;
use super::fit::{Data, Effort, Fit, Rest};
use super::model::{ContactModel, Fall, index};
use super::own_values::{fewer_own_values, moved_values, own_values};
use super::projection::{Projection, Promise};
use super::tones::is_in_step;
use super::worth::{are_told_apart, free};
use crate::diagnose::term::Term;

/// What a search works on.
pub struct Search<'a> {
    /// The trials, each row with its worth.
    pub data: Data<'a>,
    /// The same in means of several rows, which effects are looked for in.
    pub coarse: Data<'a>,
    /// The nominal law, refitted.
    pub nominal: Fit,
    /// What bounds it beside the recordings.
    pub circumstances: Circumstances,
}

/// What was chosen, and the sets that it was chosen from.
pub struct Chosen {
    /// The law with its effects.
    pub fit: Fit,
    /// Every set that was fitted in full.
    pub sets: Vec<Fit>,
}

/// Sets that each round grows from.
const BEAM: usize = 4;

/// Promises of a round that are fitted.
const TRIED: usize = 14;

/// Of these, how many are fitted to the end.
const COARSELY_POLISHED: usize = 10;

/// And of these, on every row.
const POLISHED: usize = 5;

/// Effects at most.
pub(super) const MOST_TERMS: usize = 4;

/// Sets that are looked at for one whose effects stand beside one another.
const MOST_SURVIVORS: usize = 8;

/// Part of the recordings' own stiffness that a memory starts beside at the least: beside no spring it would start as none.
const LEAST_STIFFNESS: f64 = 0.1;

/// Other surfaces that a law's search starts from where much is missing, of the depth.
const SURFACES: [f64; 3] = [-0.3, 0.15, 0.4];

/// Squares a row, over the sensors' own, from which much is missing.
pub(super) const FAR_ENERGY: f64 = 4.0;

impl Search<'_> {
    /// Whether `fit` is a law that its effects stand for: no value at the end of what the recordings show, none by which an effect is not
    /// what it is called, no wave that has slid into step with the motion, and no spring whose force falls on the way in, unless the rig
    /// file has one or it is a pocket of an effect that may have one.
    pub(super) fn is_admissible(&self, fit: &Fit) -> bool {
        let falls = |fit: &Fit| match fit.model.fall(&fit.values) {
            Some(Fall::Pocket) => !fit.model.may_fall(),
            Some(Fall::ToTheEnd) => true,
            None => false,
        };
        let mut frequencies = fit.model.frequencies(&fit.values).into_iter();
        !fit.model.is_at_end(&fit.values)
            && fit.model.is_as_stated(&fit.values)
            && !frequencies.any(|frequency| is_in_step(&self.coarse, frequency))
            && (!falls(fit) || falls(&self.nominal))
    }

    /// Whether the recordings cannot distinguish the laws of two sets of effects, whatever they leave: at one speed each way and
    /// without a hold a Maxwell branch, `branch_stiffness v relaxation_time (1 - exp(-t / relaxation_time))` after a reversal, is Dahl's
    /// loop over `v t`, and a force that is late by a time is that of a tip that lags by a way.
    #[must_use]
    pub fn is_one_law(&self, one: &ContactModel, other: &ContactModel) -> bool {
        let kinds = |model: &ContactModel| {
            let mut names: Vec<&str> =
                sorted_names(model).into_iter().map(|name| by_travel(name).unwrap_or(name)).collect();
            names.sort_unstable();
            names.dedup();
            names
        };
        self.circumstances.is_one_speed && kinds(one) == kinds(other)
    }

    /// Runs the search, telling `say` how it goes.
    #[must_use]
    pub fn run(&mut self, say: &dyn Fn(&str)) -> Chosen {
        let mut best = self.nominal.clone();
        let mut beam = vec![best.clone()];
        let mut sets: Vec<Fit> = Vec::new();
        let mut composed = Vec::new();
        let mut waiting = 0;
        for round in 0..MOST_TERMS + 1 {
            say(&format!("the contact: {round} effects and one more"));
            let mut grown = if round == 0 { self.seen_layers() } else { Vec::new() };
            for base in &beam {
                let quick = self.grown(base);
                grown.extend(self.polished(quick));
            }
            grown.retain(|fit| self.is_admissible(fit));
            grown.sort_by(|a, b| a.energy.total_cmp(&b.energy));
            // At one speed a memory is a loop: what it multiplies cannot be told.
            let heads = if self.circumstances.is_one_speed { 0 } else { BEAM.min(grown.len()) };
            let anew = self.composed(&grown[..heads], &mut composed);
            grown.extend(anew.into_iter().filter(|fit| self.is_admissible(fit)));
            grown.sort_by(|a, b| a.energy.total_cmp(&b.energy));
            let Some(least) = grown.first() else { break };
            let rest = Rest::of(&self.data, least);
            grown.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
            let grown = distinct(grown);
            sets.extend(grown.iter().cloned());
            let top = grown.iter().find(|fit| self.is_worth(fit, &best));
            match top {
                Some(top) => {
                    best = self.weigh_by(top.clone());
                    waiting = 0;
                }
                // Two effects can be worth it where neither is alone.
                None => waiting += 1,
            }
            let is_at_noise = self.data.noise_is_as_stated && best.energy < 1.02 * self.data.expected();
            if waiting > 1 || is_at_noise {
                break;
            }
            let grown = grown.iter().filter(|fit| fit.model.terms.len() <= MOST_TERMS).take(BEAM);
            beam = grown.map(|fit| if waiting == 0 { self.data.again(fit) } else { fit.clone() }).collect();
            if waiting == 0 && beam.iter().all(|fit| fit.model != best.model) {
                beam.truncate(BEAM - 1);
                beam.push(best.clone());
            }
        }
        say("the contact: without each effect");
        let fit = self.pruned(best);
        let fit = self.exchanged(fit, say);
        let fit = self.weigh_by(fit);
        let fit = self.pruned(fit);
        sets.par_iter_mut().for_each(|fit| *fit = self.data.again(fit));
        let fit = self.surviving(fit, &sets);
        let fit = self.simplest(fit, &sets);
        let fit = self.without_times(fit, &sets);
        let simple = fit.model.clone();
        let fit = self.refined(fit, say);
        if fit.model != simple {
            // Its weights are those of a finer law: what was found before is compared under the same.
            sets.par_iter_mut().for_each(|fit| *fit = self.data.again(fit));
        }
        let fit = self.with_lines(fit, &mut sets);
        Chosen { fit, sets }
    }

    /// Takes each row for what `best` makes of the motion's uncertainty, and for what it leaves: an inertia shows errors of the
    /// acceleration, a stiffer law more of the position's, and the better a law the more its finest rows are worth. Returns `best` under
    /// these weights.
    pub(super) fn weigh_by(&mut self, best: Fit) -> Fit {
        self.data = self.data.weighed(&best);
        self.coarse = self.coarse.weighed(&best);
        self.nominal = self.data.again(&self.nominal);
        self.data.again(&best)
    }

    /// `base` with each promising effect, and with what each trial may have for itself, the best first.
    pub(super) fn grown(&self, base: &Fit) -> Vec<Fit> {
        let data = &self.coarse;
        let model = &base.model;
        let promises = self.promises(base, &|_| true);
        let mut tried: Vec<Fit> =
            promises.par_iter().take(TRIED).map(|(promise, base)| self.with_effect(promise, base)).collect();
        tried.par_extend(own_values(model).into_par_iter().map(|own| {
            let model = ContactModel { own, ..model.clone() };
            let start = moved_values(base, &model);
            data.fit(&model, &start, Effort::QUICK)
        }));
        tried.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        tried
    }

    /// What each effect that is `asked` for promises beside `base`, the best first: from where `base` stands, and where much is missing
    /// from other surfaces, because what is missing bends the nominal values, and what a motion can show depends on where the contact
    /// begins.
    pub(super) fn promises(&self, base: &Fit, asked: &(dyn Fn(&Term) -> bool + Sync)) -> Vec<(Promise, Fit)> {
        let asked = |term: &Term| asked(term) && !self.circumstances.refuted.contains(&term.name());
        let mut bases = vec![base.clone()];
        if !base.model.bilateral && base.energy > FAR_ENERGY * self.coarse.expected() {
            let moved = SURFACES.par_iter().map(|part| {
                let mut values = base.values.clone();
                values[index::SURFACE] += part * base.model.scales.depth;
                self.coarse.fit_holding(&base.model, &values, Effort::QUICK, &|at| at == index::SURFACE)
            });
            bases.par_extend(moved);
        }
        let mut best: Vec<(Promise, Fit)> = Vec::new();
        for fit in bases {
            let lost = fit.energy - base.energy;
            let [stiffness, surface] = [index::STIFFNESS, index::SURFACE].map(|at| fit.values[at]);
            let model = &fit.model;
            let excitation = model.scales.excitation(self.coarse.trials, stiffness, surface, model.bilateral);
            for mut promise in Projection::of(&self.coarse, &fit).promises(&excitation, &asked) {
                promise.gain -= lost;
                match best.iter_mut().find(|(other, _)| other.term.is(&promise.term)) {
                    Some((other, _)) if other.gain >= promise.gain => {}
                    Some(other) => *other = (promise, fit.clone()),
                    None => best.push((promise, fit.clone())),
                }
            }
        }
        best.sort_by(|(a, _), (b, _)| b.gain.total_cmp(&a.gain));
        best
    }

    /// `base` with an effect.
    pub(super) fn with_effect(&self, promise: &Promise, base: &Fit) -> Fit {
        let model = base.model.with(promise.term);
        let start: Vec<f64> = base.values.iter().chain(&promise.values).copied().collect();
        self.coarse.fit(&model, &start, Effort::QUICK)
    }

    /// The best of `quick`, one of each set of names, to the end. They are compared at the price of their values: of several forms that do
    /// as well the one with the fewest is polished, and leaves room for other effects.
    pub(super) fn polished(&self, quick: Vec<Fit>) -> Vec<Fit> {
        self.to_the_end(distinct(self.coarsely_polished(quick)))
    }

    /// The best of `quick` fitted to the end on the means of rows, the best first at the price of their values.
    pub(super) fn coarsely_polished(&self, mut quick: Vec<Fit>) -> Vec<Fit> {
        let Some(least) = quick.iter().min_by(|a, b| a.energy.total_cmp(&b.energy)) else { return Vec::new() };
        let rest = Rest::of(&self.coarse, least);
        quick.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        let mut fits: Vec<Fit> = quick.into_iter().take(COARSELY_POLISHED).collect();
        fits.par_iter_mut().for_each(|fit| *fit = self.coarse.fit(&fit.model, &fit.values, Effort::FULL));
        fits.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        fits
    }

    /// The first of `fits` on every row.
    pub(super) fn to_the_end(&self, mut fits: Vec<Fit>) -> Vec<Fit> {
        fits.truncate(POLISHED);
        fits.par_iter().map(|fit| self.data.fit(&fit.model, &fit.values, Effort::FULL)).collect()
    }

    /// `best` without the effects that are not worth having beside the others.
    #[must_use]
    pub fn pruned(&self, mut best: Fit) -> Fit {
        'again: loop {
            for at in (self.nominal.model.terms.len()..best.model.terms.len()).rev() {
                let less = self.without(&best, at);
                if !self.is_worth(&best, &less) {
                    best = less;
                    continue 'again;
                }
            }
            for own in fewer_own_values(&best.model) {
                let model = ContactModel { own, ..best.model.clone() };
                let less = self.data.fit(&model, &moved_values(&best, &model), Effort::FULL);
                if !self.is_worth(&best, &less) {
                    best = less;
                    continue 'again;
                }
            }
            return best;
        }
    }

    /// `best` with each effect exchanged for another that does better in its place.
    fn exchanged(&self, mut best: Fit, say: &dyn Fn(&str)) -> Fit {
        say("the contact: another effect in the place of each");
        let first = self.nominal.model.terms.len();
        for _ in 0..2 {
            let rest = Rest::of(&self.data, &best);
            let own = self.price(&best, &rest);
            let mut better: Option<Fit> = None;
            for at in first..best.model.terms.len() {
                let less = self.without(&best, at);
                for fit in self.polished(self.grown(&less)) {
                    let is_open = self.is_admissible(&fit) && fit.model.terms.len() <= best.model.terms.len();
                    let price = self.price(&fit, &rest);
                    if is_open
                        && price < own - LEAST_GAIN
                        && better.as_ref().is_none_or(|b| price < self.price(b, &rest))
                    {
                        better = Some(fit);
                    }
                }
            }
            let Some(fit) = better else { break };
            best = self.pruned(fit);
        }
        best
    }

    /// `fit`; where leaving out one effect after the other left none of it, the likeliest of `sets` whose effects stand beside one another.
    fn surviving(&self, fit: Fit, sets: &[Fit]) -> Fit {
        let least = sets.iter().min_by(|a, b| a.energy.total_cmp(&b.energy));
        let Some(least) = least.filter(|_| fit.model == self.nominal.model) else { return fit };
        let rest = Rest::of(&self.data, least);
        let mut worthy: Vec<&Fit> = sets.iter().filter(|set| self.is_worth(set, &self.nominal)).collect();
        worthy.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        let stands = |set: &Fit| {
            let pruned = self.pruned(set.clone());
            (pruned.model.terms.len() > self.nominal.model.terms.len()).then_some(pruned)
        };
        worthy.into_iter().take(MOST_SURVIVORS).find_map(stands).unwrap_or(fit)
    }

    /// The simplest of `sets` that the recordings do not tell from `best`, nor what is left of it without the effects that are not worth having
    /// there; `best` where there is none.
    fn simplest(&self, best: Fit, sets: &[Fit]) -> Fit {
        let is_as_good = |other: &Fit| {
            let more = free(&best).saturating_sub(free(other));
            let worth = self.worth(&best, other);
            more > 0
                && !other.model.terms.is_empty()
                && (worth.gain < LEAST_GAIN + worth.price * more as f64 || !are_told_apart(&worth))
                && self.is_worth(other, &self.nominal)
        };
        let mut simpler: Vec<&Fit> = sets.iter().filter(|other| is_as_good(other)).collect();
        simpler.sort_by(|a, b| free(a).cmp(&free(b)).then(a.energy.total_cmp(&b.energy)));
        let mut pruned = simpler.into_iter().take(MOST_SURVIVORS).map(|simpler| self.pruned(simpler.clone()));
        pruned.find(is_as_good).unwrap_or(best)
    }

    /// `fit`; where the recordings show one speed, the likeliest of `sets` that is the same law there, by ways and not by times, if they do
    /// not tell it from `fit`: a way was seen, and a time was not.
    fn without_times(&self, fit: Fit, sets: &[Fit]) -> Fit {
        let has_times = |fit: &Fit| sorted_names(&fit.model).into_iter().any(|name| by_travel(name).is_some());
        if !has_times(&fit) {
            return fit;
        }
        let same = sets.iter().filter(|other| !has_times(other) && self.is_one_law(&other.model, &fit.model));
        let least = same.min_by(|a, b| a.energy.total_cmp(&b.energy));
        match least.filter(|other| !are_told_apart(&self.worth(&fit, other))) {
            Some(other) => self.pruned(other.clone()),
            None => fit,
        }
    }

    /// `fit` without term `at`, refitted.
    #[must_use]
    pub fn without(&self, fit: &Fit, at: usize) -> Fit {
        let (model, values) = without_term(fit, at);
        if model == self.nominal.model {
            return self.nominal.clone();
        }
        self.data.fit(&model, &values, Effort::FULL)
    }
}

/// Model and values of `fit` without term `at`. What built on it alone becomes its simpler form.
#[must_use]
pub fn without_term(fit: &Fit, at: usize) -> (ContactModel, Vec<f64>) {
    let start = fit.model.first_value_of(at);
    let mut values = fit.values.clone();
    values.drain(start..start + fit.model.count_of(&fit.model.terms[at]));
    let mut model = fit.model.clone();
    model.terms.remove(at);
    let stiffness = values[index::STIFFNESS].max(LEAST_STIFFNESS * model.scales.stiffness());
    for nth in 0..model.terms.len() {
        let Term { effect, form } = model.terms[nth];
        let needed = effect.builds_on(form);
        if needed.is_empty() || needed.iter().any(|name| model.times(name) > 0) {
            continue;
        }
        let start = model.first_value_of(nth);
        let own = start..start + model.count_of(&model.terms[nth]);
        if let Some((form, simpler)) = effect.simpler(form, &values[own.clone()], stiffness) {
            model.terms[nth].form = form;
            values[own].copy_from_slice(&simpler);
        }
    }
    (model, values)
}

/// The law by a way that one by a time, `name`, is at one speed; `None` where it is none.
fn by_travel(name: &str) -> Option<&'static str> {
    match name {
        "stress_relaxation" => Some("hysteresis"),
        "channel_delay" | "force_lag" => Some("lost_motion"),
        _ => None,
    }
}

/// The first of each set of names.
fn distinct(fits: Vec<Fit>) -> Vec<Fit> {
    let mut kept: Vec<Fit> = Vec::new();
    for fit in fits {
        let own = sorted_names(&fit.model);
        if kept.iter().all(|other| sorted_names(&other.model) != own || other.model.own != fit.model.own) {
            kept.push(fit);
        }
    }
    kept
}

/// Names of all effects, as often as each is there.
pub(super) fn sorted_names(model: &ContactModel) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = model.terms.iter().map(crate::diagnose::term::Term::name).collect();
    names.sort_unstable();
    names
}
