//! A drive that cannot give what is asked.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start, linear,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct EffortSaturation;

static SPEC: EffectSpec = EffectSpec {
    name: "effort_saturation",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
    statement: "The drive does not give more than a certain effort, whatever is commanded",
    forms: &[Form {
        name: "symmetric",
        equation: "effort at the tool = commanded effort within -limit to limit",
        parameters: &[Parameter::new("limit", Word::new("N", "N m"), "greatest effort", 0.0, f64::INFINITY)
            .within(Limit::ReachedRange)],
    }],
    excited_by: "efforts near the greatest that is commanded",
    resembles: &["effort_lag", "coulomb_friction"],
    source: "current limit of the drive",
};

impl Effect for EffortSaturation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        linear(0.2, 0.95, 12).iter().map(|part| Start::at(&[part * scene.effort])).collect()
    }

    fn act_on_drive(&self, _form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        push.effort = push.effort.max(-values[0].abs()).min(values[0].abs());
    }
}
