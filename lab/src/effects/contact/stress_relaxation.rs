//! A force that fades while the tool is held.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Foundation, Limit, Parameter, Place, Stage,
    Start, geometric,
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
            name: "three_branches",
            equation: "F = K x + B v + z1 + z2 + z3, dz1/dt = branch_stiffness v - z1 / relaxation_time, z2 and z3 alike with second_stiffness, second_time, third_stiffness, third_time",
            parameters: &[
                branch_stiffness("branch_stiffness"),
                time("relaxation_time"),
                branch_stiffness("second_stiffness"),
                time("second_time"),
                branch_stiffness("third_stiffness"),
                time("third_time"),
            ],
        },
        Form {
            name: "power_law",
            equation: "F = K x + B v + integral G(t - s) v(s) ds, G(t) = memory_stiffness (t / reference_time)^-exponent, by ten branches over six decades about reference_time",
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
            name: "quasi_linear_three",
            equation: "F = f(x) + B v + z1 + z2 + z3, dz1/dt = fading_ratio df/dt - z1 / relaxation_time, z2 and z3 alike with second_ratio, second_time, third_ratio, third_time",
            parameters: &[
                fading_ratio("fading_ratio"),
                time("relaxation_time"),
                fading_ratio("second_ratio"),
                time("second_time"),
                fading_ratio("third_ratio"),
                time("third_time"),
            ],
        },
        Form {
            name: "quasi_linear_power_law",
            equation: "F = f(x) + B v + integral G(t - s) df(s), G(t) = memory_ratio (t / reference_time)^-exponent, by ten branches over six decades about reference_time",
            parameters: &[
                Parameter::new(
                    "memory_ratio",
                    RATIO,
                    "what is left to fade of a step at reference_time, over what stays",
                    0.0,
                    f64::INFINITY,
                ),
                Parameter::new("exponent", RATIO, "0 for a spring, 1 for a damper", 0.02, 0.95),
                Parameter::fixed("reference_time", SECOND, "time at which the memory's ratio is stated"),
            ],
        },
        Form {
            name: "one_branch_anew",
            equation: "F = K x + B v + z, dz/dt = branch_stiffness v - z / relaxation_time, z = 0 before each touch",
            parameters: &[branch_stiffness("branch_stiffness"), time("relaxation_time")],
        },
        Form {
            name: "two_branches_anew",
            equation: "F = K x + B v + z1 + z2, dz1/dt = branch_stiffness v - z1 / relaxation_time, z2 alike with second_stiffness, second_time, z1 = z2 = 0 before each touch",
            parameters: &[
                branch_stiffness("branch_stiffness"),
                time("relaxation_time"),
                branch_stiffness("second_stiffness"),
                time("second_time"),
            ],
        },
    ],
    excited_by: "holds after a quick approach; two or more frequencies",
    resembles: &["channel_delay", "force_lag", "time_varying_stiffness", "plastic_set"],
    source: "J. C. Maxwell (1867); Wiechert's generalised model; a massless spring in series with damper and spring is the same law; power law: G. W. Scott Blair (1947); quasi-linear: Y. C. Fung, Biomechanics, 1981, ch. 7",
};

/// Indices of the forms.
mod form {
    pub const ONE: usize = 0;
    pub const TWO: usize = 1;
    pub const THREE: usize = 2;
    /// From here on what relaxes is the spring's force by its own law, and before the depth; otherwise in the same order.
    pub const QUASI_LINEAR: usize = 4;
    /// From here on a branch forgets while nothing is touched: each touch meets what was not strained before, as another spot or a layer that flows back.
    pub const ANEW: usize = 8;
}

/// Branches of `form`, what it strains set aside; `None` of a power law.
const fn branches(form: usize) -> Option<usize> {
    match form % form::QUASI_LINEAR {
        form::ONE => Some(1),
        form::TWO => Some(2),
        form::THREE => Some(3),
        _ => None,
    }
}

/// Whether what relaxes in `form` is the spring's force by its own law.
const fn is_quasi_linear(form: usize) -> bool {
    form >= form::QUASI_LINEAR && form < form::ANEW
}

/// Branches that a power law of time is made of, and the factor between their times: six decades in all. At an exponent of 0.25 the
/// sum of exponentials swings by 1.6 thousandths about the power law (Poisson's sum: 2 |Gamma(a + 2 pi i / ln factor)| / Gamma(a)).
const POWER_BRANCHES: usize = 10;
const POWER_SPACING: f64 = 4.641_588_833_612_779;

/// Parts of the step by which rows are as far apart as the last two: what a clock's digits round.
const SAME_STEP: f64 = 1e-9;

/// What the state holds: the strained quantity an instant ago; whether there was one; the step that the decays are of; the first
/// branch's weight in a power law and the factor from one to the next; the branches; their decays in a step.
mod slot {
    pub const STRAINED: usize = 0;
    pub const BEGUN: usize = 1;
    pub const STEP: usize = 2;
    pub const WEIGHT: usize = 3;
    pub const FACTOR: usize = 4;
    pub const BRANCHES: usize = 5;
    pub const DECAYS: usize = BRANCHES + super::POWER_BRANCHES;
}

