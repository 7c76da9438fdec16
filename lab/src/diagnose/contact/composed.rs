//! Effects of which one builds on the other, as a memory multiplies a spring: composed anew from the spring up.
//!
//! The best spring beside a memory that is added to it is not the best one beneath a memory that multiplies it, and neither is found by
//! exchanging the other alone.

use rayon::prelude::*;

use super::fit::{Effort, Fit, Rest};
use super::model::OwnValues;
use super::selection::{Search, sorted_names, without_term};
use crate::diagnose::term::Term;

/// Composed laws that are fitted to the end.
const POLISHED: usize = 3;

/// Laws of the spring, one of which a memory is composed with even where none was found beside it: a spring bends by the one or the other.
const SPRINGS: [&str; 2] = ["nonlinear_stiffness", "layered_stiffness"];

impl Search<'_> {
    /// For each of `fits` with a memory, or whatever else builds on others, the best that the forms of it and of each law that it can
    /// build on do together, if that has not been `asked` before.
    pub(super) fn composed(&self, fits: &[Fit], asked: &mut Vec<(Vec<&'static str>, OwnValues)>) -> Vec<Fit> {
        let first = self.nominal.model.terms.len();
        let mut composed = Vec::new();
        for fit in fits {
            for upper in first..fit.model.terms.len() {
                for lower in built_on(&fit.model.terms[upper]) {
                    let Some(bare) = self.bare(fit, upper, lower) else { continue };
                    let mut names = sorted_names(&bare.model);
                    names.extend([lower, fit.model.terms[upper].name()]);
                    let question = (names, fit.model.own);
                    if !asked.contains(&question) {
                        composed.extend(self.composed_on(&bare, lower, fit.model.terms[upper].name()));
                        asked.push(question);
                    }
                }
            }
        }
        composed
    }

    /// `fit` without the term `upper` and without all that it can build on; `None` where `lower` is a law of its own kind that `fit` does
    /// without.
    fn bare(&self, fit: &Fit, upper: usize, lower: &'static str) -> Option<Fit> {
        let laws = built_on(&fit.model.terms[upper]);
        let is_there = fit.model.times(lower) > 0;
        if !is_there && !SPRINGS.contains(&lower) {
            return None;
        }
        let first = self.nominal.model.terms.len();
        let is_other = |term: &Term| term.name() == lower || SPRINGS.contains(&lower) && SPRINGS.contains(&term.name());
        let mut bare = fit.clone();
        for at in (first..fit.model.terms.len()).rev() {
            let term = &fit.model.terms[at];
            if at == upper || laws.contains(&term.name()) && is_other(term) {
                let (model, values) = without_term(&bare, at);
                bare = Fit { model, values, ..bare };
            }
        }
        Some(bare)
    }

    /// `bare` with the forms of `lower_name` and, building on it, of `upper_name` that do best together.
    fn composed_on(&self, bare: &Fit, lower_name: &str, upper_name: &str) -> Vec<Fit> {
        let bare = self.coarse.fit(&bare.model, &bare.values, Effort::QUICK);
        let lowers = self.promises(&bare, &|term| term.name() == lower_name);
        let lowers: Vec<Fit> = lowers.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        let is_upper = |term: &Term| {
            term.name() == upper_name && term.effect.builds_on(term.form).iter().any(|name| *name == lower_name)
        };
        let both = lowers.iter().flat_map(|base| self.promises(base, &is_upper));
        let both: Vec<_> = both.collect();
        let mut both: Vec<Fit> = both.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        let Some(least) = both.iter().min_by(|a, b| a.energy.total_cmp(&b.energy)) else { return Vec::new() };
        let rest = Rest::of(&self.coarse, least);
        both.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        both.truncate(POLISHED);
        let to_the_end = |fit: &Fit| {
            let fit = self.coarse.fit(&fit.model, &fit.values, Effort::FULL);
            self.data.fit(&fit.model, &fit.values, Effort::FULL)
        };
        both.par_iter().map(to_the_end).collect()
    }
}

/// Names that some form of `upper`'s effect builds on.
fn built_on(upper: &Term) -> &'static [&'static str] {
    let forms = upper.effect.spec().forms.len();
    (0..forms).map(|form| upper.effect.builds_on(form)).find(|names| !names.is_empty()).unwrap_or_default()
}
