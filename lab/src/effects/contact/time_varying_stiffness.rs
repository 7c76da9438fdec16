//! A stiffness that is another one later.

use std::f64::consts::TAU;

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, FrequencySearch, Limit, Parameter, Place,
    Stage, Start, ToneWeight, gate, geometric, linear,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct TimeVaryingStiffness;

const TIME_CONSTANT: Parameter =
    Parameter::new("time_constant", SECOND, "of the change", 0.0, f64::INFINITY).within(Limit::ResolvableTime);
const CHANGE: Parameter = Parameter::new("change", Word::same("1"), "change of K over K at the start", -0.98, 50.0);
const SECOND: Word = Word::same("s");

static SPEC: EffectSpec = EffectSpec {
    name: "time_varying_stiffness",
    place: Place::Contact,
    stage: Stage::Depth,
    max_instances: 1,
    statement: "The same depth does not give the same force later: the stiffness changes with time",
    forms: &[
        Form {
            name: "drift",
            equation: "K(t) = K (1 + drift t)",
            parameters: &[Parameter::new(
                "drift",
                Word::same("1/s"),
                "change of K over K in a second",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
        Form {
            name: "jump",
            equation: "K(t) = K before instant, K (1 + change) after it",
            parameters: &[
                CHANGE,
                Parameter::new("instant", SECOND, "since the trial began", 0.0, f64::INFINITY)
                    .within(Limit::InstantOfJump),
            ],
        },
        Form {
            name: "settling",
            equation: "K(t) = K (1 + change (1 - exp(-t / time_constant)))",
            parameters: &[CHANGE, TIME_CONSTANT],
        },
        Form {
            name: "wave",
            equation: "K(t) = K (1 + sine sin(2 pi frequency t) + cosine cos(2 pi frequency t))",
            parameters: &[
                Parameter::new("sine", Word::same("1"), "part of the change", -0.98, 0.98).each_trial(),
                Parameter::new("cosine", Word::same("1"), "part of the change", -0.98, 0.98).each_trial(),
                Parameter::new("frequency", Word::same("Hz"), "of the change", 0.0, f64::INFINITY)
                    .within(Limit::RepeatedCycles),
            ],
        },
        Form {
            name: "settling_in_contact",
            equation: "K(t) = K (1 + change exp(-s / time_constant)), s since the tool touched",
            parameters: &[CHANGE, TIME_CONSTANT],
        },
    ],
    excited_by: "the same contact repeated, early and late",
    resembles: &["force_drift", "stress_relaxation", "plastic_set", "surface_motion"],
    source: "deflation, warming, softening: the paper's time-varying medium",
};

impl Effect for TimeVaryingStiffness {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn on_drive(&self) -> Option<&'static str> {
        Some("CusumRls follows a stiffness that jumps, AdaptiveWindow one that drifts: regressors x and v")
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let end = scene.duration;
        if !scene.separates_time_from_depth() {
            return Vec::new();
        }
        match form {
            0 => vec![Start::sized(&[0.1 / end], &[0])],
            1 => linear(0.2, 0.8, 4).iter().map(|part| Start::sized(&[0.1, part * end], &[0])).collect(),
            2 => geometric(0.03, 1.0, 5).iter().map(|part| Start::sized(&[0.1, part * end], &[0])).collect(),
            4 => geometric(0.003, 0.3, 6).iter().map(|part| Start::sized(&[0.1, part * end], &[0])).collect(),
            _ => Vec::new(),
        }
    }

    fn frequency_search(&self, form: usize, scene: &ExcitationStats) -> Option<FrequencySearch> {
        // Below one turn a trial it is a drift.
        (form == 3 && scene.separates_time_from_depth()).then(|| FrequencySearch {
            weight: ToneWeight::Depth,
            frequencies: vec![(2.0 / scene.duration, 0.5 / scene.duration, 60)],
            size: 0.1,
            harmonics: 1,
        })
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: seconds since the tool touched.
        state[0] = if touch.position > 0.0 { state[0] + touch.step } else { 0.0 };
        let time = touch.time;
        touch.stiffness *= 1.0
            + match form {
                0 => values[0] * time,
                1 => values[0] * gate(time - values[1], touch.smoothing_width),
                2 => -values[0] * (-time / values[1].max(f64::MIN_POSITIVE)).exp_m1(),
                4 => values[0] * (-state[0] / values[1].max(f64::MIN_POSITIVE)).exp(),
                _ => {
                    let (sine, cosine) = (TAU * values[2] * time).sin_cos();
                    values[0] * sine + values[1] * cosine
                }
            };
    }
}
