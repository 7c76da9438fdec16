//! Damping that grows with depth.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch};
use crate::rig::Word;

/// See [`CARD`].
pub struct HuntCrossleyDamping;

static CARD: Card = Card {
    name: "hunt_crossley_damping",
    place: Place::Contact,
    stage: Stage::Law,
    most: 1,
    statement: "The damping is not constant: it grows with depth, from nothing at the surface",
    forms: &[Form {
        name: "linear_in_depth",
        equation: "F = K x + B v + alpha x v",
        parameters: &[Parameter::new(
            "alpha",
            Word::new("N s/m^2", "N m s/rad^2"),
            "growth of the damping with depth",
            0.0,
            f64::INFINITY,
        )],
    }],
    excited_by: "motion at two depths, and touching at speed",
    resembles: &["quadratic_damping", "environment_mass", "hysteresis"],
    source: "K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440",
};

impl Effect for HuntCrossleyDamping {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        vec![Start::sized(&[0.1 * scene.stiffness / scene.speed.max(f64::MIN_POSITIVE)], &[0])]
    }

    fn touch(&self, _form: usize, values: &[f64], _memory: &mut Memory, touch: &mut Touch) {
        touch.extra += values[0] * touch.depth.abs() * touch.rate;
    }
}
