//! Sets of terms that the recordings do not tell from the answer.

use super::criteria::{LEAST_GAIN, LEAST_THROUGHOUT};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut, rms};
use super::noise::Noise;
use super::selection::{Chosen, Search};

/// A set of terms that the recordings do not tell from the answer.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Its terms.
    pub names: Vec<&'static str>,
    /// Share of the held-out mismatch that it takes.
    pub held_out_share: f64,
    /// What it leaves, N or N m in root mean square on held-out rows.
    pub left: f64,
}

impl Alternative {
    /// `fit`, which leaves `held_out` where the nominal law leaves `refitted`.
    #[must_use]
    pub fn of(fit: &Fit, held_out: &HeldOut, refitted: &HeldOut) -> Self {
        let [left, before] = [held_out, refitted].map(|of| rms(&of.missing));
        let share = 1.0 - (left / before.max(f64::MIN_POSITIVE)).powi(2);
        Self { names: fit.model.names(), held_out_share: share.clamp(0.0, 1.0), left }
    }
}

/// Alternatives that are told.
pub const MOST_ALTERNATIVES: usize = 3;

/// Sets that were fitted in full and are neither refused by the likelihood nor told like the answer.
#[must_use]
pub fn alternatives(
    search: &Search<'_>,
    folds: &Folds,
    common: &Noise,
    fit: &Fit,
    chosen: &Chosen,
    refitted: &HeldOut,
) -> Vec<Alternative> {
    if fit.model == search.nominal.model {
        return Vec::new();
    }
    let is_open = |other: &&Fit| {
        other.model.names() != fit.model.names()
            && other.model.told_terms() <= fit.model.told_terms()
            && (fit.log_likelihood - other.log_likelihood < LEAST_GAIN
                || search.worth(fit, other).throughout < LEAST_THROUGHOUT)
    };
    let open = chosen.sets.iter().filter(is_open).take(MOST_ALTERNATIVES);
    open.map(|other| Alternative::of(other, &folds.held_out(&search.data, other, common), refitted)).collect()
}
