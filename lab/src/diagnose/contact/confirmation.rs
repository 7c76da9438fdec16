//! Which of the effects that were found rows confirm that no fit saw.

use super::criteria::{COMPARISONS, LEAST_HELD_OUT_SHARE, LEAST_LINE_POWER};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut, rms};
use super::lines::line_beyond;
use super::search::Search;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::model_comparison::likelihood_ratio_p;

/// The effects that unseen rows confirm, with what each takes of them.
pub(super) fn believed(search: &Search<'_>, folds: &Folds, mut fit: Fit) -> (Fit, HeldOut, Vec<NamedTerm>) {
    let data = &search.data;
    let expected = data.expected();
    loop {
        let held = folds.held_out(data, &fit);
        let first = search.nominal.model.terms.len();
        let without: Vec<(Fit, f64, f64)> = (first..fit.model.terms.len())
            .map(|at| {
                let less = search.without(&fit, at);
                let left = folds.held_out(data, &less);
                (less, left.energy, rms(data, &left.residual))
            })
            .collect();
        let share = |left: f64| {
            let taken = left - held.energy;
            if taken > 0.0 { taken / (left - expected).max(taken) } else { 0.0 }
        };
        // A line is no part of what a law leaves.
        let is_confirmed = |(less, left, _): &(Fit, f64, f64)| match line_beyond(&fit, less) {
            Some(_) => left - held.energy > LEAST_LINE_POWER * expected,
            None => share(*left) >= LEAST_HELD_OUT_SHARE,
        };
        let needless = (0..without.len()).filter(|nth| !is_confirmed(&without[*nth]));
        if let Some(nth) = needless.min_by(|a, b| without[*a].1.total_cmp(&without[*b].1)) {
            fit = without[nth].0.clone();
            continue;
        }
        let named = without.iter().enumerate().map(|(nth, (less, left, without))| NamedTerm {
            at: first + nth,
            held_out_share: share(*left).clamp(0.0, 1.0),
            p_value: (COMPARISONS * likelihood_ratio_p(search.worth(&fit, less).gain, added_values(&fit, less)))
                .min(1.0),
            without: *without,
        });
        let named = named.collect();
        return (fit, held, named);
    }
}

/// Values that are fitted in `more` and not in `less`.
fn added_values(more: &Fit, less: &Fit) -> usize {
    more.model.free_count().saturating_sub(less.model.free_count())
}
