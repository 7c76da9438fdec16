//! A sensor that shows too much, or too little.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ForceGain;

static SPEC: EffectSpec = EffectSpec {
    name: "force_gain",
    place: Place::Sensor,
    stage: Stage::Response,
    max_instances: 1,
    statement: "The force sensor is off by a factor: the drive feels another force than it shows",
    forms: &[Form {
        name: "factor",
        equation: "reading = (1 + gain_error) F",
        parameters: &[Parameter::new(
            "gain_error",
            Word::same("1"),
            "share by which the reading is too large",
            -0.9,
            10.0,
        )],
    }],
    excited_by: "contact while the drive's effort is recorded",
    resembles: &["load_dependent_friction"],
    source: "calibration of a strain-gauge bridge; from force and position alone it is a scale of K and B",
};

impl Effect for ForceGain {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if scene.has_effort { vec![Start::sized(&[0.05], &[0])] } else { Vec::new() }
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.force.iter_mut().for_each(|force| *force *= 1.0 + values[0]);
    }
}
