//! The rig file with what was found of the contact.

use super::channel;
use crate::diagnose::contact::fit::Fit;
use crate::diagnose::contact::learned::Learned;
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::verdict::Verdict;
use crate::effects::{self, PARASITIC_FORCE, Place};
use crate::rig::{Contact, Rig};

/// The rig `given` with what was found of the contact: refitted values and every effect of the law.
#[must_use]
pub fn refined(given: &Rig, outcome: &Outcome) -> Rig {
    let named = if outcome.named.is_empty() { &outcome.nominal } else { &outcome.chosen };
    let fit = outcome.learned.as_ref().map_or(named, Learned::fit);
    let ends = match &outcome.learned {
        Some(curve) => Some(curve.intervals(&outcome.intervals)),
        None => (!outcome.named.is_empty()).then(|| outcome.intervals.clone()),
    };
    let ends = ends.map(|ends| channel::all_told(&fit.values, &ends));
    let mut rig = with_law(given, fit, outcome, ends.as_deref());
    if outcome.verdict == Verdict::NoMismatch {
        rig.contact = given.contact;
    }
    rig
}

/// The `improved` rig with each law that the recordings do not tell from the answer's in the place of it.
#[must_use]
pub fn alternative_rigs(improved: &Rig, outcome: &Outcome) -> Vec<Rig> {
    outcome.alternatives.iter().map(|other| with_law(improved, &other.fit, outcome, None)).collect()
}

/// The rig `given` with the law `fit` of the contact of `outcome`, the `intervals` of its values, and the force of free motion where there is one.
fn with_law(given: &Rig, Fit { model, values, .. }: &Fit, outcome: &Outcome, intervals: Option<&[[f64; 2]]>) -> Rig {
    let mut rig = given.clone();
    rig.contact = given.contact.map(|contact| Contact {
        stiffness: values[index::STIFFNESS],
        damping: values[index::DAMPING],
        surface: values[index::SURFACE],
        ..contact
    });
    rig.effects.retain(|table| effects::find(&table.name).is_some_and(|e| e.spec().place == Place::Drive));
    let mut next = model.nominal_count();
    for term in &model.terms {
        let own = next..next + term.parameters().len();
        next += term.all_parameters(outcome.trials.len()).len();
        let ends: Option<Vec<(f64, f64)>> =
            intervals.map(|all| all[own.clone()].iter().map(|ends| (ends[0], ends[1])).collect());
        rig.effects.push(effects::to_table(term.effect, term.form, given.coordinate, &values[own], ends.as_deref()));
    }
    if let Some(force) = &outcome.parasitic {
        let (form, values) = force.element();
        rig.effects.push(effects::to_table(PARASITIC_FORCE, form, given.coordinate, &values, None));
    }
    rig
}
