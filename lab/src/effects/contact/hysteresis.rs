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
        let third = [None, Some(1.0), Some(3.0), None][form];
        let start = |travel: &f64| {
            let values: Vec<f64> = [size, *travel].into_iter().chain(third).collect();
            Start::sized(&values, &[0])
        };
        travels.iter().map(start).collect()
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
            0 => {
                state[1] = (state[1] + moved / travel).clamp(-1.0, 1.0);
                state[1]
            }
            1 => {
                state[1] = bouc_wen(state[1], moved / travel, values[2]);
                state[1]
            }
            3 => {
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
        touch.extra += values[0] * strain * touch.inside;
    }
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
}
