//! A sensor at the end of its range.

use crate::effects::{Card, Effect, Form, Limit, Parameter, Place, Reading, Scene, Stage, Start, linear};
use crate::rig::Word;

/// See [`CARD`].
pub struct ForceSaturation;

static CARD: Card = Card {
    name: "force_saturation",
    place: Place::Sensor,
    stage: Stage::Range,
    most: 1,
    statement: "The force sensor does not show more than a certain force",
    forms: &[Form {
        name: "symmetric",
        equation: "reading = F within -limit to limit",
        parameters: &[
            Parameter::new("limit", Word::new("N", "N m"), "greatest reading", 0.0, f64::INFINITY).within(Limit::Range)
        ],
    }],
    excited_by: "deep contacts beside shallow ones",
    resembles: &["layered_stiffness", "nonlinear_stiffness"],
    source: "range of amplifier or converter",
};

impl Effect for ForceSaturation {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        linear(0.4, 0.99, 10).iter().map(|part| Start::at(&[part * scene.force])).collect()
    }

    fn read(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let limit = values[0].abs();
        reading.force.iter_mut().for_each(|force| *force = force.max(-limit).min(limit));
    }
}
