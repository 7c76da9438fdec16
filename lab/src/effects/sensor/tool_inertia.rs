//! A mass beyond the sensor.

use crate::effects::{Card, Effect, Form, Parameter, Place, Reading, Scene, Stage, Start};
use crate::rig::Word;

/// See [`CARD`].
pub struct ToolInertia;

static CARD: Card = Card {
    name: "tool_inertia",
    place: Place::Sensor,
    stage: Stage::Mount,
    most: 1,
    statement: "The force sensor also feels the mass of what is mounted beyond it",
    forms: &[Form {
        name: "rigid",
        equation: "reading = F + beyond_mass a",
        parameters: &[Parameter::new(
            "beyond_mass",
            Word::new("kg", "kg m^2"),
            "mass between sensor and surface",
            0.0,
            f64::INFINITY,
        )],
    }],
    excited_by: "quick motion in free space",
    resembles: &["environment_mass", "channel_delay"],
    source: "inertial force of the end effector, e.g. D. Kubus et al., IEEE IROS 2008, 1402",
};

impl Effect for ToolInertia {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        vec![Start::sized(&[0.02 * scene.force / scene.acceleration.max(f64::MIN_POSITIVE)], &[0])]
    }

    fn read(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        for (force, acceleration) in reading.force.iter_mut().zip(reading.acceleration) {
            *force += values[0] * acceleration;
        }
    }
}
