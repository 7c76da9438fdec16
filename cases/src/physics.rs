//! Equations of motion of a case, from the motor to the force reading, with the state of every effect.

use crate::nominal::NominalParameters;

pub mod active_surface;
pub mod actuator;
pub mod adhesion;
pub mod cogging;
pub mod contact;
pub mod damping;
pub mod delay;
pub mod drive;
pub mod environment_mass;
pub mod external_push;
pub mod force_offset;
pub mod force_range;
pub mod force_resonance;
pub mod force_sensor;
pub mod friction;
pub mod gravity;
pub mod hysteresis;
pub mod loose_contact;
pub mod lost_motion;
pub mod mains_hum;
pub mod periodic_force_error;
pub mod plastic_set;
pub mod position_dependent_friction;
pub mod stiffness;
pub mod stress_relaxation;
pub mod surface_motion;
pub mod thermal_wander;
pub mod time_varying_stiffness;
pub mod transmission;

use contact::Contact;
use drive::Drive;
use force_sensor::ForceSensor;

/// The rig in one trial: parameters of all effects, and their state.
#[derive(Debug, Clone)]
pub struct RigModel {
    /// The touched surface.
    pub contact: Contact,
    /// The motor and what it moves.
    pub drive: Drive,
    /// The force sensor.
    pub sensor: ForceSensor,
    /// Step of the simulation, s.
    pub step_s: f64,
    /// Which trial of the case this is: an effect that runs by itself has another phase in each.
    pub trial: usize,
}

impl RigModel {
    /// The nominal rig, with no effect.
    #[must_use]
    pub fn new(nominal: NominalParameters, trial: usize, step_s: f64) -> Self {
        let (contact, drive) = (Contact::new(nominal), Drive::new(nominal));
        Self { contact, drive, sensor: ForceSensor::default(), step_s, trial }
    }
}
