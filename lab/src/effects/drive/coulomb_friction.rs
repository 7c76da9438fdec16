//! Dry friction.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct CoulombFriction;

const NEWTON: Word = Word::new("N", "N m");

static SPEC: EffectSpec = EffectSpec {
    name: "coulomb_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    max_instances: 1,
    statement: "The drive rubs: a constant force against the motion, which also holds it at rest",
    forms: &[
        Form {
            name: "symmetric",
            equation: "m a + b v + level sign(v) = effort - F; at rest it holds up to level",
            parameters: &[Parameter::new("level", NEWTON, "dry friction", 0.0, f64::INFINITY)],
        },
        Form {
            name: "asymmetric",
            equation: "m a + b v + forward_level where v > 0, - backward_level where v < 0, = effort - F; at rest it holds up to either",
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
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let levels = [0.003, 0.03, 0.2].map(|part| part * scene.effort);
        if form == 0 {
            levels.iter().map(|level| Start::sized(&[*level], &[0])).collect()
        } else {
            levels.iter().map(|level| Start::sized(&[*level, *level], &[0, 1])).collect()
        }
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let direction = push.direction();
        if form == 0 {
            push.apply_dry_friction(values[0] * direction, values[0]);
        } else {
            let (forward, backward) = (values[0], values[1]);
            let sliding = 0.5 * ((forward + backward) * direction + (forward - backward) * direction.abs());
            push.apply_dry_friction(sliding, if push.balance_residual() > 0.0 { forward } else { backward });
        }
    }
}
