//! A set of effects with one more: each that promises to be worth it, fitted.

use rayon::prelude::*;

use super::criteria::{LEAST_GAIN, MUCH_MISSING};
use super::fit::{Effort, Fit};
use super::model::{ContactModel, index};
use super::own_values::{moved_values, own_values};
use super::projection::{Projection, Promise};
use super::rest::Rest;
use super::search::{Search, sorted_names};
use super::worth::free;
use crate::diagnose::term::Term;

/// Promises of a round that are fitted.
const TRIED: usize = 14;

/// Of these, how many are fitted to the end.
const COARSELY_POLISHED: usize = 10;

/// And of these, on every row.
const POLISHED: usize = 5;

/// Other surfaces that a law's search starts from where much is missing, of the depth.
const SURFACES: [f64; 3] = [-0.3, 0.15, 0.4];

impl Search<'_> {
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
        let asked = |term: &Term| asked(term) && self.circumstances.allow(term.name());
        // Squares of means are compared with squares of means: `base` may have been fitted on every row.
        let base = &self.coarse.fit_holding(&base.model, &base.values, Effort::NONE, &|_| true);
        let mut bases = vec![base.clone()];
        if !base.model.bilateral && base.energy > MUCH_MISSING * self.coarse.expected() {
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

    /// `fit` with the effect of term `at` by another of its laws, the one that every row makes likeliest, where that is likelier than its own: means of rows, which
    /// a law is chosen by, may tell two laws of one effect apart the other way about.
    pub(super) fn in_another_form(&self, fit: &Fit, at: usize) -> Option<Fit> {
        self.best_form(fit, at, &|gain, _, _| gain > LEAST_GAIN.value())
    }

    /// `fit` with the effect of term `at` by the cheapest of its other laws, each fitted to the end on every row, that `is_enough`: by what it gains over `fit`, nats at the
    /// price of all values, by itself, and by the rest of `fit` without the effect.
    fn best_form(&self, fit: &Fit, at: usize, is_enough: &dyn Fn(f64, &Fit, &Fit) -> bool) -> Option<Fit> {
        let own = fit.model.terms[at];
        let less = self.without(fit, at);
        let promises = self.promises(&less, &|term| term.name() == own.name() && !term.is(&own));
        let quick = promises.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        let full = self.to_the_end(self.coarsely_polished(quick));
        let rest = Rest::of(&self.data, fit);
        let gain = |other: &Fit| self.price(fit, &rest) - self.price(other, &rest);
        let good = full.into_iter().filter(|other| self.is_admissible(other) && is_enough(gain(other), other, &less));
        good.max_by(|a, b| gain(a).total_cmp(&gain(b)))
    }

    /// `fit` with each of its effects by the law of it that every row makes likeliest beside the others. A law with more values stands only where it gains over
    /// one with fewer what values have to gain anywhere: in quick fits a law that is linear in its values is at its end where others are not.
    pub(super) fn in_likeliest_forms(&self, mut fit: Fit) -> Fit {
        for at in self.nominal.model.terms.len()..fit.model.terms.len() {
            if let Some(other) = self.in_likeliest_form(&fit, at) {
                fit = with_last_at(other, at);
            }
        }
        fit
    }

    /// The same for term `at` alone; `None` where its own law stands. An effect that is worth having by its own law alone keeps it.
    fn in_likeliest_form(&self, fit: &Fit, at: usize) -> Option<Fit> {
        self.best_form(fit, at, &|gain, other, less| {
            let is_simpler = free(other) < free(fit) && self.is_worth(other, less);
            gain > if is_simpler { -LEAST_GAIN.value() } else { LEAST_GAIN.value() }
        })
    }

    /// The best of `quick`, one of each set of names, to the end. They are compared at the price of their values: of several forms that do
    /// as well the one with the fewest is polished, and leaves room for other effects. Where the best is worth it beside `less`, those that are no
    /// answer beside it are none.
    pub(super) fn polished(&self, quick: Vec<Fit>, less: &Fit) -> Vec<Fit> {
        let mut fits = distinct(self.coarsely_polished(quick));
        fits.truncate(POLISHED);
        if fits.is_empty() {
            return fits;
        }
        let first = fits.remove(0);
        let mut full = self.to_the_end(vec![first.clone()]);
        if self.is_admissible(&full[0]) && self.is_worth(&full[0], less) {
            fits.retain(|fit| !self.is_no_answer(&self.coarse, fit, &first));
        }
        full.extend(self.to_the_end(fits));
        full
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
}

/// `fit` with its last term in the place of term `at`, which with all behind it goes one further: of effects that a curve could replace the first one goes, whichever law it has.
fn with_last_at(mut fit: Fit, at: usize) -> Fit {
    let [place, last] = [at, fit.model.terms.len() - 1].map(|term| fit.model.first_value_of(term));
    let count = fit.values.len() - last;
    fit.values[place..].rotate_right(count);
    fit.model.terms[at..].rotate_right(1);
    fit
}

/// The first of each set of names.
pub(super) fn distinct(fits: Vec<Fit>) -> Vec<Fit> {
    let mut kept: Vec<Fit> = Vec::new();
    for fit in fits {
        let own = sorted_names(&fit.model);
        if kept.iter().all(|other| sorted_names(&other.model) != own || other.model.own != fit.model.own) {
            kept.push(fit);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// A weight of 1 N that the tool bears everywhere moves the nominal surface by three millimetres. Whether another surface promises more is
    /// a comparison on the same rows: it does not change with the rows that the base was fitted on, here eight times as many.
    #[test]
    fn what_effects_promise_does_not_depend_on_how_many_rows_the_base_was_fitted_on() {
        let recording = TestContact { zero: 1.0, ..TestContact::PLAIN }.recording(1);
        let [fine, means] = [1, 8].map(|every| vec![TestContact::seen_in_means(&recording, every)]);
        let nominal = nominal_fit(&Data::new(&fine), &TestContact::nominal());
        let base = Data::new(&fine).again(&nominal);
        let search = Search {
            nominal: base.clone(),
            data: Data::new(&fine),
            coarse: Data::new(&means),
            circumstances: Circumstances::default(),
        };
        let on_means = search.coarse.fit_holding(&base.model, &base.values, Effort::NONE, &|_| true);
        let [promised, expected] = [&base, &on_means].map(|base| search.promises(base, &|_| true));
        // Of 3000 rows noise leaves 3000 squares, of 375 means 375.
        assert!(base.energy > on_means.energy + 2000.0, "{} {}", base.energy, on_means.energy);
        assert_eq!(promised.len(), expected.len());
        for ((one, from), (other, expected_from)) in promised.iter().zip(&expected) {
            assert_eq!((one.term, &from.values), (other.term, &expected_from.values));
            assert!((one.gain - other.gain).abs() <= 1e-9 * other.gain.abs(), "{one:?} {other:?}");
        }
    }

    /// A branch that relaxes is all there is: what takes a little of it is no answer and is not fitted on every row. Beside it nothing is worth its
    /// values, and each of the best is.
    #[test]
    fn what_is_no_answer_beside_a_law_that_leaves_nothing_is_not_fitted_on_every_row() {
        let trials = [1, 2].map(|seed| TestContact { branch: 150.0, ..TestContact::PLAIN }.trial(seed));
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials).weighed(&nominal));
        let nominal = data.again(&nominal);
        let search = Search { nominal: nominal.clone(), data, coarse, circumstances: Circumstances::default() };
        let quick = search.grown(&nominal);
        let full = search.polished(quick.clone(), &nominal);
        assert_eq!(full[0].model.names(0), ["stress_relaxation"]);
        assert!(full.len() < POLISHED, "{}", full.len());
        assert!(full.iter().all(|fit| !search.is_no_answer(&search.data, fit, &full[0])));
        assert!(search.polished(quick, &full[0]).len() > full.len());
    }

    /// A liquid bridge that is a capillary by its means of rows goes by what every row says, and a bridge stays one.
    #[test]
    fn which_law_of_an_effect_it_is_is_told_by_every_row() {
        const BRIDGE: usize = 3;
        const CAPILLARY: usize = 4;
        const SIZES: [f64; 2] = [0.3, 1.2e-3];
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial_under(seed, ("adhesion", BRIDGE, &SIZES)));
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials).weighed(&nominal));
        let nominal = data.again(&nominal);
        let search = Search { nominal: nominal.clone(), data, coarse, circumstances: Circumstances::default() };
        let told_as = |form: usize| {
            let model = nominal.model.with(Term { effect: crate::effects::find("adhesion").unwrap(), form });
            let start: Vec<f64> = nominal.values.iter().copied().chain(SIZES).collect();
            let fit = search.data.fit(&model, &start, Effort::FULL);
            (search.in_another_form(&fit, nominal.model.terms.len()), fit)
        };
        let (other, capillary) = told_as(CAPILLARY);
        let other = other.unwrap();
        assert_eq!(other.model.terms.last().map(|term| term.form), Some(BRIDGE), "{:?}", other.model.terms);
        assert!(other.energy < capillary.energy - 20.0, "{} {}", other.energy, capillary.energy);
        let (other, _) = told_as(BRIDGE);
        assert!(other.is_none(), "{:?}", other.map(|other| other.model.terms));
    }
}
