//! Where a spring's force falls on the way in: as over a click, or where a column buckles.

use super::criteria::LEAST_FALL;
use super::model::{ContactModel, index};
use super::prediction::active;
use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
use crate::effects::{Place, Stage};
use crate::rig::Contact;

/// Points of the way that it is looked at in.
const PATH_POINTS: usize = 60;

/// A force that falls on the way in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fall {
    /// And goes on falling, or stays low, as far in as the tool went.
    ToTheEnd,
    /// And rises again: a pocket.
    Pocket,
}

/// The largest fall along `path`, if it is more than `least`: a pocket where the force rises again by as much.
fn fall_along(path: &[f64], least: f64) -> Option<Fall> {
    let (mut highest, mut most, mut bottom) = (f64::NEG_INFINITY, 0.0, 0);
    for (at, force) in path.iter().enumerate() {
        highest = force.max(highest);
        if highest - force > most {
            (most, bottom) = (highest - force, at);
        }
    }
    let rises = path[bottom..].iter().any(|force| force - path[bottom] > least);
    (most > least).then_some(if rises { Fall::Pocket } else { Fall::ToTheEnd })
}

impl ContactModel {
    /// How the spring's force falls on the way in, where it does by more than a fiftieth of its range: as over a click, or where a column
    /// buckles. A spring that hardens, softens or lies on another does not.
    #[must_use]
    pub fn fall(&self, values: &[f64]) -> Option<Fall> {
        let all = self.acting(Place::Contact, values, 0);
        let held: Vec<ActiveEffect<'_>> =
            all.iter().map(active).filter(|active| active.stage() == Stage::Law).collect();
        if held.is_empty() {
            return None;
        }
        let contact =
            Contact { surface: 0.0, stiffness: values[index::STIFFNESS], damping: 0.0, bilateral: self.bilateral };
        let mut law = ContactSimulator::new(contact, &held);
        let depth = self.deepest(values);
        let path: Vec<f64> = (0..PATH_POINTS)
            .map(|point| law.step(point as f64, 1.0, depth * point as f64 / (PATH_POINTS - 1) as f64, 0.0, 0.0, 0.0))
            .collect();
        let least = LEAST_FALL * path.iter().fold(0.0f64, |most, force| most.max(*force));
        fall_along(&path, least.value())
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::TestContact;
    use super::*;

    #[test]
    fn a_spring_that_falls_on_the_way_in_is_told_from_one_that_softens_and_a_pocket_from_both() {
        // 300 N/m, by 250 N/m less from 4 mm on, and by 500 N/m less: there the force falls.
        let falls = |added: f64| {
            let (model, values) = TestContact::PLAIN.law_with("layered_stiffness", 0, &[added, 4e-3]);
            (model.fall(&values), model.may_fall())
        };
        assert_eq!(falls(-250.0), (None, false));
        assert_eq!(falls(-500.0), (Some(Fall::ToTheEnd), false));
        assert_eq!(falls(900.0), (None, false));
        let (model, values) = TestContact::PLAIN.law_with("layered_stiffness", 2, &[-500.0, 3e-3, 900.0, 5e-3]);
        assert_eq!((model.fall(&values), model.may_fall()), (Some(Fall::Pocket), true));
    }
}
