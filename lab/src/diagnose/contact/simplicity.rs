//! Of the sets of effects that the recordings do not tell apart, the simplest.

use super::criteria::LEAST_GAIN;
use super::fit::Fit;
use super::rest::Rest;
use super::search::{Search, by_travel, sorted_names};
use super::worth::{are_told_apart, free};

/// Sets that are looked at for one whose effects stand beside one another.
const MOST_SURVIVORS: usize = 8;

impl Search<'_> {
    /// `fit`; where leaving out one effect after the other left none of it, the likeliest of `sets` whose effects stand beside one another.
    pub(super) fn surviving(&self, fit: Fit, sets: &[Fit]) -> Fit {
        let least = sets.iter().min_by(|a, b| a.energy.total_cmp(&b.energy));
        let Some(least) = least.filter(|_| fit.model == self.nominal.model) else { return fit };
        let rest = Rest::of(&self.data, least);
        let mut worthy: Vec<&Fit> = sets.iter().filter(|set| self.is_worth(set, &self.nominal)).collect();
        worthy.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
        let stands = |set: &Fit| {
            let pruned = self.pruned(set.clone());
            (pruned.model.terms.len() > self.nominal.model.terms.len()).then_some(pruned)
        };
        worthy.into_iter().take(MOST_SURVIVORS).find_map(stands).unwrap_or(fit)
    }

    /// The simplest of `sets` that the recordings do not tell from `best`, nor what is left of it without the effects that are not worth having
    /// there; `best` where there is none.
    pub(super) fn simplest(&self, best: Fit, sets: &[Fit]) -> Fit {
        let is_as_good = |other: &Fit| {
            let more = free(&best).saturating_sub(free(other));
            let worth = self.worth(&best, other);
            more > 0
                && !other.model.terms.is_empty()
                && (worth.gain < LEAST_GAIN + worth.price * more as f64 || !are_told_apart(&worth))
                && self.is_worth(other, &self.nominal)
        };
        let mut simpler: Vec<&Fit> = sets.iter().filter(|other| is_as_good(other)).collect();
        simpler.sort_by(|a, b| free(a).cmp(&free(b)).then(a.energy.total_cmp(&b.energy)));
        let mut pruned = simpler.into_iter().take(MOST_SURVIVORS).map(|simpler| self.pruned(simpler.clone()));
        pruned.find(is_as_good).unwrap_or(best)
    }

    /// `fit`; where the recordings show one speed, the likeliest of `sets` that is the same law there, by ways and not by times, if they do
    /// not tell it from `fit`: a way was seen, and a time was not.
    pub(super) fn without_times(&self, fit: Fit, sets: &[Fit]) -> Fit {
        let has_times = |fit: &Fit| sorted_names(&fit.model).into_iter().any(|name| by_travel(name).is_some());
        if !has_times(&fit) {
            return fit;
        }
        let same = sets.iter().filter(|other| !has_times(other) && self.is_one_law(&other.model, &fit.model));
        let least = same.min_by(|a, b| a.energy.total_cmp(&b.energy));
        match least.filter(|other| !are_told_apart(&self.worth(&fit, other))) {
            Some(other) => self.pruned(other.clone()),
            None => fit,
        }
    }
}
