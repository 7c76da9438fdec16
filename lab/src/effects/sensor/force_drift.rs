//! A zero that wanders.

use crate::effects::{Card, Effect, Form, Parameter, Place, Reading, Scene, Stage, Start};
use crate::rig::Word;

/// See [`CARD`].
pub struct ForceDrift;

static CARD: Card = Card {
    name: "force_drift",
    place: Place::Sensor,
    stage: Stage::Zero,
    most: 1,
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
    ],
    excited_by: "free motion early and late",
    resembles: &["force_bias", "time_varying_stiffness", "surface_motion"],
    source: "warming of a strain-gauge bridge",
};

impl Effect for ForceDrift {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, form: usize, scene: &Scene) -> Vec<Start> {
        // In one contact without a free moment after it, a drift is anything that grows with depth.
        if !scene.tells_time() && scene.free_span < 0.5 {
            return Vec::new();
        }
        let size = 0.01 * scene.force;
        let rate = size / scene.duration;
        if form == 0 { vec![Start::sized(&[rate], &[0])] } else { vec![Start::sized(&[rate, size], &[0, 1])] }
    }

    fn read(&self, form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let offset = if form == 0 { 0.0 } else { values[1] };
        for (at, force) in reading.force.iter_mut().enumerate() {
            *force += values[0] * (reading.start + at as f64 * reading.step) + offset;
        }
    }
}
