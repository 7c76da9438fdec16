//! Which terms the recordings ask for: sets grown from the best few, and pruned.

use super::candidates::{is_likelier, stribeck_for};
use super::criteria::{LEAST_GAIN_PER_VALUE, LEAST_PART_OF_EFFORT, LINK_PART, NEGLIGIBLE_PART};
use super::filter::innovations;
use super::fit::{Effort, Fit, fit};
use super::law::Side;
use super::likelihood::Data;
use super::links;
use super::model::index;
use super::ripples::are_resolved;
use super::scales::Scales;
use super::term::Term;
use crate::diagnose::so_far::so_far;

/// What a search works on.
pub struct Search<'a> {
    /// The trials.
    pub data: Data<'a>,
    /// Sizes of the recordings.
    pub scales: Scales,
    /// The nominal law, refitted.
    pub nominal: Fit,
    /// Band in which unexplained forces are compared, Hz.
    pub band_hz: f64,
    /// Sides of a transmission on which the encoder may sit.
    pub sides: Vec<Side>,
    /// Whether terms are looked for however little of the effort is unexplained.
    pub is_asked: bool,
    /// Density of the white noise that is recorded with the effort, N^2 s.
    pub effort_noise_density: f64,
}

/// What was chosen, and the sets that it was chosen from.
pub struct Chosen {
    /// The model with its terms.
    pub fit: Fit,
    /// Every set that was fitted in full.
    pub sets: Vec<Fit>,
}

/// Sets that each round grows from.
const BEAM: usize = 2;

/// Terms at most.
const MOST_TERMS: usize = 4;

/// Links are looked for beside this many models.
const LINK_SEARCHES: usize = 2;

