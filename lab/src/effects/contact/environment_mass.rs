//! Something that has to be carried along.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch};
use crate::rig::Word;

/// See [`CARD`].
pub struct EnvironmentMass;

static CARD: Card = Card {
    name: "environment_mass",
    place: Place::Contact,
    stage: Stage::Law,
    most: 1,
    statement: "What is touched has a mass of its own that moves along with the tool",
    forms: &[Form {
        name: "carried",
        equation: "F = K x + B v + moved_mass a, in contact only",
        parameters: &[Parameter::new(
            "moved_mass",
            Word::new("kg", "kg m^2"),
            "mass that moves along",
            0.0,
            f64::INFINITY,
        )],
    }],
    excited_by: "quick motion in contact, two or more frequencies, and the same in free space",
    resembles: &["tool_inertia", "channel_delay", "hunt_crossley_damping"],
    source: "the mass term of impedance: N. Hogan, J. Dyn. Syst. Meas. Control 107 (1985) 1",
};

impl Effect for EnvironmentMass {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        vec![Start::sized(&[0.05 * scene.force / scene.acceleration.max(f64::MIN_POSITIVE)], &[0])]
    }

    fn touch(&self, _form: usize, values: &[f64], _memory: &mut Memory, touch: &mut Touch) {
        touch.extra += values[0] * touch.acceleration * touch.inside;
    }
}
