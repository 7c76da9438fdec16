//! Weight.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct GravityLoad;

const NEWTON: Word = Word::new("N", "N m");

static SPEC: EffectSpec = EffectSpec {
    name: "gravity_load",
    place: Place::Drive,
    stage: Stage::Load,
    max_instances: 1,
    statement: "The drive carries a weight",
    forms: &[
        Form {
            name: "constant",
            equation: "m a + b v + load = effort - F",
            parameters: &[Parameter::new(
                "load",
                NEWTON,
                "constant load, positive out of the environment",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
        Form {
            name: "by_angle",
            equation: "m a + b v + sine sin(q) + cosine cos(q) + load = effort - F",
            parameters: &[
                Parameter::new("sine", NEWTON, "m g l where q = 0 hangs down", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::new("cosine", NEWTON, "m g l where q = 0 is level", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::new("load", NEWTON, "constant part", f64::NEG_INFINITY, f64::INFINITY),
            ],
        },
        Form {
            name: "by_position",
            equation: "m a + b v + sine sin(2 pi x / length) + cosine cos(2 pi x / length) = effort - F",
            parameters: &[
                Parameter::new(
                    "sine",
                    NEWTON,
                    "part of a load that rises and falls slowly",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::new("cosine", NEWTON, "its other part", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::new("length", Word::new("m", "rad"), "way over which it repeats", 0.0, f64::INFINITY),
            ],
        },
    ],
    excited_by: "rest or slow motion, over a wide angle where the rig turns",
    resembles: &["force_bias", "coulomb_friction"],
    source: "I. Newton (1687)",
};

impl Effect for GravityLoad {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let size = 0.05 * scene.effort;
        match form {
            0 => vec![Start::sized(&[size], &[0])],
            1 if scene.is_rotary => vec![Start::sized(&[size, size, size], &[0, 1, 2])],
            _ => Vec::new(),
        }
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let weight = match form {
            0 => values[0],
            1 => {
                let (sine, cosine) = push.position.sin_cos();
                values[0] * sine + values[1] * cosine + values[2]
            }
            _ => {
                let turn = std::f64::consts::TAU * push.position / values[2].max(f64::MIN_POSITIVE);
                values[0] * turn.sin() + values[1] * turn.cos()
            }
        };
        push.weight += weight;
        push.resistance += weight;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Moments of a weight on an arm where it is known without a formula: down, level, up and level again.
    #[test]
    fn a_weight_by_angle_is_its_sine_and_cosine_at_the_quarters_of_a_turn() {
        let (sine, cosine, load) = (3.0, 0.7, -0.2);
        let moment = |angle: f64| {
            let mut push = DriveState {
                step: 1e-3,
                position: angle,
                velocity: 0.0,
                at_rest: true,
                force: 0.0,
                effort: 0.0,
                inertia: 1.0,
                viscous: 0.0,
                resistance: 0.0,
                weight: 0.0,
            };
            GravityLoad.act_on_drive(1, &[sine, cosine, load], &mut EffectState::default(), &mut push);
            assert_eq!(push.weight, push.resistance);
            push.resistance
        };
        for (angle, expected) in
            [(0.0, cosine + load), (FRAC_PI_2, sine + load), (PI, -cosine + load), (3.0 * FRAC_PI_2, -sine + load)]
        {
            assert!((moment(angle) - expected).abs() < 1e-14, "{angle}: {}", moment(angle));
        }
    }
}
