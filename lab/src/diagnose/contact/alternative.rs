//! What the recordings do not tell from the answer.

use super::criteria::{LEAST_GAIN, LEAST_VUONG};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut, rms};
use super::search::{Search, sorted_names};
use super::selection::Chosen;

/// A set of effects that the recordings do not tell from the answer.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Its effects.
    pub names: Vec<&'static str>,
    /// Share of the held-out mismatch that it takes.
    pub held_out_share: f64,
    /// What it leaves, N or N m in root mean square on held-out rows.
    pub left: f64,
    /// Its law.
    pub fit: Fit,
}

/// Alternatives that are told.
const MOST_ALTERNATIVES: usize = 3;

/// Sets that were fitted in full and are neither refused by the likelihood nor told like the answer.
pub(super) fn alternatives(
    search: &Search<'_>,
    folds: &Folds,
    fit: &Fit,
    chosen: &Chosen,
    refitted: &HeldOut,
) -> Vec<Alternative> {
    let first = search.nominal.model.terms.len();
    if fit.model.terms.len() == first {
        return Vec::new();
    }
    let expected = search.data.expected();
    let is_open = |other: &&Fit| {
        let worth = search.worth(fit, other);
        // Values of each trial's own have no name that could be told.
        other.model.terms.len() > first
            && sorted_names(&other.model) != sorted_names(&fit.model)
            && other.model.terms.len() <= fit.model.terms.len()
            && (worth.gain < LEAST_GAIN || worth.vuong < LEAST_VUONG || search.is_one_law(&other.model, &fit.model))
            && search.is_worth(other, &search.nominal)
    };
    let mut open: Vec<&Fit> = Vec::new();
    for set in chosen.sets.iter().filter(is_open) {
        if open.iter().all(|other| sorted_names(&other.model) != sorted_names(&set.model)) {
            open.push(set);
        }
    }
    let told = open.into_iter().take(MOST_ALTERNATIVES).map(|other| {
        let unseen = folds.held_out(&search.data, other);
        let taken = refitted.energy - unseen.energy;
        let share = taken / (refitted.energy - expected).max(taken.abs()).max(f64::MIN_POSITIVE);
        Alternative {
            names: other.model.names(first),
            held_out_share: share.clamp(0.0, 1.0),
            left: rms(&search.data, &unseen.residual),
            fit: other.clone(),
        }
    });
    told.collect()
}
