//! A zero that is not zero.

use crate::effects::{Card, Effect, Form, Parameter, Place, Reading, Scene, Stage, Start};
use crate::rig::Word;

/// See [`CARD`].
pub struct ForceBias;

static CARD: Card = Card {
    name: "force_bias",
    place: Place::Sensor,
    stage: Stage::Zero,
    most: 1,
    statement: "The force sensor shows a force when nothing is touched",
    forms: &[Form {
        name: "constant",
        equation: "reading = F + bias",
        parameters: &[Parameter::new(
            "bias",
            Word::new("N", "N m"),
            "reading at no force",
            f64::NEG_INFINITY,
            f64::INFINITY,
        )],
    }],
    excited_by: "free motion beside contact",
    resembles: &["gravity_load", "adhesion"],
    source: "offset of a strain-gauge bridge",
};

impl Effect for ForceBias {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        // Without a free moment it is a surface that lies elsewhere.
        if scene.is_bilateral || scene.sees_zero() {
            vec![Start::sized(&[0.01 * scene.force], &[0])]
        } else {
            Vec::new()
        }
    }

    fn read(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.force.iter_mut().for_each(|force| *force += values[0]);
    }
}
