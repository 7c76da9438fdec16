//! A set of effects without those that are not worth having beside the others.

use super::fit::{Effort, Fit};
use super::model::{ContactModel, index};
use super::own_values::{fewer_own_values, moved_values};
use super::search::Search;
use crate::diagnose::term::Term;

/// Part of the recordings' own stiffness that a memory starts beside at the least: beside no spring it would start as none.
const LEAST_STIFFNESS: f64 = 0.1;

impl Search<'_> {
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
