//! Dry friction.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Push, Scene, Stage, Start};
use crate::rig::Word;

/// See [`CARD`].
pub struct CoulombFriction;

const NEWTON: Word = Word::new("N", "N m");

static CARD: Card = Card {
    name: "coulomb_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    most: 1,
    statement: "The drive rubs: a constant force against the motion, which also holds it at rest",
    forms: &[
        Form {
            name: "symmetric",
            equation: "m a + b v + level sign(v) = effort - F; at rest it holds up to level",
            parameters: &[Parameter::new("level", NEWTON, "dry friction", 0.0, f64::INFINITY)],
        },
        Form {
            name: "asymmetric",
            equation: "as symmetric, with forward_level for v > 0 and backward_level for v < 0",
            parameters: &[
                Parameter::new("forward_level", NEWTON, "dry friction going in", 0.0, f64::INFINITY),
                Parameter::new("backward_level", NEWTON, "dry friction coming out", 0.0, f64::INFINITY),
            ],
        },
    ],
    excited_by: "reversals of the velocity in free motion, at two or more speeds",
    resembles: &["stribeck_friction", "load_dependent_friction", "backlash"],
    source: "C. A. de Coulomb (1785); at rest a set, not a function: B. Armstrong-Helouvry et al., Automatica 30 (1994) 1083",
};

impl Effect for CoulombFriction {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, form: usize, scene: &Scene) -> Vec<Start> {
        let levels = [0.003, 0.03, 0.2].map(|part| part * scene.effort);
        if form == 0 {
            levels.iter().map(|level| Start::sized(&[*level], &[0])).collect()
        } else {
            levels.iter().map(|level| Start::sized(&[*level, *level], &[0, 1])).collect()
        }
    }

    fn push(&self, form: usize, values: &[f64], _memory: &mut Memory, push: &mut Push) {
        let direction = push.direction();
        if form == 0 {
            push.rub(values[0] * direction, values[0]);
        } else {
            let (forward, backward) = (values[0], values[1]);
            let sliding = 0.5 * ((forward + backward) * direction + (forward - backward) * direction.abs());
            push.rub(sliding, if push.rest() > 0.0 { forward } else { backward });
        }
    }
}
