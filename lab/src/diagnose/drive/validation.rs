//! Which terms rows that their values were not fitted to confirm (cross-validation).

use super::criteria::{COMPARISONS, LEAST_HELD_OUT_SHARE};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut, rms};
use super::noise::Noise;
use super::selection::Search;
use super::term::Term;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::model_comparison::likelihood_ratio_p;

/// The terms that unseen rows confirm, with what each takes of them.
#[must_use]
pub fn validated(search: &Search<'_>, folds: &Folds, common: &Noise, mut fit: Fit) -> (Fit, HeldOut, Vec<NamedTerm>) {
    loop {
        let held = folds.held_out(&search.data, &fit, common);
        let first = search.nominal.model.terms.len();
        let told: Vec<usize> = (first..fit.model.terms.len()).filter(|at| fit.model.terms[*at].is_told()).collect();
        let without: Vec<(Fit, HeldOut)> = told
            .iter()
            .map(|&at| {
                let less = without(search, &fit, at);
                let left = folds.held_out(&search.data, &less, common);
                (less, left)
            })
            .collect();
        let share = |left: &HeldOut| 1.0 - held.density / left.density.max(f64::MIN_POSITIVE);
        // Sub-linear friction is what dry friction leaves: the latter cannot go before it.
        let carries =
            |term: &Term| matches!(term, Term::Coulomb | Term::Stribeck) && fit.model.has("sublinear_friction");
        let needless = (0..without.len())
            .filter(|nth| share(&without[*nth].1) < LEAST_HELD_OUT_SHARE && !carries(&fit.model.terms[told[*nth]]));
        if let Some(nth) = needless.min_by(|a, b| without[*a].1.density.total_cmp(&without[*b].1.density)) {
            fit = without[nth].0.clone();
            continue;
        }
        let named = without.iter().enumerate().map(|(nth, (less, left))| NamedTerm {
            at: told[nth],
            held_out_share: share(left).clamp(0.0, 1.0),
            p_value: (COMPARISONS * p_value(&fit, less)).min(1.0),
            without: rms(&left.missing),
        });
        let named = named.collect();
        return (fit, held, named);
    }
}

/// `fit` without term `at`, refitted; terms that cannot stand without it go with it.
fn without(search: &Search<'_>, fit: &Fit, at: usize) -> Fit {
    let (model, values) = fit.model.without(at, &fit.values);
    search.lessened(fit, model, values)
}

/// Likelihood-ratio test of `more` against `less`.
fn p_value(more: &Fit, less: &Fit) -> f64 {
    likelihood_ratio_p(more.log_likelihood - less.log_likelihood, more.values.len().saturating_sub(less.values.len()))
}
