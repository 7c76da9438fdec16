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

impl Search<'_> {
    /// For each of `fits` whose effects build on one another the best that their forms do together, if it has not been asked for `before`.
    pub(super) fn composed(&self, fits: &[Fit], before: &mut Vec<(Vec<&'static str>, OwnValues)>) -> Vec<Fit> {
        let mut composed = Vec::new();
        for fit in fits {
            let asked = (sorted_names(&fit.model), fit.model.own);
            if before.contains(&asked) {
                continue;
            }
            before.push(asked);
            let first = self.nominal.model.terms.len();
            let pairs = (first..fit.model.terms.len())
                .flat_map(|upper| (first..fit.model.terms.len()).map(move |lower| (lower, upper)));
            for (lower, upper) in
                pairs.filter(|&(lower, upper)| builds_on(&fit.model.terms[upper], &fit.model.terms[lower]))
            {
                composed.extend(self.composed_of(fit, lower, upper));
            }
        }
        composed
    }

    /// `fit` with the forms of the terms `lower` and `upper` that do best together, where `upper` builds on `lower`.
    fn composed_of(&self, fit: &Fit, lower: usize, upper: usize) -> Vec<Fit> {
        let [lower_name, upper_name] = [lower, upper].map(|at| fit.model.terms[at].name());
        let mut bare = fit.clone();
        for at in [lower.max(upper), lower.min(upper)] {
            let (model, values) = without_term(&bare, at);
            bare = Fit { model, values, ..bare };
        }
        let bare = self.coarse.fit(&bare.model, &bare.values, Effort::QUICK);
        let lowers = self.promises(&bare, &|term| term.name() == lower_name);
        let lowers: Vec<Fit> = lowers.par_iter().map(|(promise, base)| self.with_effect(promise, base)).collect();
        let is_upper =
            |term: &Term| term.name() == upper_name && term.effect.builds_on(term.form).contains(&lower_name);
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

/// Whether some form of `upper`'s effect builds on that of `lower`.
fn builds_on(upper: &Term, lower: &Term) -> bool {
    let forms = upper.effect.spec().forms.len();
    (0..forms).any(|form| upper.effect.builds_on(form).contains(&lower.name()))
}
