//! A tone that is always there.

use std::f64::consts::TAU;

use crate::effects::{
    Effect, EffectSpec, ExcitationStats, Form, FrequencySearch, Parameter, Place, Reading, Stage, Start, ToneWeight,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct MainsHum;

/// Frequencies of mains, Hz.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];

/// Part by which they may be off: what EN 50160 allows a network that stands alone, for 95 % of a week. A recorder's own clock is better.
pub const MAINS_TOLERANCE: f64 = 0.02;

/// Frequencies that are tried on either side of each: those of a minute.
const MOST_TRIED: f64 = 240.0;

const NEWTON: Word = Word::new("N", "N m");

static SPEC: EffectSpec = EffectSpec {
    name: "mains_hum",
    place: Place::Sensor,
    stage: Stage::Zero,
    max_instances: 1,
    statement: "The force reading carries a tone, in contact and out of it",
    forms: &[Form {
        name: "tone",
        equation: "reading = F + sine sin(2 pi frequency t) + cosine cos(2 pi frequency t)",
        parameters: &[
            Parameter::new("sine", NEWTON, "part of the tone", f64::NEG_INFINITY, f64::INFINITY).each_trial(),
            Parameter::new("cosine", NEWTON, "part of the tone", f64::NEG_INFINITY, f64::INFINITY).each_trial(),
            Parameter::new("frequency", Word::same("Hz"), "of the tone", 0.0, f64::INFINITY),
        ],
    }],
    excited_by: "nothing: it is there at rest",
    resembles: &["surface_motion"],
    source: "50 or 60 Hz mains and what it beats with",
};

impl Effect for MainsHum {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, _scene: &ExcitationStats) -> Vec<Start> {
        Vec::new()
    }

    fn frequency_search(&self, _form: usize, scene: &ExcitationStats) -> Option<FrequencySearch> {
        // Over a long trial what the mains may be off by is many turns.
        let apart = 0.25 / scene.duration;
        let band = |mains: f64| {
            let most = (MAINS_TOLERANCE * mains / apart).ceil().clamp(2.0, MOST_TRIED);
            (mains - most * apart, apart, 2 * most as usize + 1)
        };
        let frequencies: Vec<_> = MAINS_HZ.into_iter().filter(|mains| *mains < 0.42 / scene.step).map(band).collect();
        let size = 0.01 * scene.force;
        (!frequencies.is_empty()).then_some(FrequencySearch {
            weight: ToneWeight::Even,
            frequencies,
            size,
            harmonics: 1,
        })
    }

    fn lines(&self) -> &'static [f64] {
        &MAINS_HZ
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        let left = reading.passes(values[2]);
        for (at, force) in reading.force.iter_mut().enumerate() {
            let (sine, cosine) = (TAU * values[2] * (reading.start + at as f64 * reading.step)).sin_cos();
            *force += left * (values[0] * sine + values[1] * cosine);
        }
    }
}