/// A sum of Maxwell branches along a motion.
struct Branches<'a> {
    state: &'a mut EffectState,
    /// Change of what is strained, depth or spring's force.
    moved: f64,
    step: f64,
    /// Whether the decays that are held are of another step.
    is_new: bool,
}

impl<'a> Branches<'a> {
    /// At an instant at which what is strained is `strained`.
    fn at(state: &'a mut EffectState, strained: f64, step: f64) -> Self {
        let has_begun = state[slot::BEGUN] != 0.0;
        let moved = if has_begun { strained - state[slot::STRAINED] } else { 0.0 };
        let is_new = !has_begun || (step - state[slot::STEP]).abs() > SAME_STEP * step;
        (state[slot::STRAINED], state[slot::BEGUN]) = (strained, 1.0);
        if is_new {
            state[slot::STEP] = step;
        }
        Self { state, moved, step, is_new }
    }

    /// Force of branch `nth`: exact for a motion that is straight within the step.
    fn branch(&mut self, nth: usize, stiffness: f64, time: f64) -> f64 {
        let ratio = if time > 0.0 { self.step / time } else { f64::INFINITY };
        if self.is_new {
            self.state[slot::DECAYS + nth] = (-ratio).exp();
        }
        let decay = self.state[slot::DECAYS + nth];
        // Where the difference of the quotient has no digits left its series has them all.
        let mean = if ratio > 1e-5 { (1.0 - decay) / ratio } else { 1.0 - 0.5 * ratio };
        let force = &mut self.state[slot::BRANCHES + nth];
        *force = *force * decay + stiffness * self.moved * mean;
        *force
    }

    /// Nothing has been strained yet.
    fn forget(&mut self) {
        self.moved = 0.0;
        self.state[slot::BRANCHES..slot::DECAYS].fill(0.0);
    }

    /// Force of a memory `size (t / reference)^-exponent`: t^-a = integral tau^-a exp(-t / tau) d ln(tau) / Gamma(a), in equal steps of
    /// ln(tau) about `reference`.
    fn power_law(&mut self, size: f64, exponent: f64, reference: f64) -> f64 {
        let first = POWER_SPACING.powf(-0.5 * (POWER_BRANCHES - 1) as f64);
        if self.is_new {
            self.state[slot::WEIGHT] = POWER_SPACING.ln() / libm::tgamma(exponent) * first.powf(-exponent);
            self.state[slot::FACTOR] = POWER_SPACING.powf(-exponent);
        }
        let (mut weight, factor) = (size * self.state[slot::WEIGHT], self.state[slot::FACTOR]);
        let mut time = reference * first;
        let mut force = 0.0;
        for nth in 0..POWER_BRANCHES {
            force += self.branch(nth, weight, time);
            weight *= factor;
            time *= POWER_SPACING;
        }
        force
    }
}

impl Effect for StressRelaxation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn builds_on(&self, form: usize) -> &'static [Foundation] {
        const LAWS: [Foundation; 3] = [
            Foundation::any_form("nonlinear_stiffness"),
            Foundation::any_form("layered_stiffness"),
            Foundation::any_form("plastic_set"),
        ];
        if is_quasi_linear(form) { &LAWS } else { &[] }
    }

    fn simpler(&self, form: usize, values: &[f64], stiffness: f64) -> Option<(usize, Vec<f64>)> {
        let mut values = values.to_vec();
        (0..branches(form).unwrap_or(1)).for_each(|nth| values[2 * nth] *= stiffness);
        is_quasi_linear(form).then(|| (form - form::QUASI_LINEAR, values))
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // Where nothing is touched twice both kinds of memory are one.
        if form >= form::ANEW && scene.releases == 0 {
            return Vec::new();
        }
        let size = if is_quasi_linear(form) { 0.2 } else { 0.2 * scene.stiffness };
        let times = geometric(2.0 * scene.step, scene.duration, 10);
        // Branches whose times are as far apart, by factors.
        let spread = |count: usize, apart: usize| {
            let times = &times;
            (0..times.len().saturating_sub((count - 1) * apart)).map(move |first| {
                let branch = |nth: usize| [size, times[first + nth * apart]];
                let sizes: Vec<usize> = (0..count).map(|nth| 2 * nth).collect();
                Start::sized(&(0..count).flat_map(branch).collect::<Vec<f64>>(), &sizes)
            })
        };
        match branches(form) {
            Some(1) => spread(1, 0).collect(),
            Some(2) => [2, 4, 6, 8].into_iter().flat_map(|apart| spread(2, apart)).collect(),
            Some(count) => [2, 3, 4].into_iter().flat_map(|apart| spread(count, apart)).collect(),
            None => {
                let middle = (2.0 * scene.step * scene.duration).sqrt();
                [0.1, 0.3, 0.6].iter().map(|exponent| Start::sized(&[size, *exponent, middle], &[0])).collect()
            }
        }
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        let strained = if is_quasi_linear(form) { touch.spring } else { touch.depth };
        let mut memory = Branches::at(state, strained, touch.step);
        if form >= form::ANEW && touch.inside == 0.0 {
            memory.forget();
        }
        touch.extra += match branches(form) {
            Some(count) => (0..count).map(|nth| memory.branch(nth, values[2 * nth], values[2 * nth + 1])).sum(),
            None => memory.power_law(values[0], values[1], values[2]),
        };
    }
}
