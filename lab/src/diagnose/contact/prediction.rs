//! What the force sensor shows along a motion by a contact's law.

use super::model::{ContactModel, index};
use super::trial::ContactTrial;
use crate::diagnose::term::Term;
use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
use crate::effects::{Place, Reading};
use crate::rig::Contact;

impl ContactModel {
    /// Force that the sensor shows along `trial`, whose number is `number`.
    #[must_use]
    pub fn predicted(&self, values: &[f64], trial: &ContactTrial, number: usize) -> Vec<f64> {
        let contact = Contact {
            surface: self.surface(values, number),
            stiffness: values[index::STIFFNESS],
            damping: values[index::DAMPING],
            bilateral: self.bilateral,
        };
        let held = self.acting(Place::Contact, values, number);
        let actives: Vec<ActiveEffect<'_>> = held.iter().map(active).collect();
        let mut law = ContactSimulator::new(contact, &actives);
        let scale = self.scale(values, number);
        let mut before = trial.time.first().copied().unwrap_or(0.0);
        let mut force: Vec<f64> = (0..trial.len())
            .map(|row| {
                let step = trial.time[row] - before;
                before = trial.time[row];
                let (position, velocity) = (trial.position[row], trial.velocity[row]);
                scale * law.step(trial.time[row], step, position, velocity, trial.acceleration[row], 0.0)
            })
            .collect();
        self.sense(values, trial, number, &mut force);
        force
    }

    /// What the sensor makes of the force on the tool.
    fn sense(&self, values: &[f64], trial: &ContactTrial, number: usize, force: &mut [f64]) {
        shift(force, values[index::TIMING], trial.step_s);
        let mut sensors = self.acting(Place::Sensor, values, number);
        sensors.sort_by_key(|held| held.0.effect.spec().stage);
        // A row that is a mean has passed a window, which is narrower than what any effect of the sensor tells.
        let width = if trial.step_s > 1.5 * trial.source_step_s { trial.step_s / 12f64.sqrt() } else { 0.0 };
        for (term, own) in &sensors {
            let mut reading = Reading {
                start: trial.time.first().copied().unwrap_or(0.0),
                step: trial.step_s,
                filter_width: width,
                position: &trial.position,
                velocity: &trial.velocity,
                acceleration: &trial.acceleration,
                force,
            };
            term.effect.act_on_reading(term.form, own, &mut reading);
        }
        let zero = self.force_zero + self.zero(values, number);
        force.iter_mut().for_each(|force| *force += zero);
    }

    pub(super) fn acting(&self, place: Place, values: &[f64], trial: usize) -> Vec<(Term, Vec<f64>)> {
        let terms = self.terms.iter().enumerate().filter(|(_, term)| term.effect.spec().place == place);
        terms
            .map(|(at, term)| {
                let start = self.first_value_of(at);
                (*term, term.in_trial(&values[start..start + self.count_of(term)], trial))
            })
            .collect()
    }
}

pub(super) fn active(held: &(Term, Vec<f64>)) -> ActiveEffect<'_> {
    ActiveEffect { effect: held.0.effect, form: held.0.form, values: &held.1 }
}

/// `force` later by `late`, which is a part of a row: its first order is all of it.
fn shift(force: &mut [f64], late: f64, step: f64) {
    if late == 0.0 || force.len() < 2 {
        return;
    }
    let part = 0.5 * late / step;
    let mut before = force[0];
    for row in 0..force.len() {
        let here = force[row];
        let after = force.get(row + 1).copied().unwrap_or(here);
        force[row] = here - part * (after - before);
        before = here;
    }
}
