//! Damping that grows with speed.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch};
use crate::rig::Word;

/// See [`CARD`].
pub struct QuadraticDamping;

static CARD: Card = Card {
    name: "quadratic_damping",
    place: Place::Contact,
    stage: Stage::Law,
    most: 1,
    statement: "The damping grows with speed, as in a liquid that is pushed aside",
    forms: &[Form {
        name: "square",
        equation: "F = K x + B v + quadratic v |v|",
        parameters: &[Parameter::new(
            "quadratic",
            Word::new("N s^2/m^2", "N m s^2/rad^2"),
            "drag over the square of the speed",
            0.0,
            f64::INFINITY,
        )],
    }],
    excited_by: "motion in contact at two or more speeds",
    resembles: &["hunt_crossley_damping", "hysteresis"],
    source: "quadratic drag, e.g. G. K. Batchelor, An Introduction to Fluid Dynamics, 1967",
};

impl Effect for QuadraticDamping {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        let speed = scene.speed.max(f64::MIN_POSITIVE);
        vec![Start::sized(&[0.1 * scene.stiffness * scene.depth / (speed * speed)], &[0])]
    }

    fn touch(&self, _form: usize, values: &[f64], _memory: &mut Memory, touch: &mut Touch) {
        touch.extra += values[0] * touch.rate * touch.velocity.abs();
    }
}
