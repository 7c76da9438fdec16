//! Friction that grows with what the transmission bears.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct LoadDependentFriction;

static SPEC: EffectSpec = EffectSpec {
    name: "load_dependent_friction",
    place: Place::Drive,
    stage: Stage::Friction,
    max_instances: 1,
    statement: "The more the drive bears, the more it rubs",
    forms: &[Form {
        name: "proportional",
        equation: "friction = load_coefficient |F| sign(v); at rest it holds up to load_coefficient |F|; F is the contact force and, where one is given, the load",
        parameters: &[Parameter::new("load_coefficient", Word::same("1"), "friction over what is borne", 0.0, 0.95)],
    }],
    excited_by: "reversals of the velocity at two or more contact forces or loads",
    resembles: &["coulomb_friction", "force_gain"],
    source: "gear and guide friction under load, e.g. P. Hamon et al., IEEE IROS 2010, 2501",
};

impl Effect for LoadDependentFriction {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if !scene.has_force {
            return Vec::new();
        }
        [0.02, 0.2].iter().map(|part| Start::sized(&[*part], &[0])).collect()
    }

    fn act_on_drive(&self, _form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let level = values[0] * push.force.abs();
        push.apply_dry_friction(level * push.direction(), level);
    }
}