impl Search<'_> {
    /// Smoothed disturbance of `fit`, a column a trial.
    #[must_use]
    pub fn disturbance(&self, fit: &Fit) -> Vec<Vec<f64>> {
        let law = fit.model.law(&fit.values);
        let smoothed = |trial| innovations(trial, &law, &fit.noise, true).disturbance;
        self.data.trials.iter().map(smoothed).collect()
    }

    /// Runs the search, telling `say` how it goes.
    #[must_use]
    pub fn run(&self, say: &dyn Fn(&str)) -> Chosen {
        let mut best = self.nominal.clone();
        let mut beam = vec![best.clone()];
        let mut sets = Vec::new();
        let mut link_searches = 0;
        let mut is_waiting = false;
        let is_negligible = !self.is_asked && self.unexplained(&best) < LEAST_PART_OF_EFFORT * self.scales.effort;
        for _ in 0..if is_negligible { 0 } else { MOST_TERMS } {
            say(&format!("the drive: {}; one term more", self.so_far(&best)));
            let mut grown = self.grown(&beam, &best);
            let rigid = beam.iter().find(|fit| !fit.model.has_link()).filter(|_| !best.model.has_link());
            if let Some(rigid) = rigid
                && link_searches < LINK_SEARCHES
                && self.leaves_much(&grown, &best)
            {
                say(&format!("the drive: {}; two bodies", self.so_far(&best)));
                link_searches += 1;
                let found = links::found(&self.data, rigid, &self.disturbance(rigid), &self.sides);
                let likeliest = grown.iter().map(|fit| fit.log_likelihood).fold(f64::NEG_INFINITY, f64::max);
                grown.extend(found.iter().map(|fit| self.within_ends(self.polished_link(fit, likeliest), rigid)));
            }
            grown.retain(|fit| !is_at_end(fit) && !hurries(fit, &self.nominal) && are_resolved(fit));
            let grown = distinct(grown);
            sets.extend(grown.iter().cloned());
            let price = |fit: &Fit| fit.log_likelihood - LEAST_GAIN_PER_VALUE.value() * fit.values.len() as f64;
            let worthy: Vec<&Fit> = grown.iter().filter(|fit| self.is_worth(fit, &best)).collect();
            // A link follows what the encoder shows row by row, and is likely by that alone; where a rigid law takes far more of the force it is none.
            let is_outdone = |fit: &Fit| {
                let mut rigid = worthy.iter().filter(|other| !other.model.has_link());
                fit.model.has_link() && rigid.any(|other| self.leaves_far_more(fit, other))
            };
            match worthy.iter().copied().filter(|fit| !is_outdone(fit)).max_by(|a, b| price(a).total_cmp(&price(b))) {
                Some(top) => (best, is_waiting) = (top.clone(), false),
                // Two terms can be worth it where neither is alone: a link hides friction, and friction a link.
                None if !is_waiting && grown.iter().any(|fit| is_likelier(fit, &best)) => is_waiting = true,
                None => break,
            }
            let is_answer = |fit: &Fit| is_waiting || !self.leaves_far_more(fit, &best);
            let answers = grown.into_iter().filter(is_answer).collect();
            beam = next_beam(answers, &best, is_waiting);
            if self.unexplained(&best) < NEGLIGIBLE_PART * self.unexplained(&self.nominal) {
                break;
            }
        }
        say(&format!("the drive: {}; without each term", self.so_far(&best)));
        let best = self.creeping(best, &mut sets);
        let best = self.with_order_lines(best, &mut sets);
        let fit = self.believed(self.pruned(best), &sets);
        Chosen { fit, sets: distinct(sets) }
    }

    /// What `best` has beyond the nominal law, and what it leaves.
    fn so_far(&self, best: &Fit) -> String {
        let own = self.nominal.model.terms.len();
        let names: Vec<&str> =
            best.model.terms.iter().skip(own).filter(|term| term.is_told()).map(Term::name).collect();
        so_far(&names, self.unexplained(best) / self.unexplained(&self.nominal))
    }

    /// The terms of `law`, which was found on other trials, with the values that these teach.
    #[must_use]
    pub fn fitted(&self, law: &Fit) -> Chosen {
        let mut start = law.clone();
        start.model.scales = self.scales;
        let fit = self.pruned(self.polished(&start));
        Chosen { fit, sets: Vec::new() }
    }

    /// Whether `best`, and each of `grown` that speaks against a link, leaves so much that one is looked for. A law that is not worth it does not
    /// speak, but where the nominal law leaves more than the whole effort: there no rigid law is worth it, and a link can always follow the rows.
    fn leaves_much(&self, grown: &[Fit], best: &Fit) -> bool {
        let nominal = self.unexplained(&self.nominal);
        let is_moved_otherwise = nominal > self.scales.effort;
        let leaves_little = |fit: &Fit| self.unexplained(fit) <= LINK_PART * nominal;
        let speaks = |fit: &Fit| !is_at_end(fit) && (is_moved_otherwise || self.is_worth(fit, best));
        !leaves_little(best) && !grown.iter().any(|fit| leaves_little(fit) && speaks(fit))
    }

    /// `best`, or the likeliest of `sets` that is worth its terms where the inertia of `best` is not believed or a value ended where its
    /// search did; else no term.
    fn believed(&self, best: Fit, sets: &[Fit]) -> Fit {
        if best.model == self.nominal.model || is_believed(&best) {
            return best;
        }
        let others = sets.iter().filter(|fit| is_believed(fit) && self.is_worth(fit, &self.nominal));
        let likeliest = others.max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
        // What is left of it is worth it, too: not what stays for the inertia alone.
        let pruned = likeliest.map(|fit| self.pruned(fit.clone())).filter(|fit| self.is_worth(fit, &self.nominal));
        pruned.unwrap_or_else(|| self.nominal.clone())
    }

    /// `start` fitted in full.
    #[must_use]
    pub fn polished(&self, start: &Fit) -> Fit {
        let effort = if start.model.has_link() { Effort::LINKED } else { Effort::FULL };
        fit(&self.data, &start.model, &start.values, start.noise, effort)
    }

    /// The same of a link that was looked for on a stretch; a play is looked for around where that ends, too: all rows hold more strikes than the stretch,
    /// and one that is wrong by less than a row on the stretch can be the unlikeliest of all laws on the rest. One that is seen from its load is so if it is likelier than
    /// the `likeliest` rigid law: beyond flanks that are soft enough the load goes its own way, and follows any rows.
    fn polished_link(&self, start: &Fit, likeliest: f64) -> Fit {
        let fit = self.polished(start);
        let goes_its_way = fit.model.terms.contains(&Term::Play(Side::Load)) && fit.log_likelihood < likeliest;
        if !fit.model.has("backlash") || goes_its_way {
            return fit;
        }
        let around = self.polished(&links::likelier_around(&self.data, &links::roused(&fit, &self.nominal)));
        if around.log_likelihood > fit.log_likelihood { around } else { fit }
    }

    /// `best`, or the same with friction that is larger when creeping, which other terms can have hidden when it was tried.
    fn creeping(&self, best: Fit, sets: &mut Vec<Fit>) -> Fit {
        let has_others = best.model.told_terms() > self.nominal.model.told_terms() + 1;
        let coulomb = best.model.terms.iter().position(|term| *term == Term::Coulomb);
        let Some(at) = coulomb.filter(|_| has_others && !best.model.has_link()) else { return best };
        if best.model.has("sublinear_friction") || self.unexplained(&best) < LEAST_PART_OF_EFFORT * self.scales.effort {
            return best;
        }
        let tried =
            stribeck_for(&best, at).map(|(model, values)| fit(&self.data, &model, &values, best.noise, Effort::QUICK));
        let likeliest = tried.into_iter().max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
        let polished = likeliest.map(|fit| self.polished(&fit)).filter(|fit| !is_at_end(fit));
        sets.extend(polished.clone());
        polished.filter(|fit| self.is_worth(fit, &best)).unwrap_or(best)
    }
}

