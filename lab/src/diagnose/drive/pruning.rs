//! A set of terms without those that are not worth having beside the others, or with a simpler law in the place of one.

use super::candidates::{belongs, idle_friction, simpler, whole_friction};
use super::fit::Fit;
use super::model::Model;
use super::selection::Search;

impl Search<'_> {
    /// The smaller `model` in the place of that of `fit`, fitted from `values`. A link can have stood for a part of its friction.
    #[must_use]
    pub fn lessened(&self, fit: &Fit, model: Model, values: Vec<f64>) -> Fit {
        if model == self.nominal.model {
            return self.nominal.clone();
        }
        let mut less = self.polished(&Fit { model, values, ..fit.clone() });
        if less.log_likelihood < self.nominal.log_likelihood {
            // It holds the nominal law and is no less likely: the search began so quiet that the filter followed no row, and stayed there.
            less = self.polished(&Fit { noise: self.nominal.noise, ..less });
        }
        if fit.model.has_link() && !less.model.has_link() {
            return self.polished(&whole_friction(&self.data, less));
        }
        less
    }

    /// `fit` without parts of its friction that ended where their search did.
    #[must_use]
    pub fn without_idle_friction(&self, mut fit: Fit) -> Fit {
        while let Some(at) = idle_friction(&fit) {
            let (model, values) = fit.model.without(at, &fit.values);
            fit = self.polished(&Fit { model, values, ..fit });
        }
        fit
    }

    /// `fit`, where what was added to `base` shows that terms found with that were too many, with the simpler law in the place of each, or without it:
    /// a weak link, or a cogging, makes Stribeck friction of Coulomb friction. The rig file's own terms stay.
    #[must_use]
    pub fn within_ends(&self, mut fit: Fit, base: &Fit) -> Fit {
        let known = self.nominal.model.terms.len();
        loop {
            let is_at_end = |at: &usize| {
                let term = &fit.model.terms[*at];
                !term.is_link()
                    && base.model.terms.contains(term)
                    && term.is_at_end(&fit.values[fit.model.values_of(*at)], &fit.model.scales)
            };
            let ended = (known..fit.model.terms.len()).find(is_at_end);
            let Some((model, values)) = ended.and_then(|at| simpler(&fit, at).into_iter().next()) else { return fit };
            fit = self.polished(&Fit { model, values, ..fit });
        }
    }

    /// Whether term `at` of `best`, or its refinement, is worth having beside the others, of which `less` is the law, or does only an inertia without it
    /// that is not believed.
    fn is_needed(&self, best: &Fit, less: &Fit, at: usize) -> bool {
        let is_worth = || {
            let is_told = best.model.terms[at].is_told();
            if is_told { self.is_worth(best, less) } else { belongs(&self.data, best, less) }
        };
        less.loses_inertia_of(best) || is_worth()
    }

    /// `best` without the terms, or the refinements of a law, that are not worth having beside the others.
    #[must_use]
    pub fn pruned(&self, mut best: Fit) -> Fit {
        'again: loop {
            for at in (self.nominal.model.terms.len()..best.model.terms.len()).rev() {
                for (model, values) in simpler(&best, at) {
                    let less = self.lessened(&best, model, values);
                    if !self.is_needed(&best, &less, at) {
                        best = less;
                        continue 'again;
                    }
                }
            }
            return best;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::Side;
    use super::super::levenberg_marquardt::Ended;
    use super::super::model::index;
    use super::super::noise::Noise;
    use super::super::term::Term;
    use super::super::testing::{SCALES, TestDrive, TestLink, search_over, with_dry_friction};
    use super::*;

    /// Dry friction with a ripple along the way: alone it looks larger when creeping, beside the ripple it does not.
    #[test]
    fn a_refinement_that_ends_where_its_search_did_goes_when_another_term_comes() {
        let drive = TestDrive { coulomb: 0.4, ripple: 0.3, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 5)];
        let search = search_over(&trials, &drive);
        let fit = |terms: Vec<Term>, own: &[f64]| Fit {
            model: Model { terms, scales: SCALES },
            values: [&[0.8, 4.0, 0.0, 0.0], own].concat(),
            noise: Noise { ln_disturbance: -8.0, ln_encoder: drive.encoder.powi(2).ln() },
            log_likelihood: 0.0,
            ended: Ended::Converged,
        };
        let wavenumber = std::f64::consts::TAU / 5e-3;
        let creeping = fit(vec![Term::Stribeck], &[0.4, 0.2, 0.01]);
        let both = fit(vec![Term::Stribeck, Term::Cogging], &[0.4, 0.0, 0.01, 0.3, 0.0, wavenumber]);
        let simpler = search.within_ends(both.clone(), &creeping);
        assert_eq!(simpler.model.terms, [Term::Coulomb, Term::Cogging]);
        // Four seconds tell the level and the ripple to some hundredths.
        assert!(
            (simpler.values[4] - 0.4).abs() < 0.02 && (simpler.values[5] - 0.3).abs() < 0.02,
            "{:?}",
            simpler.values
        );
        // A new term that ends there is not had in another form: it is none.
        let new = fit(vec![Term::Cogging, Term::Stribeck], &[0.3, 0.0, wavenumber, 0.4, 0.0, 0.01]);
        let beside = fit(vec![Term::Cogging], &[0.3, 0.0, wavenumber]);
        assert_eq!(search.within_ends(new.clone(), &beside).model, new.model);
        // Nor is one that the rig file holds.
        let known = Search { nominal: creeping.clone(), ..search };
        assert_eq!(known.within_ends(both.clone(), &creeping).model, both.model);
    }

    /// A play explains all of a motion, so that no disturbance is left; from there the search for a link without it would follow no row.
    #[test]
    fn a_smaller_law_is_no_less_likely_than_the_nominal_one_that_it_holds() {
        let link = TestLink { stiffness: 4e4, damping: 30.0, play: 2e-4, load_share: 0.5, friction_share: 0.0 };
        let drive = TestDrive { link: Some(link), ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 7)];
        let search = search_over(&trials, &drive);
        let play = Fit {
            model: search.nominal.model.with(Term::Play(Side::Motor)),
            values: vec![0.8, 4.0, 0.0, 0.0, 4e4, 30.0, 0.5, 2e-4, 0.0],
            noise: Noise { ln_disturbance: -90.0, ..search.nominal.noise },
            ..search.nominal.clone()
        };
        let (model, values) = simpler(&play, 0).remove(0);
        assert_eq!(model.names(), ["transmission_compliance"]);
        let less = search.lessened(&play, model, values);
        assert!(
            less.log_likelihood > search.nominal.log_likelihood,
            "{} {}",
            less.log_likelihood,
            search.nominal.log_likelihood
        );
    }

    /// Dry friction is all there is. A body of a fifth of the mass without it leaves next to no force, as that is told in parts of the mass, and
    /// is a law of the drive no more than one of any force.
    #[test]
    fn a_term_stays_that_only_an_inertia_that_is_not_believed_does_without() {
        let drive = TestDrive { coulomb: 0.4, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let rubs = with_dry_friction(&search);
        let mut light = search.nominal.clone();
        light.values[index::INERTIA] = light.model.ranges()[index::INERTIA].low;
        light.noise.ln_disturbance = rubs.noise.ln_disturbance - 1.0;
        light.log_likelihood = search.data.log_likelihood(&light.model, &light.values, &light.noise).0;
        assert!(light.loses_inertia_of(&rubs) && light.log_likelihood < rubs.log_likelihood - 1000.0);
        assert!(!search.is_worth(&rubs, &light) && search.is_needed(&rubs, &light, 0));
        // Beside the believed body it would leave as much more force; a heavier one leaves what it leaves.
        let inertia = |fit: &Fit| fit.values[index::INERTIA];
        assert!((light.force_beside(&rubs) * inertia(&light) / inertia(&rubs) - 1.0).abs() < 1e-12);
        let mut heavy = light.clone();
        heavy.values[index::INERTIA] = heavy.model.ranges()[index::INERTIA].high;
        assert!(heavy.loses_inertia_of(&rubs) && heavy.force_beside(&rubs) == 1.0 && rubs.force_beside(&light) == 1.0);
        // Nor is a law of such an inertia any better with the term.
        let both = Fit { values: light.values.iter().copied().chain([0.4]).collect(), ..rubs };
        assert!(!light.loses_inertia_of(&both));
    }
}
