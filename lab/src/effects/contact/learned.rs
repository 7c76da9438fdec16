//! A force that no law of the list explains, as a curve over depth and direction.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`]. Found by its name alone: it is no physics, and no search asks for it.
pub struct Learned;

/// Knots of each curve of the form that is fitted.
pub const LEARNED_KNOTS: usize = 24;

/// Index of that form.
pub const LEARNED_FORM: usize = 1;

const fn force(name: &'static str, meaning: &'static str) -> Parameter {
    Parameter::new(name, Word::new("N", "N m"), meaning, f64::NEG_INFINITY, f64::INFINITY)
}

const fn place(name: &'static str) -> Parameter {
    Parameter::fixed(name, Word::new("m", "rad"), "place of the knot, from the surface inwards; in rising order")
}

const TURN: Parameter = Parameter::new(
    "turn",
    Word::new("m", "rad"),
    "half the travel over which the force goes from one path to the other after a reversal",
    0.0,
    f64::INFINITY,
);

const MEAN: &str = "force midway between the paths in and out";
const LOOP: &str = "half the distance of the path in from the path out";

/// The parameters of a form with the knots of these numbers.
macro_rules! knots {
    ($($number:literal)*) => {
        &[
            TURN,
            $(place(concat!("place_", $number)),)*
            $(force(concat!("mean_", $number), MEAN),)*
            $(force(concat!("loop_", $number), LOOP),)*
        ]
    };
}

static SPEC: EffectSpec = EffectSpec {
    name: "learned",
    place: Place::Contact,
    stage: Stage::Limit,
    max_instances: 1,
    statement: "What no law of the list explains, as a curve over depth and direction",
    forms: &[
        Form {
            name: "depth_and_direction",
            equation: "F = F_law + mean(x) + loop(x) z, dz = dx / turn within -1 <= z <= 1, straight between 12 knots",
            parameters: knots!("01" "02" "03" "04" "05" "06" "07" "08" "09" "10" "11" "12"),
        },
        Form {
            name: "depth_and_direction_24",
            equation: "F = F_law + mean(x) + loop(x) z, dz = dx / turn within -1 <= z <= 1, straight between 24 knots",
            parameters: knots!(
                "01" "02" "03" "04" "05" "06" "07" "08" "09" "10" "11" "12"
                "13" "14" "15" "16" "17" "18" "19" "20" "21" "22" "23" "24"
            ),
        },
    ],
    excited_by: "contacts to all depths that matter, in and out",
    resembles: &["layered_stiffness", "nonlinear_stiffness", "hysteresis"],
    source: "linear splines (C. de Boor, A Practical Guide to Splines, 1978) through an elastic slip (L. Prandtl, 1928)",
};

impl Effect for Learned {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, _scene: &ExcitationStats) -> Vec<Start> {
        Vec::new()
    }

    fn act_on_contact(&self, _form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: position an instant ago, z, whether there was an instant.
        let moved = if state[2] > 0.0 { touch.position - state[0] } else { 0.0 };
        state[0] = touch.position;
        state[1] = (state[1] + moved / values[0].max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
        state[2] = 1.0;
        let knots = (values.len() - 1) / 3;
        let (places, forces) = values[1..].split_at(knots);
        let (mean, half) = forces.split_at(knots);
        let x = touch.position;
        touch.force += curve(places, mean, x) + state[1] * curve(places, half, x);
    }
}

/// The broken line through `knots`, which lie at `places` in rising order, at `x`; beyond them it goes on level.
#[must_use]
pub fn curve(places: &[f64], knots: &[f64], x: f64) -> f64 {
    let after = places.partition_point(|place| *place <= x);
    match (after.checked_sub(1), places.get(after)) {
        (None, _) => knots[0],
        (Some(before), None) => knots[before],
        (Some(before), Some(next)) => {
            let part = (x - places[before]) / (next - places[before]);
            knots[before] * (1.0 - part) + knots[after] * part
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_its_knots_and_is_level_beyond_them() {
        let places: Vec<f64> = (0..12).map(|knot| f64::from(knot).powi(2)).collect();
        let knots: Vec<f64> = (0..12).map(|knot| f64::from(knot).powi(3)).collect();
        for (place, force) in places.iter().zip(&knots) {
            assert!((curve(&places, &knots, *place) - force).abs() < 1e-9);
        }
        assert_eq!((curve(&places, &knots, -3.0), curve(&places, &knots, 700.0)), (0.0, 1331.0));
        assert!((curve(&places, &knots, 6.5) - 17.5).abs() < 1e-9, "midway between 8 at 4 and 27 at 9");
    }
}
