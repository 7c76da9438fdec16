//! A set of effects without those that are not worth having beside the others.

use super::criteria::LEAST_GAIN;
use super::fit::{Effort, Fit};
use super::model::{ContactModel, index};
use super::own_values::{fewer_own_values, moved_values};
use super::rest::Rest;
use super::search::Search;
use crate::diagnose::term::Term;
use crate::effects::find;

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
            for at in self.nominal.model.terms.len()..best.model.terms.len() {
                let Some((model, values)) = self.with_special_case(&best, at) else { continue };
                let less = self.data.fit(&model, &values, Effort::FULL);
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

    /// `best` without the effects that another law of one of the others does without, as likely as `best` at the price of its values: of several laws of one effect the
    /// search takes the one that means of rows make likeliest, and what that leaves can look like an effect more.
    pub(super) fn in_fewer(&self, mut best: Fit) -> Fit {
        let first = self.nominal.model.terms.len();
        'again: loop {
            let rest = Rest::of(&self.data, &best);
            let own = self.price(&best, &rest);
            let is_as_good = |other: &Fit| self.price(other, &rest) < own + LEAST_GAIN;
            for spared in (first..best.model.terms.len()).rev() {
                let less = self.without(&best, spared);
                for at in first..less.model.terms.len() {
                    if let Some(other) = self.in_another_form(&less, at).filter(is_as_good) {
                        best = other;
                        continue 'again;
                    }
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

    /// Model and values of `fit` with the effect in the place of term `at` that this is where one of its values is zero; `None` where there is none,
    /// where the model has that effect already, or where the circumstances speak against it.
    fn with_special_case(&self, fit: &Fit, at: usize) -> Option<(ContactModel, Vec<f64>)> {
        let term = &fit.model.terms[at];
        let start = fit.model.first_value_of(at);
        let own = start..start + fit.model.count_of(term);
        let (name, form, special) = term.effect.special_case(term.form, &fit.values[own.clone()])?;
        if fit.model.times(name) > 0 || !self.circumstances.allow(name) {
            return None;
        }
        let mut model = fit.model.clone();
        model.terms[at] = Term { effect: find(name)?, form };
        let mut values = fit.values.clone();
        values.splice(own, special);
        Some((model, values))
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
        if model.bears(&model.terms[nth]) {
            continue;
        }
        let start = model.first_value_of(nth);
        let own = start..start + model.count_of(&model.terms[nth]);
        if let Some((form, simpler)) = effect.simpler(form, &values[own.clone()], stiffness) {
            model.terms[nth].form = form;
            values.splice(own, simpler);
        }
    }
    (model, values)
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// What is left of a drift that does not move, where the drive has spoken against `refuted`.
    fn pruned_drift(refuted: &[&'static str]) -> Fit {
        let trials = [TestContact { zero: 0.5, ..TestContact::PLAIN }.trial(1)];
        let data = || Data::new(&trials);
        let first = nominal_fit(&data(), &TestContact::nominal());
        let nominal = data().again(&first);
        let circumstances = Circumstances { refuted: refuted.to_vec(), ..Circumstances::default() };
        let search = Search { nominal, data: data(), coarse: data(), circumstances };
        let drift = Term { effect: find("force_drift").unwrap(), form: 1 };
        let values: Vec<f64> = search.nominal.values.iter().copied().chain([0.0, 0.5]).collect();
        let fit = search.data.fit(&search.nominal.model.with(drift), &values, Effort::FULL);
        search.pruned(fit)
    }

    /// A drift whose rate is nothing stands only where the bias that it is was never tried.
    #[test]
    fn a_drift_that_does_not_move_is_a_bias() {
        let pruned = pruned_drift(&[]);
        assert_eq!(pruned.model.names(0), ["force_bias"]);
        // 3000 rows of 0.02 N tell a constant to far better than a hundredth of a newton.
        assert!((pruned.values.last().unwrap() - 0.5).abs() < 0.01, "{:?}", pruned.values);
    }

    /// What the drive has spoken against does not come back by way of what it is a case of: the two channels would ask each other for ever.
    #[test]
    fn a_drift_is_no_bias_that_the_drive_has_spoken_against() {
        assert_eq!(pruned_drift(&["force_bias"]).model.names(0), ["force_drift"]);
    }
}
