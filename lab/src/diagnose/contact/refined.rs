//! Finer forms of the laws that were chosen, for a real thing that no simple form reaches.
//!
//! A switch has a preload, a soft way, a pocket and a stop, and rubs on a part of the way: which effects those are is told by their
//! simplest forms, and how many layers there are is found one after the other. Near the sensors' noise nothing is refined.

use rayon::prelude::*;

use super::criteria::{FAR_FROM_NOISE, LEAST_GAIN, LEAST_PART_OF_FORCE};
use super::fit::{Effort, Fit};
use super::held_out::Folds;
use super::model::index;
use super::rest::Rest;
use super::search::Search;
use super::worth::free;
use crate::diagnose::term::Term;

/// Features that are added one after the other, at the most.
const MOST_REFINEMENTS: usize = 6;

/// Starts of a finer form that are fitted to the end.
const POLISHED: usize = 3;

impl Search<'_> {
    /// `fit`, where it has effects and stays far above the noise, by finer forms of them, and with what stands beside these alone.
    pub(super) fn refined(&mut self, mut fit: Fit, say: &dyn Fn(&str)) -> Fit {
        say(&format!("the contact: {}; finer forms of each law", self.so_far(&fit)));
        for _ in 0..MOST_REFINEMENTS {
            if !self.is_far(&fit) {
                break;
            }
            let Some(finer) = self.finer(&fit).or_else(|| self.one_more(&fit)) else { break };
            fit = self.weigh_by(finer);
        }
        self.pruned(fit)
    }

    /// Whether `fit` has effects of its own and leaves more than the sensors do by far.
    fn is_far(&self, fit: &Fit) -> bool {
        fit.model.terms.len() > self.nominal.model.terms.len()
            && Rest::of(&self.data, fit).over_sensors > FAR_FROM_NOISE
    }

    /// `fit` with one effect by a finer form, the best that is worth its values.
    fn finer(&self, fit: &Fit) -> Option<Fit> {
        let first = self.nominal.model.terms.len();
        let each = (first..fit.model.terms.len()).filter_map(|at| self.with_finer_form(fit, at));
        let finer = each.filter(|finer| self.is_admissible(finer) && self.is_finer(finer, fit));
        let rest = Rest::of(&self.data, fit);
        finer.min_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)))
    }

    /// `fit` with term `at` by the form that refines its own; `None` where none does.
    fn with_finer_form(&self, fit: &Fit, at: usize) -> Option<Fit> {
        let Term { effect, form } = fit.model.terms[at];
        let start = fit.model.first_value_of(at);
        let own = start..start + fit.model.count_of(&fit.model.terms[at]);
        let [stiffness, surface] = [index::STIFFNESS, index::SURFACE].map(|at| fit.values[at]);
        let bilateral = fit.model.bilateral;
        let scene = fit.model.scales.excitation(self.coarse.trials, stiffness, surface, bilateral);
        let (form, starts) = effect.refined(form, &fit.values[own.clone()], &scene)?;
        let mut model = fit.model.clone();
        model.terms[at].form = form;
        let mut tried: Vec<Fit> = starts
            .par_iter()
            .map(|values| {
                let mut all = fit.values.clone();
                all.splice(own.clone(), values.iter().copied());
                self.coarse.fit(&model, &all, Effort::QUICK)
            })
            .collect();
        tried.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        tried.truncate(POLISHED);
        tried.par_iter_mut().for_each(|fit| *fit = self.coarse.again(fit));
        let best = tried.into_iter().min_by(|a, b| a.energy.total_cmp(&b.energy))?;
        Some(self.data.again(&best))
    }

    /// Whether `more`, the same effects by a finer form, is worth its values, on unseen rows too. No share is asked of it: the name stands
    /// already.
    fn is_finer(&self, more: &Fit, less: &Fit) -> bool {
        let values = free(more).saturating_sub(free(less)).max(1);
        let worth = self.worth(more, less);
        let folds = Folds::of(&self.data);
        worth.gain > LEAST_GAIN + worth.price * values as f64
            && worth.part_of_force > LEAST_PART_OF_FORCE
            && folds.held_out(&self.data, more).energy < folds.held_out(&self.data, less).energy
    }

    /// `fit` with one more effect that stands beside it.
    fn one_more(&self, fit: &Fit) -> Option<Fit> {
        if !self.has_room(fit, 1) {
            return None;
        }
        let grown = self.polished(self.grown(fit), fit);
        let rest = Rest::of(&self.data, fit);
        let worthy = grown.into_iter().filter(|more| self.is_admissible(more) && self.is_worth(more, fit));
        worthy.min_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::testing::TestContact;
    use crate::diagnose::verdict::Verdict;

    /// A spring of 300 N/m with a pocket from 2 to 3 mm, where it falls by 600 N/m, and a stop at 6 mm: four layers, of which a search
    /// by three finds the names and the refinement the rest.
    #[test]
    fn a_pocket_before_a_stop_is_four_layers_at_their_depths() {
        let added = [(-900.0, 2e-3), (900.0, 3e-3), (1500.0, 6e-3)];
        let trials = || {
            let trial = |seed: u64| {
                let mut trial = TestContact::PLAIN.trial(seed);
                let layers =
                    |x: f64| added.iter().map(|(stiffness, depth)| stiffness * (x - depth).max(0.0)).sum::<f64>();
                let more: Vec<f64> = trial.position.iter().map(|x| layers(*x)).collect();
                trial.force.iter_mut().zip(more).for_each(|(force, more)| *force += more);
                trial
            };
            [1, 2].map(trial).to_vec()
        };
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        let model = &outcome.chosen.model;
        assert_eq!(model.names(0), ["layered_stiffness"], "{:?}", model.terms);
        // What lets it fall is not told by where it does.
        assert_eq!(outcome.verdict, Verdict::PartlyExplained);
        let start = model.first_value_of(0);
        let mut depths: Vec<f64> = outcome.chosen.values[start..].iter().skip(1).step_by(2).copied().collect();
        depths.sort_by(f64::total_cmp);
        // 20 mN of noise over changes of 900 N/m are 20 um at one row, and there are hundreds; a tenth of a millimetre is a wrong corner.
        for (_, depth) in added {
            assert!(depths.iter().any(|found| (found - depth).abs() < 1e-4), "{depth} is not among {depths:?}");
        }
    }
}
