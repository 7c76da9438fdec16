//! A sensor at the end of its range.

use crate::effects::{
    Effect, EffectSpec, ExcitationStats, Form, Limit, Parameter, Place, Reading, Stage, Start, linear, rounded,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ForceSaturation;

const LIMIT: Parameter =
    Parameter::new("limit", Word::new("N", "N m"), "greatest reading", 0.0, f64::INFINITY).within(Limit::ReachedRange);

static SPEC: EffectSpec = EffectSpec {
    name: "force_saturation",
    place: Place::Sensor,
    stage: Stage::Range,
    max_instances: 1,
    statement: "The force sensor does not show more than a certain force",
    forms: &[
        Form { name: "symmetric", equation: "reading = F within -limit to limit", parameters: &[LIMIT] },
        Form {
            name: "rounded",
            equation: "reading = F - w ln(1 + exp((|F| - limit) / w)) sign(F), w = knee limit",
            parameters: &[
                LIMIT,
                Parameter::new(
                    "knee",
                    Word::same("1"),
                    "share of the limit over which it gives way; wider, and it is the law of the contact that bends",
                    0.0,
                    0.05,
                ),
            ],
        },
    ],
    excited_by: "deep contacts beside shallow ones",
    resembles: &["layered_stiffness", "nonlinear_stiffness"],
    source: "range of amplifier or converter",
};

impl Effect for ForceSaturation {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let limits = linear(0.4, 0.99, 10).into_iter().map(|part| part * scene.force);
        if form == 0 {
            return limits.map(|limit| Start::at(&[limit])).collect();
        }
        limits.flat_map(|limit| [0.01, 0.03].map(|part| Start::at(&[limit, part]))).collect()
    }

    fn act_on_reading(&self, form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let limit = values[0].abs();
        if form == 0 {
            reading.force.iter_mut().for_each(|force| *force = force.max(-limit).min(limit));
            return;
        }
        let knee = (values[1] * limit).max(f64::MIN_POSITIVE);
        for force in reading.force.iter_mut() {
            *force -= rounded(force.abs() - limit, knee).copysign(*force);
        }
    }
}
