//! A force at the sensor that is not the contact's: it is there in free motion, too, and goes with the place or with the speed.
//!
//! A cable or a hose that is bent along the way, or water around the tool, acts before anything is touched, where no law of a contact has a force. In the contact it goes
//! on, and layers, a damper or a zero of the sensor are fitted to it. It is found where no contact is, taken off the force everywhere, and believed where what is found
//! then is likelier than what was found with it, by the price of all values (G. Schwarz, *Ann. Stat.* 6, 1978, 461).

use super::criteria::LEAST_GAIN;
use super::crosstalk::directions;
use super::data::Data;
use super::fit::{Effort, Fit};
use super::free_rows::FreeRows;
use super::held_out::Folds;
use super::nominal::{NominalContact, nominal_fit};
use super::rest::Rest;
use super::search::Search;
use super::trial::ContactTrial;
use crate::diagnose::linalg::solve;
use crate::effects::{PARASITIC_BY_PLACE, PARASITIC_BY_SPEED, parasitic_powers};

/// On what a parasitic force depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// The position, as of a cable that is bent along the way.
    Place,
    /// The velocity, as of water around the tool.
    Velocity,
}

/// A parasitic force: `zero + sum_i parts_i b_i`, with `b = q, q^2, q^3` of `q = (x - origin) / unit`, or `b = q, q |q|` of `q = v / unit`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParasiticForce {
    /// On what it depends.
    pub along: Along,
    /// Position at which `q` is zero, m or rad.
    pub origin: f64,
    /// Length or speed at which `q` is one.
    pub unit: f64,
    /// What it is at the origin, N or N m; zero where it goes with the velocity.
    pub zero: f64,
    /// N or N m, of each power of `q`.
    pub parts: Vec<f64>,
}

/// Share of the free motion, that nearest to the surface, in which none is looked for: where the nominal law puts the surface may be far in the contact.
const FAR: f64 = 0.5;

/// The same, once the force is taken off and the surface lies where the contact begins.
const NEAR: f64 = 0.1;

/// Rounds in which surface and force follow each other. The third changed no force by a hundredth.
const ROUNDS: usize = 3;

impl ParasiticForce {
    /// The force that free motion shows beside one of `laws` of `data`, the likeliest; `None` where none is beyond chance there.
    #[must_use]
    pub fn found(data: &Data<'_>, laws: [&Fit; 2], rig: &NominalContact) -> Option<Self> {
        let forces = laws.into_iter().filter_map(|law| FreeRows::of(data, law, FAR)).flat_map(|free| free.forces());
        let likeliest = forces.max_by(|a, b| a.1.total_cmp(&b.1));
        let (mut force, _) = likeliest.filter(|(_, gain)| *gain > LEAST_GAIN)?;
        for _ in 0..ROUNDS {
            let without = nominal_fit(&Data::new(&force.taken_off(data.trials)), rig);
            let near = FreeRows::of(&Data::new(data.trials), &without, NEAR).into_iter().flat_map(|free| free.forces());
            let alike = near.filter(|(other, _)| other.along == force.along).max_by(|a, b| a.1.total_cmp(&b.1));
            force = alike.map_or(force, |(other, _)| other);
        }
        Some(force)
    }

    /// What it adds at `position` and `velocity`, N or N m.
    #[must_use]
    pub fn at(&self, position: f64, velocity: f64) -> f64 {
        let powers = self.basis(position, velocity);
        self.zero + self.parts.iter().zip(powers).map(|(part, power)| part * power).sum::<f64>()
    }

    pub(super) fn basis(&self, position: f64, velocity: f64) -> [f64; 3] {
        match self.along {
            Along::Place => parasitic_powers(PARASITIC_BY_PLACE, (position - self.origin) / self.unit),
            Along::Velocity => parasitic_powers(PARASITIC_BY_SPEED, velocity / self.unit),
        }
    }

    /// The form of the element of a rig file that it is, and its values.
    #[must_use]
    pub fn element(&self) -> (usize, Vec<f64>) {
        let part = |nth: usize| self.parts.get(nth).copied().unwrap_or(0.0);
        match self.along {
            Along::Place => (PARASITIC_BY_PLACE, vec![self.origin, self.unit, self.zero, part(0), part(1), part(2)]),
            Along::Velocity => (PARASITIC_BY_SPEED, vec![self.unit, part(0), part(1)]),
        }
    }

