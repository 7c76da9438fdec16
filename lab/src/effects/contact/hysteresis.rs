//! A loop that does not ask how fast.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch, geometric};
use crate::rig::Word;

/// See [`CARD`].
pub struct Hysteresis;

static CARD: Card = Card {
    name: "hysteresis",
    place: Place::Contact,
    stage: Stage::Law,
    most: 1,
    statement: "The force going in is larger than coming out, however slowly the tool moves",
    forms: &[Form {
        name: "elastic_slip",
        equation: "F = K x + B v + loop_force z, dz = dx / yield_depth within -1 <= z <= 1",
        parameters: &[
            Parameter::new("loop_force", Word::new("N", "N m"), "half the width of the loop", 0.0, f64::INFINITY),
            Parameter::new(
                "yield_depth",
                Word::new("m", "rad"),
                "travel over which the force turns after a reversal",
                0.0,
                f64::INFINITY,
            ),
        ],
    }],
    excited_by: "reversals at two or more speeds in contact, slow ones above all",
    resembles: &["plastic_set", "lost_motion", "quadratic_damping", "stress_relaxation"],
    source: "L. Prandtl (1928), W. D. Iwan, J. Appl. Mech. 33 (1966) 893: an elastic slip element",
};

impl Effect for Hysteresis {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        let size = 0.05 * scene.stiffness * scene.depth;
        let travels = geometric(0.01 * scene.depth, 1.0 * scene.depth, 7);
        travels.iter().map(|travel| Start::sized(&[size, *travel], &[0])).collect()
    }

    fn touch(&self, _form: usize, values: &[f64], memory: &mut Memory, touch: &mut Touch) {
        // memory: depth an instant ago, z.
        let moved = touch.depth - memory[0];
        memory[0] = touch.depth;
        let travel = values[1].max(f64::MIN_POSITIVE);
        // What was strained is at rest again when the tool comes back.
        memory[1] =
            if touch.inside > 0.0 && touch.step > 0.0 { (memory[1] + moved / travel).clamp(-1.0, 1.0) } else { 0.0 };
        touch.extra += values[0] * memory[1] * touch.inside;
    }
}
