//! A force that goes with the speed in contact as no law of the list does, as a curve.

use super::learned::curve;
use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`]. Found by its name alone: it is no physics, and no search asks for it.
pub struct LearnedDamping;

/// Knots of the curve.
pub const DAMPING_KNOTS: usize = 9;

/// Index of the form that is the same at any depth.
pub const DAMPING_BY_SPEED: usize = 0;

/// Index of the form that grows with the depth.
pub const DAMPING_BY_SPEED_AND_DEPTH: usize = 1;

const fn speed(name: &'static str) -> Parameter {
    Parameter::fixed(name, Word::new("m/s", "rad/s"), "speed of the knot, inwards; in rising order")
}

const fn force(name: &'static str) -> Parameter {
    let meaning = "force at this speed beside the damping";
    Parameter::new(name, Word::new("N", "N m"), meaning, f64::NEG_INFINITY, f64::INFINITY)
}

const DEPTH: Parameter = Parameter::fixed(
    "depth",
    Word::new("m", "rad"),
    "depth at which the forces are as stated; at others in proportion",
);

/// The parameters of a form with the knots of these numbers, behind those that are given first.
macro_rules! knots {
    ($($first:expr),*; $($number:literal)*) => {
        &[$($first,)* $(speed(concat!("speed_", $number)),)* $(force(concat!("force_", $number)),)*]
    };
}

static SPEC: EffectSpec = EffectSpec {
    name: "learned_damping",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "What goes with the speed in contact as no law of the list does, as a curve",
    forms: &[
        Form {
            name: "speed",
            equation: "F = max(0, K x + B v + force(v)), straight between 9 knots",
            parameters: knots!(; "1" "2" "3" "4" "5" "6" "7" "8" "9"),
        },
        Form {
            name: "speed_and_depth",
            equation: "F = max(0, K x + B v + force(v) x / depth), straight between 9 knots",
            parameters: knots!(DEPTH; "1" "2" "3" "4" "5" "6" "7" "8" "9"),
        },
    ],
    excited_by: "contacts at all speeds that matter, in and out",
    resembles: &["quadratic_damping", "hunt_crossley_damping", "hysteresis"],
    source: "a linear spline (C. de Boor, A Practical Guide to Splines, 1978)",
};

impl Effect for LearnedDamping {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, _scene: &ExcitationStats) -> Vec<Start> {
        Vec::new()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let (part, knots) = match form {
            DAMPING_BY_SPEED_AND_DEPTH => (touch.depth / values[0], &values[1..]),
            _ => (touch.inside, values),
        };
        let (speeds, forces) = knots.split_at(DAMPING_KNOTS);
        touch.extra += part * curve(speeds, forces, touch.velocity);
    }
}
