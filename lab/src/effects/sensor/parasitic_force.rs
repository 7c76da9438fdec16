//! A force at the sensor that is not the contact's.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start};
use crate::rig::Word;

/// See [`SPEC`]. Found by its name alone: what pulls is not known by it, and no search for an effect asks for it.
pub struct ParasiticForce;

/// Index of the form by the position.
pub const PARASITIC_BY_PLACE: usize = 0;

/// Index of the form by the velocity.
pub const PARASITIC_BY_SPEED: usize = 1;

const fn force(name: &'static str, meaning: &'static str) -> Parameter {
    Parameter::new(name, Word::new("N", "N m"), meaning, f64::NEG_INFINITY, f64::INFINITY)
}

static SPEC: EffectSpec = EffectSpec {
    name: "parasitic_force",
    place: Place::Sensor,
    stage: Stage::Mount,
    max_instances: 1,
    statement: "The force sensor feels a force that is there before anything is touched, and goes with the place or the speed",
    forms: &[
        Form {
            name: "by_place",
            equation: "reading = F + constant + linear q + square q^2 + cubic q^3, q = (x - origin) / length",
            parameters: &[
                Parameter::fixed("origin", Word::new("m", "rad"), "position at which q is zero"),
                Parameter::fixed("length", Word::new("m", "rad"), "length over which q grows by one"),
                force("constant", "force at the origin"),
                force("linear", "of q"),
                force("square", "of q^2"),
                force("cubic", "of q^3"),
            ],
        },
        Form {
            name: "by_speed",
            equation: "reading = F + linear q + square q |q|, q = v / speed",
            parameters: &[
                Parameter::fixed("speed", Word::new("m/s", "rad/s"), "speed at which q is one"),
                force("linear", "of q"),
                force("square", "of q |q|"),
            ],
        },
    ],
    excited_by: "free motion over all of the way, at all speeds",
    resembles: &["force_bias", "layered_stiffness", "quadratic_damping", "tool_inertia"],
    source: "a cable, a hose or water at the tool: a cubic of the place, linear and quadratic drag of the speed",
};

impl Effect for ParasiticForce {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, _scene: &ExcitationStats) -> Vec<Start> {
        Vec::new()
    }

    fn act_on_reading(&self, form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let motion = reading.position.iter().zip(reading.velocity);
        for (force, (position, velocity)) in reading.force.iter_mut().zip(motion) {
            *force += parasitic_force(form, values, *position, *velocity);
        }
    }
}

/// What the sensor feels at `position` and `velocity` by form `form` with `values`, N or N m.
fn parasitic_force(form: usize, values: &[f64], position: f64, velocity: f64) -> f64 {
    let (q, constant, parts) = if form == PARASITIC_BY_PLACE {
        ((position - values[0]) / values[1], values[2], &values[3..])
    } else {
        (velocity / values[0], 0.0, &values[1..])
    };
    constant + parts.iter().zip(parasitic_powers(form, q)).map(|(part, power)| part * power).sum::<f64>()
}

/// What the parts of form `form` are multiplied with at `q`: `q, q^2, q^3` of the place, or `q, q |q|` of the speed, and zero.
#[must_use]
pub fn parasitic_powers(form: usize, q: f64) -> [f64; 3] {
    if form == PARASITIC_BY_PLACE { [q, q * q, q.powi(3)] } else { [q, q * q.abs(), 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: a cable of 0.3 N + 2 q + q^2 - q^3 with q = 1/2 at 5 mm, and water that drags by 2 q + 3 q |q| with q = -1/2.
    #[test]
    fn a_cable_and_water_add_their_polynomials() {
        let cable = parasitic_force(PARASITIC_BY_PLACE, &[4e-3, 2e-3, 0.3, 2.0, 1.0, -1.0], 5e-3, 7.0);
        assert!((cable - (0.3 + 1.0 + 0.25 - 0.125)).abs() < 1e-12, "{cable} N");
        let water = parasitic_force(PARASITIC_BY_SPEED, &[0.2, 2.0, 3.0], 7.0, -0.1);
        assert!((water - (-1.0 - 0.75)).abs() < 1e-12, "{water} N");
    }
}
