//! Play between the position sensor and the surface.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch, geometric};
use crate::rig::Word;

/// See [`CARD`].
pub struct LostMotion;

static CARD: Card = Card {
    name: "lost_motion",
    place: Place::Contact,
    stage: Stage::Geometry,
    most: 1,
    statement: "After each reversal the sensor moves a little way before the tip does",
    forms: &[Form {
        name: "play",
        equation: "the tip follows the sensor only beyond +-play/2; the contact law takes the tip's depth and rate",
        parameters: &[Parameter::new("play", Word::new("m", "rad"), "whole width of the play", 0.0, f64::INFINITY)],
    }],
    excited_by: "small and large reversals in contact",
    resembles: &["hysteresis", "plastic_set"],
    source: "the play operator: M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, 1989",
};

impl Effect for LostMotion {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        geometric(0.003 * scene.depth, 0.8 * scene.depth, 8).iter().map(|play| Start::at(&[*play])).collect()
    }

    fn touch(&self, _form: usize, values: &[f64], memory: &mut Memory, touch: &mut Touch) {
        // memory: tip position, whether it is known, sensor position an instant ago.
        let half = 0.5 * values[0];
        if memory[1] == 0.0 {
            (memory[0], memory[1], memory[2]) = (touch.position, 1.0, touch.position);
        }
        let before = memory[0];
        memory[0] = before.max(touch.position - half).min(touch.position + half);
        // A motion that takes up the play within one step follows for the rest of it. Both are ways over the step: against
        // velocity times step a tip without play would fall short wherever the motion speeds up.
        let whole = touch.position - memory[2];
        memory[2] = touch.position;
        let share = if whole != 0.0 { ((memory[0] - before) / whole).clamp(0.0, 1.0) } else { 1.0 };
        touch.velocity *= share;
        touch.position = memory[0];
    }
}
