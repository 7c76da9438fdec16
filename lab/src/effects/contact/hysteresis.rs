//! A loop that does not ask how fast.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start,
    geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Hysteresis;

const LOOP_FORCE: Parameter =
    Parameter::new("loop_force", Word::new("N", "N m"), "half the width of the loop", 0.0, f64::INFINITY);
const YIELD_DEPTH: Parameter = Parameter::new(
    "yield_depth",
    Word::new("m", "rad"),
    "travel over which the force turns after a reversal",
    0.0,
    f64::INFINITY,
)
.within(Limit::VisitedDepth);

const LENGTH: Word = Word::new("m", "rad");
const END_DEPTH: Parameter =
    Parameter::new("end_depth", LENGTH, "depth down to which there is a loop", 0.0, f64::INFINITY);
const TRANSITION: Parameter =
    Parameter::new("transition", LENGTH, "depth over which the loop grows or goes by e", 0.0, f64::INFINITY);

/// Indices of the forms.
mod form {
    pub const SLIP: usize = 0;
    pub const BOUC_WEN: usize = 1;
    pub const BUNDLE: usize = 2;
    pub const DAHL: usize = 3;
    pub const DOWN_TO: usize = 4;
    pub const BETWEEN: usize = 5;
}

/// Index of the form with one elastic slip all the way; [`HYSTERESIS_BETWEEN`] is that of one on a stretch of it.
pub const HYSTERESIS_SLIP: usize = form::SLIP;
/// See [`HYSTERESIS_SLIP`].
pub const HYSTERESIS_BETWEEN: usize = form::BETWEEN;

