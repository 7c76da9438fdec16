//! Which effects the recordings ask for: sets grown from the best few, exchanged and pruned.

use rayon::prelude::*;

use super::criteria::{LEAST_GAIN, LEAST_SHARE, NOISE_POWER_KNOWN_TO};
use super::fit::Fit;
use super::growth::distinct;
use super::rest::Rest;
use super::search::{MOST_TERMS, Search};
use crate::diagnose::linalg::energy;
use crate::diagnose::so_far::so_far;

/// What was chosen, and the sets that it was chosen from.
pub struct Chosen {
    /// The law with its effects.
    pub fit: Fit,
    /// Every set that was fitted in full.
    pub sets: Vec<Fit>,
}

/// Sets that each round grows from.
const BEAM: usize = 4;

impl Search<'_> {
    /// Runs the search, telling `say` how it goes.
    #[must_use]
    pub fn run(&mut self, say: &dyn Fn(&str)) -> Chosen {
        let mut best = self.nominal.clone();
        let mut beam = vec![best.clone()];
        let mut sets: Vec<Fit> = Vec::new();
        let mut composed = Vec::new();
        let mut waiting = 0;
        for round in 0..=MOST_TERMS {
            say(&format!("the contact: {}; one effect more", self.so_far(&best)));
            let mut grown = if round == 0 { self.seen_layers() } else { Vec::new() };
            for base in &beam {
                let quick = self.grown(base);
                grown.extend(self.polished(quick, &best));
            }
            grown.retain(|fit| self.is_admissible(fit));
            grown.sort_by(|a, b| a.energy.total_cmp(&b.energy));
            // At one speed a memory is a loop: what it multiplies cannot be told.
            let heads = if self.circumstances.is_one_speed { 0 } else { BEAM.min(grown.len()) };
            let anew = self.composed(&grown[..heads], &mut composed);
            grown.extend(anew.into_iter().filter(|fit| self.is_admissible(fit)));
            grown.sort_by(|a, b| a.energy.total_cmp(&b.energy));
            let Some(least) = grown.first() else { break };
            let rest = Rest::of(&self.data, least);
            grown.sort_by(|a, b| self.price(a, &rest).total_cmp(&self.price(b, &rest)));
            let mut grown = distinct(grown);
            sets.extend(grown.iter().cloned());
            let top = grown.iter().find(|fit| self.is_worth(fit, &best)).cloned();
            match top {
                Some(top) => {
                    grown.retain(|fit| !self.is_no_answer(&self.data, fit, &top));
                    best = self.weigh_by(top);
                    waiting = 0;
                }
                // Two effects can be worth it where neither is alone.
                None => waiting += 1,
            }
            if waiting > 1 || self.is_at_noise(&best) {
                break;
            }
            let grown = grown.iter().filter(|fit| self.has_room(fit, 1)).take(BEAM);
            beam = grown.map(|fit| if waiting == 0 { self.data.again(fit) } else { fit.clone() }).collect();
            if waiting == 0 && self.has_room(&best, 1) && beam.iter().all(|fit| fit.model != best.model) {
                beam.truncate(BEAM - 1);
                beam.push(best.clone());
            }
        }
        say(&format!("the contact: {}; without each effect", self.so_far(&best)));
        let fit = self.pruned(best);
        let fit = self.exchanged(fit, say);
        let fit = self.weigh_by(fit);
        let fit = self.pruned(fit);
        let fit = self.in_likeliest_forms(fit);
        sets.par_iter_mut().for_each(|fit| *fit = self.data.again(fit));
        let fit = self.surviving(fit, &sets);
        // Where a simpler set takes its place, the likeliest one is an alternative to that.
        sets.push(fit.clone());
        let fit = self.simplest(fit, &sets);
        let fit = self.without_times(fit, &sets);
        let simple = fit.model.clone();
        let fit = self.refined(fit, say);
        if fit.model != simple {
            // Its weights are those of a finer law: what was found before is compared under the same.
            sets.par_iter_mut().for_each(|fit| *fit = self.data.again(fit));
        }
        let fit = self.in_fewer(fit);
        let fit = self.with_lines(fit, &mut sets);
        Chosen { fit, sets }
    }

    /// Whether an effect that took all that `best` leaves beyond the sensors' noise would have less than its share of what that noise is not known
    /// better than: of that noise as it is stated, where it is found to be no less.
    pub(super) fn is_at_noise(&self, best: &Fit) -> bool {
        let least_left = 1.0 + (LEAST_SHARE * NOISE_POWER_KNOWN_TO.value()).value();
        let factor = self.data.noise_factor;
        factor >= 1.0 && factor * best.energy < least_left * self.data.expected()
    }

    /// What `best` has beyond the nominal law, and what it leaves, both by the weights that count now.
    pub(super) fn so_far(&self, best: &Fit) -> String {
        let [best_left, all] =
            [best, &self.nominal].map(|fit| energy(&self.data.weighted_residual(&fit.model, &fit.values)));
        so_far(&best.model.names(self.nominal.model.terms.len()), (best_left / all).sqrt())
    }

    /// `best` with each effect exchanged for another that does better in its place.
    fn exchanged(&self, mut best: Fit, say: &dyn Fn(&str)) -> Fit {
        say(&format!("the contact: {}; another effect in the place of each", self.so_far(&best)));
        let first = self.nominal.model.terms.len();
        for _ in 0..2 {
            let rest = Rest::of(&self.data, &best);
            let own = self.price(&best, &rest);
            let mut better: Option<Fit> = None;
            for at in first..best.model.terms.len() {
                let less = self.without(&best, at);
                for fit in self.polished(self.grown(&less), &less) {
                    let is_open = self.is_admissible(&fit) && fit.model.terms.len() <= best.model.terms.len();
                    let price = self.price(&fit, &rest);
                    if is_open
                        && price < own - LEAST_GAIN
                        && better.as_ref().is_none_or(|b| price < self.price(b, &rest))
                    {
                        better = Some(fit);
                    }
                }
            }
            let Some(fit) = better else { break };
            best = self.pruned(fit);
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// By hand: a fifth of the 32 % to which a sensor's noise is known. Where that is found to be less than stated, nobody knows what is noise.
    #[test]
    fn no_effect_is_looked_for_whose_share_the_noise_cannot_show() {
        let trials = [TestContact::PLAIN.trial(1)];
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let [data, coarse] = [(), ()].map(|()| Data::new(&trials));
        let mut search = Search { nominal: nominal.clone(), data, coarse, circumstances: Circumstances::default() };
        let expected = search.data.expected();
        let leaving = |part: f64| Fit { energy: part * expected, ..nominal.clone() };
        let [little, more] = [1.063, 1.065].map(leaving);
        assert!(search.is_at_noise(&little) && !search.is_at_noise(&more));
        // Found to be a tenth louder in power, of which the law leaves 1.063 times as much, or 0.96 times: 1.17 and 1.06 times what is stated.
        search.data.noise_factor = 1.1;
        assert!(!search.is_at_noise(&little) && search.is_at_noise(&leaving(0.96)));
        search.data.noise_factor = 0.7;
        assert!(!search.is_at_noise(&little));
    }
}
