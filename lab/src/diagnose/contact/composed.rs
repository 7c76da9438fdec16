//! Effects of which one builds on the other, as a memory multiplies a spring: composed anew from the spring up.
//!
//! The best spring beside a memory that is added to it is not the best one beneath a memory that multiplies it, and neither is found by
//! exchanging the other alone.

use rayon::prelude::*;

use super::fit::{Effort, Fit};
use super::model::OwnValues;
use super::pruning::without_term;
use super::search::{Search, sorted_names};
use crate::diagnose::term::Term;

/// Laws of the spring, one of which a memory is composed with even where none was found beside it: a spring bends by the one or the other.
const SPRINGS: [&str; 2] = ["nonlinear_stiffness", "layered_stiffness"];

impl Search<'_> {
    /// For each of `fits` with a memory, or whatever else builds on a spring, the best that the forms of it and of each law of the spring
    /// do together, if that has not been `asked` before.
    pub(super) fn composed(&self, fits: &[Fit], asked: &mut Vec<(Vec<&'static str>, OwnValues)>) -> Vec<Fit> {
        let first = self.nominal.model.terms.len();
        let mut composed = Vec::new();
        for fit in fits {
            for upper in first..fit.model.terms.len() {
                let upper_name = fit.model.terms[upper].name();
                for lower in springs_under(&fit.model.terms[upper]) {
                    let bare = self.bare(fit, upper);
                    let mut names = sorted_names(&bare.model);
                    names.extend([lower, upper_name]);
                    let question = (names, fit.model.own);
                    if self.has_room(&bare, 2) && !asked.contains(&question) {
                        composed.extend(self.composed_on(&bare, lower, &fit.model.terms[upper]));
                        asked.push(question);
                    }
                }
            }
        }
        composed
    }

    /// `fit` without the term `upper` and without the law of the spring that was found.
    fn bare(&self, fit: &Fit, upper: usize) -> Fit {
        let mut bare = fit.clone();
        for at in (self.nominal.model.terms.len()..fit.model.terms.len()).rev() {
            if at == upper || SPRINGS.contains(&fit.model.terms[at].name()) {
                let (model, values) = without_term(&bare, at);
                bare = Fit { model, values, ..bare };
            }
        }
        bare
    }

    /// `bare` with the forms of `lower_name` and, building on it, of the effect of `upper` that do best together.
    fn composed_on(&self, bare: &Fit, lower_name: &'static str, upper: &Term) -> Vec<Fit> {
        let bare = self.coarse.fit(&bare.model, &bare.values, Effort::QUICK);
        let forms = forms_of(upper);
        let is_lower = |term: &Term| term.name() == lower_name && forms.iter().any(|upper| upper.builds_on(term));
        let lowers = self.promises(&bare, &is_lower);
        let lowers: Vec<Fit> = lowers.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        let is_upper = |term: &Term| {
            term.name() == upper.name() && term.foundations().iter().any(|lower| lower.name == lower_name)
        };
        let both: Vec<_> = lowers.iter().flat_map(|base| self.promises(base, &is_upper)).collect();
        let both = both.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        // Each form for itself: which of them the other effects leave standing is told later, on every row.
        self.to_the_end(self.coarsely_polished(both))
    }
}

/// Laws of the spring that some form of `upper`'s effect builds on.
fn springs_under(upper: &Term) -> impl Iterator<Item = &'static str> {
    let forms = forms_of(upper);
    let builds_on = move |spring: &str| forms.iter().flat_map(Term::foundations).any(|law| law.name == spring);
    SPRINGS.into_iter().filter(move |spring| builds_on(spring))
}

/// All laws of `term`'s effect.
fn forms_of(term: &Term) -> Vec<Term> {
    (0..term.effect.spec().forms.len()).map(|form| Term { form, ..*term }).collect()
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::nominal::nominal_fit;
    use super::super::rest::Rest;
    use super::super::testing::TestContact;
    use super::*;

    #[test]
    fn memory_and_spring_are_composed_from_the_spring_up() {
        let trials = [1, 2].map(|seed| TestContact { exponent: 1.8, fading: 1.5, ..TestContact::PLAIN }.trial(seed));
        let first = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let data = || Data::new(&trials).weighed(&first);
        let circumstances = Circumstances::default();
        let search = Search { nominal: data().again(&first), data: data(), coarse: data(), circumstances };
        let relaxation = Term { effect: crate::effects::find("stress_relaxation").unwrap(), form: 0 };
        let model = first.model.with(relaxation);
        let start: Vec<f64> = first.values.iter().copied().chain([100.0, 0.4]).collect();
        let beside = search.data.fit(&model, &start, Effort::FULL);
        let composed = search.composed(std::slice::from_ref(&beside), &mut Vec::new());
        // At the price of their values, as the search compares them: a second branch takes a little of the noise.
        let price = |fit: &Fit| search.price(fit, &Rest::of(&search.data, &composed[0]));
        let least = composed.iter().min_by(|a, b| price(a).total_cmp(&price(b))).unwrap();
        assert_eq!(sorted_names(&least.model), ["nonlinear_stiffness", "stress_relaxation"]);
        // The effective weights are those of the nominal law and so a little too small: the right law leaves less than the expected one.
        assert!(least.energy < 1.1 * search.data.expected(), "{} of {}", least.energy, search.data.expected());
        assert!(beside.energy > 3.0 * least.energy, "{} beside {}", beside.energy, least.energy);
        // Without its spring the memory is one beside the straight spring, with the sizes of that.
        let at = least.model.terms.iter().position(|term| term.name() == "nonlinear_stiffness").unwrap();
        let (model, _) = without_term(least, at);
        assert_eq!(model.terms, [relaxation]);
    }
}
