//! A force that fades while the tool is held.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start,
    geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct StressRelaxation;

const STIFFNESS: Word = Word::new("N/m", "N m/rad");
const SECOND: Word = Word::same("s");

static SPEC: EffectSpec = EffectSpec {
    name: "stress_relaxation",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 3,
    statement: "Held at one depth, the force fades: part of the stiffness relaxes with time",
    forms: &[Form {
        name: "one_branch",
        equation: "F = K x + B v + z, dz/dt = branch_stiffness v - z / relaxation_time",
        parameters: &[
            Parameter::new("branch_stiffness", STIFFNESS, "stiffness that fades", 0.0, f64::INFINITY),
            Parameter::new("relaxation_time", SECOND, "time in which it fades to 37 %", 0.0, f64::INFINITY)
                .within(Limit::ResolvableTime),
        ],
    }],
    excited_by: "holds after a quick approach; two or more frequencies",
    resembles: &["channel_delay", "force_lag", "time_varying_stiffness", "plastic_set"],
    source: "J. C. Maxwell (1867); Wiechert's generalised model; a massless spring in series with damper and spring is the same law",
};

impl Effect for StressRelaxation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let size = 0.2 * scene.stiffness;
        let times = geometric(2.0 * scene.step, scene.duration, 10);
        times.iter().map(|time| Start::sized(&[size, *time], &[0])).collect()
    }

    fn act_on_contact(&self, _form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: depth an instant ago, whether there was one, then the branch.
        let moved = if state[1] == 0.0 { 0.0 } else { touch.depth - state[0] };
        (state[0], state[1]) = (touch.depth, 1.0);
        let (stiffness, time) = (values[0], values[1]);
        let ratio = if time > 0.0 { touch.step / time } else { f64::INFINITY };
        let mean = if ratio > 0.0 { -(-ratio).exp_m1() / ratio } else { 1.0 };
        state[2] = state[2] * (-ratio).exp() + stiffness * moved * mean;
        touch.extra += state[2];
    }
}
