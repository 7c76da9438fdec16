//! The law that a rig file states of its contact, and its refitted values.

use super::data::Data;
use super::fit::{Effort, Fit};
use super::model::{ContactModel, OwnValues, index};
use super::scales::Scales;
use super::trial::ContactTrial;
use crate::diagnose::term::Term;
use crate::effects::{Place, Resolved};
use crate::rig::Contact;

/// What a rig file says of a contact.
#[derive(Clone)]
pub struct NominalContact {
    /// Spring, damper and surface.
    pub contact: Contact,
    /// Reading of the sensor without a force.
    pub force_zero: f64,
    /// Whether positions are angles.
    pub is_rotary: bool,
    /// Effects that it already holds: nominal, and refitted like the other values.
    pub effects: Vec<Resolved>,
}

/// The law that `rig` states, with the values that it gives.
#[must_use]
pub fn law_of(trials: &[ContactTrial], rig: &NominalContact) -> (ContactModel, Vec<f64>) {
    let contact = rig.contact;
    let held = || rig.effects.iter().filter(|effect| effect.effect.spec().place != Place::Drive);
    let model = ContactModel {
        bilateral: contact.bilateral,
        force_zero: rig.force_zero,
        trials: trials.len(),
        own: OwnValues::NONE,
        terms: held().map(|effect| Term { effect: effect.effect, form: effect.form }).collect(),
        scales: Scales::of(trials, contact.surface, contact.bilateral, contact.stiffness, rig.is_rotary),
    };
    let mut values = vec![0.0; model.nominal_count()];
    values[index::STIFFNESS] = contact.stiffness;
    values[index::DAMPING] = contact.damping;
    values[index::SURFACE] = contact.surface;
    for (effect, term) in held().zip(&model.terms) {
        values.extend(term.spread(&effect.values, model.trials));
    }
    (model, values)
}

/// Surfaces that the nominal fit starts from, of the travel above its least position: a rig file can be far off.
const SURFACE_STARTS: [f64; 4] = [0.1, 0.35, 0.6, 0.85];

/// The law that `rig` states, its values refitted.
#[must_use]
pub fn nominal_fit(data: &Data<'_>, rig: &NominalContact) -> Fit {
    let (model, start) = law_of(data.trials, rig);
    let model = &model;
    let mut best = data.fit(model, &start, Effort::FULL);
    if !model.bilateral {
        for part in SURFACE_STARTS {
            let mut moved = start.clone();
            moved[index::SURFACE] = model.scales.positions[0] + part * model.scales.travel();
            let fit = data.fit(model, &moved, Effort::QUICK);
            if fit.energy < 0.9 * best.energy {
                let fit = data.fit(model, &fit.values, Effort::FULL);
                if fit.energy < best.energy {
                    best = fit;
                }
            }
        }
    }
    best
}
