//! A drive that comes late.

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start, geometric,
    lagged,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct EffortLag;

static SPEC: EffectSpec = EffectSpec {
    name: "effort_lag",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
    statement: "The effort builds up later than commanded",
    forms: &[Form {
        name: "first_order",
        equation: "time_constant d(effort at the tool)/dt = commanded effort - effort at the tool",
        parameters: &[Parameter::new("time_constant", Word::same("s"), "of the drive", 0.0, f64::INFINITY)],
    }],
    excited_by: "quick changes of effort, two or more frequencies",
    resembles: &["transmission_compliance", "channel_delay"],
    source: "winding and current loop of a motor: L / R",
};

impl Effect for EffortLag {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        geometric(scene.sample, 30.0 * scene.step, 7).iter().map(|time| Start::at(&[*time])).collect()
    }

    fn act_on_drive(&self, _form: usize, values: &[f64], state: &mut EffectState, push: &mut DriveState) {
        // state: effort at the tool, command an instant ago, whether they are known.
        let time = values[0];
        if state[2] == 0.0 || time <= 0.0 {
            (state[0], state[1], state[2]) = (push.effort, push.effort, 1.0);
            return;
        }
        let ratio = push.step / time;
        if ratio > 0.0 {
            state[0] = lagged(state[0], [state[1], push.effort], ratio);
        }
        state[1] = push.effort;
        push.effort = state[0];
    }
}
