//! A second layer under the first.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch, linear, ramp};
use crate::rig::Word;

/// See [`CARD`].
pub struct LayeredStiffness;

static CARD: Card = Card {
    name: "layered_stiffness",
    place: Place::Contact,
    stage: Stage::Law,
    most: 1,
    statement: "From a certain depth on, the tool presses on something else",
    forms: &[Form {
        name: "two_layers",
        equation: "spring = K x + added_stiffness max(0, x - layer_depth)",
        parameters: &[
            Parameter::new(
                "added_stiffness",
                Word::new("N/m", "N m/rad"),
                "what the second layer adds; below zero where it is softer",
                f64::NEG_INFINITY,
                f64::INFINITY,
            ),
            Parameter::new("layer_depth", Word::new("m", "rad"), "depth of the boundary", 0.0, f64::INFINITY),
        ],
    }],
    excited_by: "contacts that go through the boundary and others that stop before it",
    resembles: &["nonlinear_stiffness", "force_saturation"],
    source: "springs in series and parallel; bilinear stiffness",
};

impl Effect for LayeredStiffness {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        let depths = linear(0.15, 0.9, 8);
        depths.iter().map(|part| Start::sized(&[0.1 * scene.stiffness, part * scene.depth], &[0])).collect()
    }

    fn touch(&self, _form: usize, values: &[f64], _memory: &mut Memory, touch: &mut Touch) {
        let width = touch.velocity.abs() * touch.blur;
        let beyond = if touch.bilateral {
            touch.position.signum() * ramp(touch.position.abs() - values[1], width)
        } else {
            ramp(touch.position - values[1], width)
        };
        touch.spring += values[0] * beyond;
    }
}
