//! Sets with one term more: tried on some of the rows, and the likeliest of them fitted to all.

use super::candidates::{one_body, tried};
use super::criteria::MOST_OF_THE_REST;
use super::fit::{Effort, Fit, fit};
use super::likelihood::Data;
use super::links;
use super::sample::sample;
use super::selection::{Search, is_at_end};
use super::worth::share_taken;

/// Sets of a round that are fitted in full.
const POLISHED: usize = 5;

impl Search<'_> {
    /// Each of `beam` with one term more, in full.
    #[must_use]
    pub fn grown(&self, beam: &[Fit], best: &Fit) -> Vec<Fit> {
        beam.iter().flat_map(|base| self.in_full(&self.quickly_grown(base), base, best)).collect()
    }

    /// `base` with each candidate term, fitted quickly, the likeliest first: on a sample of the rows; beside a link, of which every row costs many
    /// steps, on the liveliest stretch. What a term gains is told from the base on the same rows.
    fn quickly_grown(&self, base: &Fit) -> Vec<Fit> {
        let disturbance = self.disturbance(base);
        let candidates = one_body(&self.data, base, &disturbance);
        let some = if base.model.has_link() {
            Some(vec![links::liveliest(&self.data, &disturbance)])
        } else {
            sample(&self.data, &disturbance)
        };
        let Some(trials) = some else { return tried(&self.data, base, candidates) };
        let data = Data { trials: &trials, ..self.data };
        let base = fit(&data, &base.model, &base.values, base.noise, Effort::QUICK);
        tried(&data, &base, candidates)
    }

    /// The likeliest of the `quick` sets, grown from `base`, in full; but those of which another, that is worth it beside `best`, takes most of what
    /// they leave.
    fn in_full(&self, quick: &[Fit], base: &Fit, best: &Fit) -> Vec<Fit> {
        let mut full = Vec::new();
        let mut worthy: Vec<&Fit> = Vec::new();
        for quick in quick.iter().take(POLISHED) {
            if worthy.iter().any(|other| self.leaves_far_more(quick, other)) {
                continue;
            }
            let fit = self.within_ends(self.without_idle_friction(self.polished(quick)), base);
            if !is_at_end(&fit) && self.is_worth(&fit, best) {
                worthy.push(quick);
            }
            full.push(fit);
        }
        full
    }

    /// Whether `other` takes so much of what `fit` leaves that this is no answer beside it. Both are fitted to the same rows.
    #[must_use]
    pub fn leaves_far_more(&self, fit: &Fit, other: &Fit) -> bool {
        let power = |fit: &Fit| self.unexplained(fit).powi(2);
        share_taken(power(fit), power(other), 2.0 * self.effort_noise_density * self.band_hz) > MOST_OF_THE_REST
    }
}

#[cfg(test)]
mod tests {
    use super::super::term::Term;
    use super::super::testing::{TestDrive, search_over};
    use super::*;

    /// Dry friction is all there is: what takes a little of it, as a load or a lag, is no answer and need not be fitted in full. Beside it nothing
    /// is worth its values, and each of the likeliest is.
    #[test]
    fn what_leaves_far_more_than_a_set_that_is_worth_it_is_not_fitted_in_full() {
        let drive = TestDrive { coulomb: 0.4, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let quick = search.quickly_grown(&search.nominal);
        let full = search.in_full(&quick, &search.nominal, &search.nominal);
        assert!(quick.len() > POLISHED && full.len() < POLISHED, "{} {}", quick.len(), full.len());
        let best = full.iter().find(|fit| fit.model.terms.contains(&Term::Coulomb)).expect("dry friction");
        assert!(full.iter().all(|fit| !search.leaves_far_more(fit, best)));
        assert!(search.leaves_far_more(&search.nominal, best) && !search.leaves_far_more(best, &search.nominal));
        assert_eq!(search.in_full(&quick, &search.nominal, best).len(), POLISHED);
    }

    /// Of a recording that is sampled, friction gains what it does on the sample: from the likelihood of all rows it would gain nothing, and the way
    /// over which it builds up would not be looked for.
    #[test]
    fn what_a_term_gains_is_told_from_its_base_on_the_same_rows() {
        let drive = TestDrive { coulomb: 0.8, presliding: 2e-4, encoder: 1e-6, ..TestDrive::PLAIN };
        let trials = [drive.trial(14.0, 6)];
        let search = search_over(&trials, &drive);
        assert!(sample(&search.data, &search.disturbance(&search.nominal)).is_some());
        let quick = search.quickly_grown(&search.nominal);
        let rubs = quick.iter().find(|fit| fit.model.terms.contains(&Term::Coulomb)).expect("dry friction");
        assert!(rubs.model.terms.contains(&Term::Presliding), "{:?}", rubs.model.terms);
        // On nine rows of fourteen the likelihood is as much less.
        assert!(rubs.log_likelihood < 0.8 * search.nominal.log_likelihood);
    }
}