/// Whether the inertia of `fit` is believed and no value ended where its search did.
#[must_use]
pub fn is_believed(fit: &Fit) -> bool {
    fit.model.has_believed_inertia(&fit.values) && !is_at_end(fit)
}

/// Whether a value of `fit` ended where its search did.
#[must_use]
pub fn is_at_end(fit: &Fit) -> bool {
    fit.model.is_at_end(&fit.values)
}

/// What the next round grows from: the likeliest of `grown`, and what must not be crowded out.
fn next_beam(grown: Vec<Fit>, best: &Fit, is_waiting: bool) -> Vec<Fit> {
    let is_in = |beam: &[Fit], set: &Fit| beam.iter().any(|fit| fit.model == set.model);
    // Friction hides a link's own gain: it is tried beside the likeliest link before that is given up.
    let link = grown.iter().find(|fit| is_waiting && fit.model.has_link()).cloned();
    let mut beam: Vec<Fit> = grown.into_iter().take(BEAM).collect();
    if is_waiting {
        beam.extend(link.filter(|link| !is_in(&beam, link)));
    } else if !is_in(&beam, best) {
        // What was chosen stays, however likely sets are that were not worth it.
        beam.truncate(BEAM - 1);
        beam.push(best.clone());
    }
    beam
}

/// The sets, the likeliest first, each set of names once.
fn distinct(mut fits: Vec<Fit>) -> Vec<Fit> {
    fits.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    let mut kept: Vec<Fit> = Vec::new();
    for fit in fits {
        let names = fit.model.names();
        if kept.iter().all(|other| other.model.names() != names) {
            kept.push(fit);
        }
    }
    kept
}

/// Whether `fit` has a link that wants the effort as early as a search allows, where the `nominal` law does not: the effort of no drive acts a whole
/// row before it is recorded, so that is no motion of two bodies.
fn hurries(fit: &Fit, nominal: &Fit) -> bool {
    let is_earliest = |fit: &Fit| {
        let (range, delay) = (fit.model.ranges()[index::DELAY], fit.values[index::DELAY]);
        range.steps_between(range.low, delay) < 1e-9
    };
    fit.model.has_link() && is_earliest(fit) && !is_earliest(nominal)
}

#[cfg(test)]
mod tests {
    use super::super::levenberg_marquardt::Ended;
    use super::super::model::Model;
    use super::super::noise::Noise;
    use super::super::testing::{SCALES, TestDrive, search_over, with_dry_friction};
    use super::*;

    #[test]
    fn a_link_that_needs_an_effort_a_row_before_it_is_recorded_is_not_believed() {
        let fit = |terms: Vec<Term>, delay: f64, own: &[f64]| Fit {
            model: Model { terms, scales: SCALES },
            values: [&[0.8, 4.0, delay, 0.0], own].concat(),
            noise: Noise { ln_disturbance: -8.0, ln_encoder: -20.0 },
            log_likelihood: 0.0,
            ended: Ended::Converged,
        };
        let rigid = |delay: f64| fit(vec![], delay, &[]);
        let linked = |delay: f64| fit(vec![Term::Compliance(Side::Load)], delay, &[4e3, 2.0, 0.5, 0.0]);
        let earliest = -SCALES.period_s;
        assert!(hurries(&linked(earliest), &rigid(0.0)));
        assert!(!hurries(&linked(0.5 * earliest), &rigid(0.0)));
        // Where the nominal law needs that as well, the record is early; and a rigid law has no more to explain it by.
        assert!(!hurries(&linked(earliest), &rigid(earliest)) && !hurries(&rigid(earliest), &rigid(0.0)));
    }

    /// Dry friction that leaves nothing is all there is; the same with half of the inertia, which the rows speak against, is no reason not to look for a link.
    #[test]
    fn a_law_that_is_not_worth_it_does_not_speak_against_a_link() {
        let drive = TestDrive { coulomb: 0.4, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 6)];
        let search = search_over(&trials, &drive);
        let right = with_dry_friction(&search);
        let mut wrong = right.clone();
        wrong.values[index::INERTIA] *= 0.5;
        wrong.log_likelihood = search.data.log_likelihood(&wrong.model, &wrong.values, &wrong.noise).0;
        assert!(search.unexplained(&wrong) < 0.1 * search.unexplained(&search.nominal));
        assert!(!search.leaves_much(&[right], &search.nominal));
        assert!(search.leaves_much(&[wrong], &search.nominal));
    }
}
