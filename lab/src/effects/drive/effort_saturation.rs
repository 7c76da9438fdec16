//! A drive that cannot give what is asked.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start, linear,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct EffortSaturation;

const LIMIT: Parameter = Parameter::new("limit", Word::new("N", "N m"), "greatest effort", 0.0, f64::INFINITY);

static SPEC: EffectSpec = EffectSpec {
    name: "effort_saturation",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
    statement: "The drive does not give more than a certain effort, whatever is commanded",
    forms: &[
        Form {
            name: "symmetric",
            equation: "effort at the tool = commanded effort within -limit to limit",
            parameters: &[LIMIT.within(Limit::ReachedRange)],
        },
        Form {
            name: "smooth",
            equation: "effort at the tool = limit tanh(commanded effort / limit)",
            parameters: &[LIMIT],
        },
    ],
    excited_by: "efforts near the greatest that is commanded",
    resembles: &["effort_lag", "coulomb_friction"],
    source: "current limit of the drive; a motor whose iron saturates gives less and less per ampere",
};

impl Effect for EffortSaturation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let parts = if form == 0 { linear(0.2, 0.95, 12) } else { linear(0.2, 2.0, 12) };
        parts.iter().map(|part| Start::at(&[part * scene.effort])).collect()
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        let limit = values[0].abs();
        push.effort = match form {
            0 => push.effort.max(-limit).min(limit),
            _ => limit * (push.effort / limit.max(f64::MIN_POSITIVE)).tanh(),
        };
    }
}
