//! A sensor that shows too much, or too little.

use crate::effects::{Card, Effect, Form, Parameter, Place, Reading, Scene, Stage, Start};
use crate::rig::Word;

/// See [`CARD`].
pub struct ForceGain;

static CARD: Card = Card {
    name: "force_gain",
    place: Place::Sensor,
    stage: Stage::Response,
    most: 1,
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
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        if scene.has_effort { vec![Start::sized(&[0.05], &[0])] } else { Vec::new() }
    }

    fn read(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.force.iter_mut().for_each(|force| *force *= 1.0 + values[0]);
    }
}
