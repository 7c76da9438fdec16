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
        equation: "friction = load_coefficient |F| sign(v); at rest it holds up to load_coefficient |F|; F is the contact force with the load that is given and the weight of gravity_load",
        parameters: &[Parameter::new("load_coefficient", Word::same("1"), "friction over what is borne", 0.0, 0.95)],
    }],
    excited_by: "reversals of the velocity at two or more contact forces, loads or weights",
    resembles: &["coulomb_friction", "force_gain", "effort_saturation"],
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
        let level = values[0] * (push.force + push.weight).abs();
        push.apply_dry_friction(level * push.direction(), level);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 N pressed against a weight of 5 N the other way, and with it.
    #[test]
    fn what_is_borne_is_the_contact_and_the_weight() {
        let rubbed = |force: f64, weight: f64| {
            let mut push = DriveState {
                step: 1e-3,
                position: 0.0,
                velocity: -0.1,
                at_rest: false,
                force,
                effort: 0.0,
                inertia: 1.0,
                viscous: 0.0,
                resistance: weight,
                weight,
            };
            LoadDependentFriction.act_on_drive(0, &[0.1], &mut EffectState::default(), &mut push);
            push.resistance - weight
        };
        for (force, weight, expected) in [(2.0, 0.0, -0.2), (2.0, -5.0, -0.3), (2.0, 5.0, -0.7), (0.0, -5.0, -0.5)] {
            assert!((rubbed(force, weight) - expected).abs() < 1e-15, "{force} {weight}");
        }
    }
}
