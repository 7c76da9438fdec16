//! Friction that grows more slowly than speed.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct SublinearFriction;

static SPEC: EffectSpec = EffectSpec {
    name: "sublinear_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    max_instances: 1,
    statement: "The drive rubs the more the faster it runs, but less than in proportion to its speed",
    forms: &[Form {
        name: "power",
        equation: "friction = level (|v| / reference_speed)^exponent sign(v), beside dry friction",
        parameters: &[
            Parameter::new("level", Word::new("N", "N m"), "friction at the reference speed", 0.0, f64::INFINITY),
            Parameter::new("exponent", Word::same("1"), "power of the speed", 0.0, 1.0),
            Parameter::fixed("reference_speed", Word::new("m/s", "rad/s"), "speed at which it is stated"),
        ],
    }],
    excited_by: "steady motion at several speeds, from slow to the fastest",
    resembles: &["stribeck_friction", "coulomb_friction"],
    source: "grease at speed: L. Marton, B. Lantos, IEEE Trans. Ind. Electron. 54 (2007) 511; measured on robot joints: A. C. Bittencourt, S. Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012) 051013",
};

impl Effect for SublinearFriction {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        vec![Start::sized(&[0.03 * scene.effort, 0.6, scene.speed], &[0])]
    }

    fn act_on_drive(&self, _form: usize, values: &[f64], _memory: &mut EffectState, push: &mut DriveState) {
        let relative = push.velocity.abs() / values[2].abs().max(f64::MIN_POSITIVE);
        let level = values[0] * relative.powf(values[1]);
        // At rest it is nothing: a power of no speed holds nothing.
        push.apply_dry_friction(level * push.direction(), 0.0);
    }
}
