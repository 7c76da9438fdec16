//! A zero that wanders.

use crate::effects::{
    Effect, EffectSpec, ExcitationStats, Form, Limit, Parameter, Place, Reading, Stage, Start, geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ForceDrift;

/// Instants at which a wandering zero has a value.
const KNOTS: usize = 8;

const fn knot(name: &'static str) -> Parameter {
    Parameter::new(name, Word::new("N", "N m"), "zero at this eighth of the span", f64::NEG_INFINITY, f64::INFINITY)
        .each_trial()
}

static SPEC: EffectSpec = EffectSpec {
    name: "force_drift",
    place: Place::Sensor,
    stage: Stage::Zero,
    max_instances: 1,
    statement: "The zero of the force sensor wanders as time goes by",
    forms: &[
        Form {
            name: "ramp",
            equation: "reading = F + rate t",
            parameters: &[Parameter::new(
                "rate",
                Word::new("N/s", "N m/s"),
                "drift of the zero",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
        Form {
            name: "offset_ramp",
            equation: "reading = F + rate t + offset",
            parameters: &[
                Parameter::new(
                    "rate",
                    Word::new("N/s", "N m/s"),
                    "drift of the zero",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::new(
                    "offset",
                    Word::new("N", "N m"),
                    "zero when the trial began",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "settling",
            equation: "reading = F + settled (1 - exp(-t / time_constant))",
            parameters: &[
                Parameter::new(
                    "settled",
                    Word::new("N", "N m"),
                    "where the zero comes to rest",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::new("time_constant", Word::same("s"), "of its coming to rest", 0.0, f64::INFINITY)
                    .within(Limit::ResolvableTime),
            ],
        },
        Form {
            name: "wandering",
            equation: "reading = F + straight lines between zero_1 ... zero_8, equally apart over span",
            parameters: &[
                knot("zero_1"),
                knot("zero_2"),
                knot("zero_3"),
                knot("zero_4"),
                knot("zero_5"),
                knot("zero_6"),
                knot("zero_7"),
                knot("zero_8"),
                Parameter::fixed("span", Word::same("s"), "from the first of them to the last"),
            ],
        },
    ],
    excited_by: "free motion early and late",
    resembles: &["force_bias", "time_varying_stiffness", "surface_motion"],
    source: "warming of a strain-gauge bridge",
};

impl Effect for ForceDrift {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // In one contact without a free moment after it, a drift is anything that grows with depth.
        if !scene.separates_time_from_depth() && scene.free_span < 0.5 {
            return Vec::new();
        }
        let size = 0.01 * scene.force;
        let rate = size / scene.duration;
        match form {
            0 => vec![Start::sized(&[rate], &[0])],
            1 => vec![Start::sized(&[rate, size], &[0, 1])],
            // Seen in free motion alone: where no knot goes without. In contact a curve of eight knots is anything that takes time.
            3 if scene.shows_sensor_zero() && scene.longest_contact < 2.0 / (KNOTS - 1) as f64 && scene.visits >= 2 => {
                let mut values = vec![size; KNOTS];
                values.push(scene.duration);
                vec![Start::sized(&values, &[0, 1, 2, 3, 4, 5, 6, 7])]
            }
            3 => Vec::new(),
            // Much slower is a ramp, much quicker an offset.
            _ => geometric(0.1, 1.0, 4).iter().map(|part| Start::sized(&[size, part * scene.duration], &[0])).collect(),
        }
    }

    /// A zero that is off from the start and does not move is a bias.
    fn special_case(&self, form: usize, values: &[f64]) -> Option<(&'static str, usize, Vec<f64>)> {
        (form == 1).then(|| ("force_bias", 0, vec![values[1]]))
    }

    fn act_on_reading(&self, form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let zero = |time: f64| match form {
            0 => values[0] * time,
            1 => values[0] * time + values[1],
            3 => {
                let place =
                    (time / values[KNOTS].max(f64::MIN_POSITIVE) * (KNOTS - 1) as f64).clamp(0.0, (KNOTS - 1) as f64);
                let before = (place as usize).min(KNOTS - 2);
                let part = place - before as f64;
                values[before] * (1.0 - part) + values[before + 1] * part
            }
            _ => -values[0] * (-time / values[1].max(f64::MIN_POSITIVE)).exp_m1(),
        };
        for (at, force) in reading.force.iter_mut().enumerate() {
            *force += zero(reading.start + at as f64 * reading.step);
        }
    }
}
