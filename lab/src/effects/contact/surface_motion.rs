//! A surface that moves by itself.

use std::f64::consts::TAU;

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, FrequencySearch, Limit, Parameter, Place,
    Stage, Start, ToneWeight,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct SurfaceMotion;

const METRE: Word = Word::new("m", "rad");

static SPEC: EffectSpec = EffectSpec {
    name: "surface_motion",
    place: Place::Contact,
    stage: Stage::Geometry,
    max_instances: 1,
    statement: "What is touched moves by itself, as a breathing patient does",
    forms: &[
        Form {
            name: "wave",
            equation: "surface(t) = surface + sine sin(2 pi frequency t) + cosine cos(2 pi frequency t)",
            parameters: &[
                Parameter::new("sine", METRE, "part of the motion", f64::NEG_INFINITY, f64::INFINITY).each_trial(),
                Parameter::new("cosine", METRE, "part of the motion", f64::NEG_INFINITY, f64::INFINITY).each_trial(),
                Parameter::new("frequency", Word::same("Hz"), "of the motion", 0.0, f64::INFINITY)
                    .within(Limit::RepeatedCycles),
            ],
        },
        Form {
            name: "drift",
            equation: "surface(t) = surface + drift t",
            parameters: &[Parameter::new(
                "drift",
                Word::new("m/s", "rad/s"),
                "speed of the surface, positive away from the tool",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
    ],
    excited_by: "long holds in contact at two depths",
    resembles: &["mains_hum", "force_drift", "time_varying_stiffness"],
    source: "a moving boundary; breathing at 0.2 to 0.3 Hz, heart beat at 1 Hz",
};

impl Effect for SurfaceMotion {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let size = 0.01 * scene.depth;
        if form == 0 || !scene.separates_time_from_depth() {
            Vec::new()
        } else {
            vec![Start::sized(&[size / scene.duration], &[0])]
        }
    }

    fn frequency_search(&self, form: usize, scene: &ExcitationStats) -> Option<FrequencySearch> {
        // Half a turn a trial apart, up to the shaking of a table or what the rows resolve: nothing falls between two of them.
        let most = (30.0 * scene.duration).min(0.1 * scene.duration / scene.step).clamp(2.0, 1000.0);
        (form == 0 && scene.separates_time_from_depth()).then(|| FrequencySearch {
            weight: ToneWeight::Inside,
            frequencies: vec![(2.0 / scene.duration, 0.5 / scene.duration, (2.0 * most) as usize)],
            size: 0.01 * scene.depth,
        })
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let (moved, rate) = if form == 0 {
            let pulse = TAU * values[2];
            let (sine, cosine) = (pulse * touch.time).sin_cos();
            (values[0] * sine + values[1] * cosine, pulse * (values[0] * cosine - values[1] * sine))
        } else {
            (values[0] * touch.time, values[0])
        };
        touch.position -= moved;
        touch.velocity -= rate;
    }
}
