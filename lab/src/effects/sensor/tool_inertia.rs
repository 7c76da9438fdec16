//! A mass beyond the sensor.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ToolInertia;

static SPEC: EffectSpec = EffectSpec {
    name: "tool_inertia",
    place: Place::Sensor,
    stage: Stage::Mount,
    max_instances: 1,
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
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn on_drive(&self) -> Option<&'static str> {
        Some("ParameterRls with ContactModel::ToolMass follows K, B and the mass: regressor a")
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        vec![Start::sized(&[0.02 * scene.force / scene.acceleration.max(f64::MIN_POSITIVE)], &[0])]
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        for (force, acceleration) in reading.force.iter_mut().zip(reading.acceleration) {
            *force += values[0] * acceleration;
        }
    }
}
