//! A drive that cannot give what is asked.

use crate::effects::{Card, Effect, Form, Limit, Memory, Parameter, Place, Push, Scene, Stage, Start, linear};
use crate::rig::Word;

/// See [`CARD`].
pub struct EffortSaturation;

static CARD: Card = Card {
    name: "effort_saturation",
    place: Place::Drive,
    stage: Stage::Transmission,
    most: 1,
    statement: "The drive does not give more than a certain effort, whatever is commanded",
    forms: &[Form {
        name: "symmetric",
        equation: "effort at the tool = commanded effort within -limit to limit",
        parameters: &[
            Parameter::new("limit", Word::new("N", "N m"), "greatest effort", 0.0, f64::INFINITY).within(Limit::Range)
        ],
    }],
    excited_by: "efforts near the greatest that is commanded",
    resembles: &["effort_lag", "coulomb_friction"],
    source: "current limit of the drive",
};

impl Effect for EffortSaturation {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        linear(0.2, 0.95, 12).iter().map(|part| Start::at(&[part * scene.effort])).collect()
    }

    fn effort_limit(&self, _form: usize, values: &[f64]) -> Option<f64> {
        Some(values[0].abs())
    }

    fn push(&self, _form: usize, values: &[f64], _memory: &mut Memory, push: &mut Push) {
        push.effort = push.effort.max(-values[0].abs()).min(values[0].abs());
    }
}
