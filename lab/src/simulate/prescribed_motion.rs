//! A tool that is wherever the reference says, whatever it takes.

use crate::effects::{ActiveEffect, ContactSimulator};
use crate::plant::State;
use crate::rig::{Contact, Reference};

/// Instants of the contact law a row: its memories are exact between two instants for a motion that is straight there.
const STEPS_PER_ROW: f64 = 16.0;

/// Share of the reference's shortest time over which its acceleration is taken.
const DIFFERENCE_STEP_FRACTION: f64 = 1e-5;

/// A led tool and its contact.
pub struct PrescribedMotion<'a> {
    reference: Reference,
    surface: f64,
    along: Option<ContactSimulator<'a>>,
    /// Instants a row.
    steps_per_row: f64,
    time: f64,
    /// Whether the first instant has been.
    has_begun: bool,
    force: f64,
}

/// The reference's acceleration at `time`.
fn acceleration(reference: &Reference, time: f64) -> f64 {
    let swing = (std::f64::consts::TAU * reference.sine_frequency_hz).recip();
    let near = DIFFERENCE_STEP_FRACTION * reference.smoothing_s.min(swing);
    let (before, after) = ((time - near).max(0.0), time + near);
    (reference.at(after).1 - reference.at(before).1) / (after - before)
}

impl<'a> PrescribedMotion<'a> {
    /// Along `reference`, whose depths count from the surface.
    pub fn new(reference: Reference, contact: Option<Contact>, actives: &[ActiveEffect<'a>]) -> Self {
        Self {
            reference,
            surface: contact.map_or(0.0, |contact| contact.surface),
            along: contact.map(|contact| ContactSimulator::new(contact, actives)),
            steps_per_row: if actives.is_empty() { 1.0 } else { STEPS_PER_ROW },
            time: 0.0,
            has_begun: false,
            force: 0.0,
        }
    }

    /// Walks on to `until`.
    pub fn advance(&mut self, until: f64) {
        let (start, span) = (self.time, until - self.time);
        let steps = if self.has_begun { self.steps_per_row } else { 1.0 };
        for number in 1..=steps as usize {
            self.touch(start + span * (number as f64 / steps), span / steps);
        }
        (self.time, self.has_begun) = (until, true);
    }

    /// Where it is.
    pub fn state(&self) -> State {
        let (depth, velocity) = self.reference.at(self.time);
        State { position: self.surface + depth, velocity }
    }

    /// The contact force and the acceleration there.
    pub fn now(&self) -> (f64, f64) {
        (self.force, acceleration(&self.reference, self.time))
    }

    fn touch(&mut self, time: f64, step: f64) {
        let Some(along) = &mut self.along else { return };
        let (depth, velocity) = self.reference.at(time);
        let acceleration = acceleration(&self.reference, time);
        self.force = along.step(time, step, self.surface + depth, velocity, acceleration, 0.0);
    }
}