    /// In each row of `data`, which is without it: the force that all rows give less that which the other half of the rows gives beside the law `fit`, N or N m, a
    /// column a trial.
    #[must_use]
    pub(super) fn unseen(&self, data: &Data<'_>, fit: &Fit, folds: &Folds) -> Vec<Vec<f64>> {
        let moved = [0, 1].map(|half| self.moved_by(&folds.masked(data, half), fit));
        let is_first = folds.is_first();
        let of_trial = |(trial, start): (&ContactTrial, &usize)| -> Vec<f64> {
            let motion = trial.position.iter().zip(&trial.velocity).zip(&is_first[*start..]);
            let less = motion.map(|((position, velocity), is_first)| {
                let powers = self.basis(*position, *velocity);
                -moved[usize::from(*is_first)].iter().zip(powers).map(|(part, power)| part * power).sum::<f64>()
            });
            less.collect()
        };
        data.trials.iter().zip(&data.starts()).map(of_trial).collect()
    }

    /// By how much the rows of `data`, which are without it, move its parts beside the law `fit`; not at all where they tell none.
    fn moved_by(&self, data: &Data<'_>, fit: &Fit) -> Vec<f64> {
        let left = data.weighted_residual(&fit.model, &fit.values);
        let beside = directions(data, fit, &left);
        let others = beside.len();
        let columns: Vec<(usize, Vec<f64>)> = beside.into_iter().chain(self.columns(data)).enumerate().collect();
        let found = solve(&columns, &left);
        found.map_or_else(|| vec![0.0; self.parts.len()], |found| found.iter().skip(others).copied().collect())
    }

    /// What each of its parts is multiplied with in each row of `data`, weighted, trial after trial.
    fn columns(&self, data: &Data<'_>) -> impl Iterator<Item = Vec<f64>> {
        let powers = move |at: usize| -> Vec<f64> {
            let rows = data.trials.iter().zip(&data.weights);
            let weighted = rows.flat_map(|(trial, weights)| {
                let motion = trial.position.iter().zip(&trial.velocity).zip(weights);
                motion.map(move |((position, velocity), weight)| weight * self.basis(*position, *velocity)[at])
            });
            weighted.collect()
        };
        (0..self.parts.len()).map(powers)
    }

    /// What it adds in each row of `trial`.
    #[must_use]
    pub fn of(&self, trial: &ContactTrial) -> Vec<f64> {
        let motion = trial.position.iter().zip(&trial.velocity);
        motion.map(|(position, velocity)| self.at(*position, *velocity)).collect()
    }

    /// `trials` without it.
    #[must_use]
    pub fn taken_off(&self, trials: &[ContactTrial]) -> Vec<ContactTrial> {
        let without = |trial: &ContactTrial| {
            let force = trial.force.iter().zip(self.of(trial)).map(|(force, added)| force - added).collect();
            ContactTrial { force, ..trial.clone() }
        };
        trials.iter().map(without).collect()
    }

    /// It, fitted to all rows of `trials`, which hold it, beside the nominal law of a `search` without it; `None` where `chosen` has no effects, or with
    /// them is likelier beside this one by more than [`LEAST_GAIN`]: otherwise they are not needed.
    #[must_use]
    pub(super) fn in_place_of_effects(
        &self,
        search: &Search<'_>,
        chosen: &Fit,
        trials: &[ContactTrial],
    ) -> Option<Self> {
        let nominal = &search.nominal;
        if chosen.model == nominal.model {
            return None;
        }
        let moved =
            self.parts.iter().zip(self.moved_by(&search.data, nominal)).map(|(part, more)| part + more).collect();
        let other = Self { parts: moved, ..self.clone() };
        let rest = Rest::of(&search.data, chosen);
        let alone = search.data.of(&other.taken_off(trials)).fit(&nominal.model, &nominal.values, Effort::FULL);
        (search.price(&alone, &rest) < search.price(chosen, &rest) + LEAST_GAIN.value()).then_some(other)
    }

