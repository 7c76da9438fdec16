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
const RATIO: Word = Word::same("1");

const fn branch_stiffness(name: &'static str) -> Parameter {
    Parameter::new(name, STIFFNESS, "stiffness that fades", 0.0, f64::INFINITY)
}

const fn time(name: &'static str) -> Parameter {
    Parameter::new(name, SECOND, "time in which it fades to 37 %", 0.0, f64::INFINITY).within(Limit::ResolvableTime)
}

const fn fading_ratio(name: &'static str) -> Parameter {
    Parameter::new(name, RATIO, "what fades of a step, over what stays", 0.0, f64::INFINITY)
}

static SPEC: EffectSpec = EffectSpec {
    name: "stress_relaxation",
    place: Place::Contact,
    stage: Stage::Memory,
    max_instances: 1,
    statement: "Held at one depth, the force fades: part of the stiffness relaxes with time",
    forms: &[
        Form {
            name: "one_branch",
            equation: "F = K x + B v + z, dz/dt = branch_stiffness v - z / relaxation_time",
            parameters: &[branch_stiffness("branch_stiffness"), time("relaxation_time")],
        },
        Form {
            name: "two_branches",
            equation: "F = K x + B v + z1 + z2, dz1/dt = branch_stiffness v - z1 / relaxation_time, z2 alike with second_stiffness, second_time",
            parameters: &[
                branch_stiffness("branch_stiffness"),
                time("relaxation_time"),
                branch_stiffness("second_stiffness"),
                time("second_time"),
            ],
        },
        Form {
            name: "power_law",
            equation: "F = K x + B v + integral G(t - s) v(s) ds, G(t) = memory_stiffness (t / reference_time)^-exponent, by eight branches over six decades about reference_time",
            parameters: &[
                branch_stiffness("memory_stiffness"),
                Parameter::new("exponent", RATIO, "0 for a spring, 1 for a damper", 0.02, 0.95),
                Parameter::fixed("reference_time", SECOND, "time at which the memory's stiffness is stated"),
            ],
        },
        Form {
            name: "quasi_linear",
            equation: "F = f(x) + B v + z, dz/dt = fading_ratio df/dt - z / relaxation_time, f the spring's own law",
            parameters: &[fading_ratio("fading_ratio"), time("relaxation_time")],
        },
        Form {
            name: "quasi_linear_two",
            equation: "F = f(x) + B v + z1 + z2, dz1/dt = fading_ratio df/dt - z1 / relaxation_time, z2 alike with second_ratio, second_time",
            parameters: &[
                fading_ratio("fading_ratio"),
                time("relaxation_time"),
                fading_ratio("second_ratio"),
                time("second_time"),
            ],
        },
        Form {
            name: "quasi_linear_power_law",
            equation: "F = f(x) + B v + integral G(t - s) df(s), G(t) = memory_ratio (t / reference_time)^-exponent, by eight branches over six decades about reference_time",
            parameters: &[
                Parameter::new(
                    "memory_ratio",
                    RATIO,
                    "what a step still keeps at reference_time beside what stays, over that",
                    0.0,
                    f64::INFINITY,
                ),
                Parameter::new("exponent", RATIO, "0 for a spring, 1 for a damper", 0.02, 0.95),
                Parameter::fixed("reference_time", SECOND, "time at which the memory's ratio is stated"),
            ],
        },
    ],
    excited_by: "holds after a quick approach; two or more frequencies",
    resembles: &["channel_delay", "force_lag", "time_varying_stiffness", "plastic_set"],
    source: "J. C. Maxwell (1867); Wiechert's generalised model; a massless spring in series with damper and spring is the same law; power law: G. W. Scott Blair (1947); quasi-linear: Y. C. Fung, Biomechanics, 1981, ch. 7",
};

/// Branches that a power law of time is made of, and the factor between their times: six decades in all.
const POWER_BRANCHES: usize = 8;
const POWER_SPACING: f64 = 7.196_856_730_011_52;

impl Effect for StressRelaxation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn builds_on(&self, form: usize) -> &'static [&'static str] {
        if form >= 3 { &["nonlinear_stiffness", "layered_stiffness", "plastic_set"] } else { &[] }
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let size = if form >= 3 { 0.2 } else { 0.2 * scene.stiffness };
        let times = geometric(2.0 * scene.step, scene.duration, 10);
        match form {
            0 | 3 => times.iter().map(|time| Start::sized(&[size, *time], &[0])).collect(),
            1 | 4 => {
                let pairs = (0..times.len())
                    .flat_map(|first| (first + 2..times.len()).step_by(2).map(move |second| (first, second)));
                pairs.map(|(first, second)| Start::sized(&[size, times[first], size, times[second]], &[0, 2])).collect()
            }
            _ => {
                let middle = (2.0 * scene.step * scene.duration).sqrt();
                [0.1, 0.3, 0.6].iter().map(|exponent| Start::sized(&[size, *exponent, middle], &[0])).collect()
            }
        }
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: what was strained an instant ago, whether there was one, then the branches.
        let strained = if form >= 3 { touch.spring } else { touch.depth };
        let moved = if state[1] == 0.0 { 0.0 } else { strained - state[0] };
        (state[0], state[1]) = (strained, 1.0);
        let step = touch.step;
        let mut branch = |nth: usize, stiffness: f64, time: f64| {
            let ratio = if time > 0.0 { step / time } else { f64::INFINITY };
            let mean = if ratio > 0.0 { -(-ratio).exp_m1() / ratio } else { 1.0 };
            state[2 + nth] = state[2 + nth] * (-ratio).exp() + stiffness * moved * mean;
            state[2 + nth]
        };
        touch.extra += match form {
            0 | 3 => branch(0, values[0], values[1]),
            1 | 4 => branch(0, values[0], values[1]) + branch(1, values[2], values[3]),
            _ => {
                let (exponent, reference) = (values[1], values[2]);
                // t^-a = integral tau^-a exp(-t / tau) d ln(tau) / Gamma(a), in equal steps of ln(tau).
                let each = values[0] * POWER_SPACING.ln() / libm::tgamma(exponent);
                let middle = 0.5 * (POWER_BRANCHES - 1) as f64;
                let of = |nth: usize| {
                    let factor = POWER_SPACING.powf(nth as f64 - middle);
                    branch(nth, each * factor.powf(-exponent), reference * factor)
                };
                (0..POWER_BRANCHES).map(of).sum()
            }
        };
    }
}
