//! Friction that is larger when creeping.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start, geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct StribeckFriction;

const NEWTON: Word = Word::new("N", "N m");

const PARAMETERS: &[Parameter] = &[
    Parameter::new("level", NEWTON, "dry friction at speed", 0.0, f64::INFINITY),
    Parameter::new("breakaway_excess", NEWTON, "what creeping adds to it", 0.0, f64::INFINITY),
    Parameter::new(
        "stribeck_speed",
        Word::new("m/s", "rad/s"),
        "speed at which the excess is gone",
        0.0,
        f64::INFINITY,
    ),
];

static SPEC: EffectSpec = EffectSpec {
    name: "stribeck_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    max_instances: 1,
    statement: "The drive rubs, and it rubs more when it creeps than when it runs",
    forms: &[
        Form {
            name: "gaussian",
            equation: "friction = (level + breakaway_excess exp(-(v / stribeck_speed)^2)) sign(v); at rest it holds the sum",
            parameters: PARAMETERS,
        },
        Form {
            name: "exponential",
            equation: "friction = (level + breakaway_excess exp(-|v| / stribeck_speed)) sign(v); at rest it holds the sum",
            parameters: PARAMETERS,
        },
    ],
    excited_by: "slow reversals, beside quick ones",
    resembles: &["coulomb_friction", "load_dependent_friction"],
    source: "R. Stribeck (1902); the exponential: A. Tustin, J. IEE 94 (1947) 143; both: B. Armstrong-Helouvry et al., Automatica 30 (1994) 1083",
};

impl Effect for StribeckFriction {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let level = 0.03 * scene.effort;
        let speeds = geometric(0.03 * scene.speed, 1.5 * scene.speed, 6);
        speeds.iter().map(|speed| Start::sized(&[level, level, *speed], &[0, 1])).collect()
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let relative = push.velocity.abs() / values[2].max(f64::MIN_POSITIVE);
        let left = if form == 0 { (-relative * relative).exp() } else { (-relative).exp() };
        push.apply_dry_friction((values[0] + values[1] * left) * push.direction(), values[0] + values[1]);
    }
}
