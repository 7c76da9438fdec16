//! Damping that grows with speed.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct QuadraticDamping;

static SPEC: EffectSpec = EffectSpec {
    name: "quadratic_damping",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "The damping grows with speed, as in a liquid that is pushed aside",
    forms: &[
        Form {
            name: "square",
            equation: "F = K x + B v + quadratic v |v|",
            parameters: &[Parameter::new(
                "quadratic",
                Word::new("N s^2/m^2", "N m s^2/rad^2"),
                "drag over the square of the speed",
                0.0,
                f64::INFINITY,
            )],
        },
        Form {
            name: "power_of_speed",
            equation: "F = K x + B v + drag_there (|v| / reference_speed)^exponent sign(v)",
            parameters: &[
                Parameter::new("drag_there", Word::new("N", "N m"), "drag at the reference speed", 0.0, f64::INFINITY),
                Parameter::new(
                    "exponent",
                    Word::same("1"),
                    "2 for a wake, less where a layer shears as well, and above 1: the damping holds that",
                    1.2,
                    4.0,
                ),
                Parameter::fixed("reference_speed", Word::new("m/s", "rad/s"), "speed at which it is stated"),
            ],
        },
    ],
    excited_by: "motion in contact at two or more speeds",
    resembles: &["hunt_crossley_damping", "hysteresis"],
    source: "quadratic drag, e.g. G. K. Batchelor, An Introduction to Fluid Dynamics, 1967",
};

impl Effect for QuadraticDamping {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let speed = scene.speed.max(f64::MIN_POSITIVE);
        let drag = 0.1 * scene.stiffness * scene.depth;
        if form == 0 {
            return vec![Start::sized(&[drag / (speed * speed)], &[0])];
        }
        [1.5, 1.8, 2.2, 3.0].iter().map(|exponent| Start::sized(&[drag, *exponent, speed], &[0])).collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let speed = touch.velocity.abs();
        touch.extra += touch.rate
            * if form == 0 {
                values[0] * speed
            } else if values[2] > 0.0 && speed > 0.0 {
                values[0] / values[2] * (speed / values[2]).powf(values[1] - 1.0)
            } else {
                0.0
            };
    }
}