static SPEC: EffectSpec = EffectSpec {
    name: "hysteresis",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "The force going in is larger than coming out, however slowly the tool moves",
    forms: &[
        Form {
            name: "elastic_slip",
            equation: "F = K x + B v + loop_force z, dz = dx / yield_depth within -1 <= z <= 1",
            parameters: &[LOOP_FORCE, YIELD_DEPTH],
        },
        Form {
            name: "bouc_wen",
            equation: "F = K x + B v + loop_force z, dz = (1 - |z|^sharpness (1 + sign(z dx)) / 2) dx / yield_depth",
            parameters: &[
                LOOP_FORCE,
                YIELD_DEPTH,
                Parameter::new("sharpness", Word::same("1"), "how suddenly it yields", 0.3, 6.0),
            ],
        },
        Form {
            name: "bundle",
            equation: "F = K x + B v + loop_force mean(z), five elastic slips of yields from yield_depth / spread to yield_depth spread",
            parameters: &[
                LOOP_FORCE,
                YIELD_DEPTH,
                Parameter::new("spread", Word::same("1"), "of the yields, in equal ratios", 1.0, 30.0),
            ],
        },
        // At one speed this is the force of a Maxwell branch: what distinguishes the two is another speed, or a hold.
        Form {
            name: "dahl",
            equation: "F = K x + B v + loop_force z, dz = (1 - z sign(dx)) dx / yield_depth",
            parameters: &[LOOP_FORCE, YIELD_DEPTH],
        },
        // A part that rubs only on a stretch of the way, as a slider on a leaf spring.
        Form {
            name: "down_to_a_depth",
            equation: "F = K x + B v + loop_force w(x) z, z as elastic_slip, w = 1 / (1 + exp((x - end_depth) / transition))",
            parameters: &[LOOP_FORCE, YIELD_DEPTH, END_DEPTH, TRANSITION],
        },
        Form {
            name: "between_depths",
            equation: "F = K x + B v + loop_force w(x) z, z as elastic_slip, w = 1 / (1 + exp((x - end_depth) / transition)) - 1 / (1 + exp((x - begin_depth) / transition))",
            parameters: &[
                LOOP_FORCE,
                YIELD_DEPTH,
                END_DEPTH,
                TRANSITION,
                Parameter::new(
                    "begin_depth",
                    LENGTH,
                    "depth from which on there is a loop",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "reversals at two or more speeds in contact, slow ones above all",
    resembles: &["plastic_set", "lost_motion", "quadratic_damping", "stress_relaxation"],
    source: "L. Prandtl (1928), W. D. Iwan, J. Appl. Mech. 33 (1966) 893: elastic slip, alone and in a bundle; P. R. Dahl, AIAA J. 14 (1976) 1675; R. Bouc (1967), Y.-K. Wen, J. Eng. Mech. Div. 102 (1976) 249",
};

impl Effect for Hysteresis {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if !scene.has_unloading() {
            return Vec::new();
        }
        let size = 0.05 * scene.stiffness * scene.depth;
        let travels = geometric(0.01 * scene.depth, 0.9 * scene.depth, 7);
        let third = match form {
            form::BOUC_WEN => Some(1.0),
            form::BUNDLE => Some(3.0),
            form::SLIP | form::DAHL => None,
            // From a loop all the way, which is refined.
            _ => return Vec::new(),
        };
        let start = |travel: &f64| {
            let values: Vec<f64> = [size, *travel].into_iter().chain(third).collect();
            Start::sized(&values, &[0])
        };
        travels.iter().map(start).collect()
    }

    fn refined(&self, form: usize, values: &[f64], scene: &ExcitationStats) -> Option<(usize, Vec<Vec<f64>>)> {
        let depth = scene.depth;
        match form {
            form::SLIP => {
                let to = |end: &f64| vec![values[0], values[1], end * depth, STRETCH_TRANSITION * depth];
                Some((form::DOWN_TO, STRETCH_ENDS.iter().map(to).collect()))
            }
            form::DOWN_TO => {
                let begins = STRETCH_BEGINS.iter().map(|part| part * values[2]);
                let from = |begin: f64| values.iter().copied().chain([begin]).collect();
                Some((form::BETWEEN, begins.map(from).collect()))
            }
            _ => None,
        }
    }

    fn may_fall(&self, form: usize) -> bool {
        form >= form::DOWN_TO
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: depth an instant ago, z of each spring.
        let moved = touch.depth - state[0];
        state[0] = touch.depth;
        let travel = values[1].max(f64::MIN_POSITIVE);
        // What was strained is at rest again when the tool comes back.
        if touch.inside <= 0.0 || touch.step <= 0.0 {
            state[1..].fill(0.0);
            return;
        }
        let strain = match form {
            form::SLIP | form::DOWN_TO | form::BETWEEN => {
                state[1] = (state[1] + moved / travel).clamp(-1.0, 1.0);
                state[1]
            }
            form::BOUC_WEN => {
                state[1] = bouc_wen(state[1], moved / travel, values[2]);
                state[1]
            }
            form::DAHL => {
                state[1] = dahl(state[1], moved / travel);
                state[1]
            }
            _ => {
                let middle = 0.5 * (JENKIN_ELEMENTS - 1) as f64;
                for (at, spring) in state[1..=JENKIN_ELEMENTS].iter_mut().enumerate() {
                    let reach = travel * values[2].powf((at as f64 - middle) / middle);
                    *spring = (*spring + moved / reach).clamp(-1.0, 1.0);
                }
                state[1..=JENKIN_ELEMENTS].iter().sum::<f64>() / JENKIN_ELEMENTS as f64
            }
        };
        let there = if form >= form::DOWN_TO { presence(&values[2..], touch.depth.abs()) } else { 1.0 };
        touch.extra += values[0] * strain * there * touch.inside;
    }
}

/// Of the greatest depth: where a loop ends and over what it does, at the start of a search; and of its end: where it begins.
const STRETCH_ENDS: [f64; 4] = [0.3, 0.5, 0.7, 0.9];
const STRETCH_TRANSITION: f64 = 0.05;
const STRETCH_BEGINS: [f64; 4] = [0.05, 0.25, 0.5, 0.75];

/// Part of the loop that is there at `depth`: `stretch` is its end, the transition and, where it has one, its beginning.
fn presence(stretch: &[f64], depth: f64) -> f64 {
    let transition = stretch[1].max(f64::MIN_POSITIVE);
    let above = |boundary: f64| 1.0 / (1.0 + ((depth - boundary) / transition).exp());
    above(stretch[0]) - stretch.get(2).map_or(0.0, |begin| above(*begin))
}

/// Springs of a bundle.
const JENKIN_ELEMENTS: usize = 5;

/// Strain after a way of `moved` yield depths.
fn bouc_wen(mut strain: f64, moved: f64, sharpness: f64) -> f64 {
    if moved.abs() > SATURATION_YIELDS {
        return moved.signum();
    }
    let steps = (moved.abs() / YIELDS_PER_STEP).ceil().max(1.0);
    for _ in 0..steps as usize {
        let into = if moved * strain > 0.0 { strain.abs().powf(sharpness) } else { 0.0 };
        strain = (strain + moved / steps * (1.0 - into)).clamp(-1.0, 1.0);
    }
    strain
}

/// Strain after a way of `moved` yield depths in one direction, exactly.
fn dahl(strain: f64, moved: f64) -> f64 {
    let end = moved.signum();
    end + (strain - end) * (-moved.abs()).exp()
}

/// Yield depths beyond which nothing of the state before is left.
const SATURATION_YIELDS: f64 = 12.0;

/// Yield depths of one step of the integration.
const YIELDS_PER_STEP: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dahls_loop_turns_as_its_solution_says_however_it_is_stepped() {
        // In from rest: z = 1 - e^-x; back from z0: z = -1 + (z0 + 1) e^-x.
        let (mut fine, mut coarse) = (0.0, 0.0);
        for _ in 0..300 {
            fine = dahl(fine, 0.01);
        }
        for _ in 0..3 {
            coarse = dahl(coarse, 1.0);
        }
        let there = 1.0 - (-3.0f64).exp();
        assert!((fine - there).abs() < 1e-12 && (coarse - there).abs() < 1e-12, "{fine} {coarse} {there}");
        let back = dahl(coarse, -0.5);
        assert!((back - (-1.0 + (there + 1.0) * (-0.5f64).exp())).abs() < 1e-12, "{back}");
    }

    /// In and out of a contact in which a part rubs between one and two millimetres: both ways are one outside of these.
    #[test]
    fn a_loop_on_a_stretch_of_the_way_is_there_and_nowhere_else() {
        let contact = crate::rig::Contact { surface: 0.0, stiffness: 500.0, damping: 0.0, bilateral: false };
        let values = [0.2, 1e-5, 2e-3, 2e-5, 1e-3];
        let active = crate::effects::ActiveEffect { effect: &Hysteresis, form: form::BETWEEN, values: &values };
        let mut law = crate::effects::ContactSimulator::new(contact, &[active]);
        let path: Vec<f64> = (0..=3000).chain((0..3000).rev()).map(|step| f64::from(step) * 1e-6).collect();
        let force: Vec<f64> = path.iter().map(|depth| law.step(0.0, 1.0, *depth, 0.0, 0.0, 0.0)).collect();
        // Half a loop at its ends, twice its half-width within.
        for (at, width) in [(500, 0.0), (1000, 0.2), (1500, 0.4), (2000, 0.2), (2500, 0.0)] {
            let found = force[at] - force[6000 - at];
            assert!((found - width).abs() < 1e-6, "{at}: {found} not {width}");
        }
        assert!((force[1500] - (500.0 * 1.5e-3 + 0.2)).abs() < 1e-6);
    }
}
