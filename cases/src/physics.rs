//! Everything that moves in a case, from the motor to the reading.

use crate::contact::Contact;
use crate::drive::Drive;
use crate::gauge::Gauge;
use crate::nominal::Nominal;

/// The physics of one trial, with the state of its memories.
#[derive(Debug, Clone)]
pub struct Physics {
    /// The touched surface.
    pub contact: Contact,
    /// The motor and what it moves.
    pub drive: Drive,
    /// The force sensor.
    pub gauge: Gauge,
    /// Step of the simulation, s.
    pub step: f64,
    /// Which trial of the case this is: what runs by itself does not know when a recording starts.
    pub trial: usize,
}

impl Physics {
    /// Nothing beyond the nominal physics.
    #[must_use]
    pub fn new(nominal: Nominal, trial: usize, step: f64) -> Self {
        Self { contact: Contact::new(nominal), drive: Drive::new(nominal), gauge: Gauge::default(), step, trial }
    }
}