    /// Whether it and `beside`, a law that `search` found without it, are likelier than the law `alone` of `trials` that hold it.
    #[must_use]
    pub(super) fn is_likelier(&self, search: &Search<'_>, beside: &Fit, trials: &[ContactTrial], alone: &Fit) -> bool {
        let rest = Rest::of(&search.data, beside);
        let alone = search.data.of(trials).fit(&alone.model, &alone.values, Effort::FULL);
        let own = (self.parts.len() + usize::from(self.along == Along::Place)) as f64;
        search.price(beside, &rest) + own * search.price_of_value(&rest) + LEAST_GAIN < search.price(&alone, &rest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::outcome::Outcome;
    use super::super::testing::TestContact;
    use super::*;
    use crate::diagnose::linalg::energy;
    use crate::diagnose::verdict::Verdict;
    use crate::effects::{Effect as _, PARASITIC_FORCE, Reading};

    /// What is found where `force` acts beside `contact`, as a function of position and velocity.
    fn found(contact: &TestContact, force: impl Fn(f64, f64) -> f64) -> Outcome {
        let trials = || [1, 2].map(|seed| contact.trial_beside(seed, &force)).to_vec();
        identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap()
    }

    fn names(outcome: &Outcome) -> Vec<&'static str> {
        outcome.chosen.model.names(outcome.known_terms)
    }

    /// Water around the tool, and a cable that pulls along the way: no layers and no damper.
    #[test]
    fn a_force_of_free_motion_is_no_effect_of_the_contact() {
        let water = found(&TestContact::PLAIN, |_, velocity| 300.0 * velocity * velocity.abs());
        assert_eq!((names(&water), water.verdict), (vec![], Verdict::Unknown));
        let force = water.parasitic.expect("it goes with the speed");
        assert_eq!(force.along, Along::Velocity);
        // At 20 mm/s, twice as fast as the free motion of which it is known: to a quarter of the noise of a row.
        let slow = force.at(0.0, 0.02);
        assert!((slow - 300.0 * 0.02f64.powi(2)).abs() < 5e-3, "{slow} N");
        // What is left holds it by the refitted nominal law, and by the answer does not: free motion alone has 40 mN of it in root mean square.
        let [_, refitted, improved] = [0, 1, 2].map(|law| energy(&water.residuals[law].concat()));
        assert!(improved < 0.5 * refitted, "{improved} {refitted}");
        let cable = found(&TestContact::PLAIN, |position, _| 120.0 * (position + 2e-3));
        assert_eq!((names(&cable), cable.verdict), (vec![], Verdict::Unknown));
        let force = cable.parasitic.expect("it goes with the place");
        let along = force.at(4e-3, 0.0) - force.at(-1e-3, 0.0);
        assert!(force.along == Along::Place && (along - 0.6).abs() < 0.05, "{along} N");
    }

    /// The force of both forms, and that of the element that the rig file holds of it.
    #[test]
    fn the_element_of_a_rig_file_is_the_same_force() {
        let place = ParasiticForce { along: Along::Place, origin: 1e-3, unit: 2e-3, zero: 0.3, parts: vec![0.2, -0.1] };
        let speed = ParasiticForce { along: Along::Velocity, zero: 0.0, parts: vec![0.4, 0.5], ..place.clone() };
        let [position, velocity, at_rest] = [[4e-3, -1e-3], [1e-3, -5e-3], [0.0; 2]];
        for force in [place, speed] {
            let (form, values) = force.element();
            let mut shown = [0.0; 2];
            let mut reading = Reading {
                start: 0.0,
                step: 1e-3,
                filter_width: 0.0,
                position: &position,
                velocity: &velocity,
                acceleration: &at_rest,
                force: &mut shown,
            };
            PARASITIC_FORCE.act_on_reading(form, &values, &mut reading);
            for (at, shown) in shown.into_iter().enumerate() {
                assert!((shown - force.at(position[at], velocity[at])).abs() < 1e-15, "{force:?}");
            }
        }
    }

    /// Of a spring that stiffens, whose surface the nominal law puts far in the contact, nothing of free motion is told.
    #[test]
    fn a_contact_before_the_nominal_surface_is_no_force_of_free_motion() {
        let stiffens = TestContact { exponent: 1.5, ..TestContact::PLAIN };
        let alone = found(&stiffens, |_, _| 0.0);
        assert_eq!((names(&alone), alone.verdict), (vec!["nonlinear_stiffness"], Verdict::Explained));
        assert_eq!(alone.parasitic, None);
    }
}
