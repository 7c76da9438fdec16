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

/// The tones of each form; a breath is told by two, a heart beat by three.
const HARMONICS: [usize; 3] = [1, 0, 3];

const FREQUENCY: Parameter =
    Parameter::new("frequency", Word::same("Hz"), "of the motion", 0.0, f64::INFINITY).within(Limit::RepeatedCycles);

const fn part(name: &'static str) -> Parameter {
    Parameter::new(name, METRE, "part of the motion", f64::NEG_INFINITY, f64::INFINITY).each_trial()
}

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
            parameters: &[part("sine"), part("cosine"), FREQUENCY],
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
        Form {
            name: "periodic",
            equation: "surface(t) = surface + the sum of sine_n sin(2 pi n frequency t) + cosine_n cos(2 pi n frequency t) for n of 1 to 3",
            parameters: &[
                part("sine"),
                part("cosine"),
                part("sine_2"),
                part("cosine_2"),
                part("sine_3"),
                part("cosine_3"),
                FREQUENCY,
            ],
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
        if form != 1 || !scene.separates_time_from_depth() {
            Vec::new()
        } else {
            vec![Start::sized(&[size / scene.duration], &[0])]
        }
    }

    fn harmonics(&self, form: usize) -> usize {
        HARMONICS[form]
    }

    fn frequency_search(&self, form: usize, scene: &ExcitationStats) -> Option<FrequencySearch> {
        // Half a turn a trial apart, of the last harmonic, up to the shaking of a table or what the rows resolve: nothing falls between two
        // of them.
        let most = (30.0 * scene.duration).min(0.1 * scene.duration / scene.step).clamp(2.0, 1000.0);
        (form != 1 && scene.separates_time_from_depth()).then(|| {
            let harmonics = HARMONICS[form];
            FrequencySearch {
                weight: ToneWeight::Inside,
                frequencies: vec![(
                    2.0 / scene.duration,
                    0.5 / (harmonics as f64 * scene.duration),
                    (2.0 * most) as usize,
                )],
                size: 0.01 * scene.depth,
                harmonics,
            }
        })
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        if form == 1 {
            touch.position -= values[0] * touch.time;
            touch.velocity -= values[0];
            return;
        }
        let Some((frequency, parts)) = values.split_last() else { return };
        let pulse = TAU * frequency;
        let (sine, cosine) = (pulse * touch.time).sin_cos();
        // Each harmonic from the one before it, turned by the first.
        let (mut sine_n, mut cosine_n) = (sine, cosine);
        for (at, wave) in parts.chunks_exact(2).enumerate() {
            if at > 0 {
                (sine_n, cosine_n) = (sine_n * cosine + cosine_n * sine, cosine_n * cosine - sine_n * sine);
            }
            touch.position -= wave[0] * sine_n + wave[1] * cosine_n;
            touch.velocity -= pulse * (at + 1) as f64 * (wave[0] * cosine_n - wave[1] * sine_n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::ContactSimulator;
    use crate::effects::contact_simulator::ActiveEffect;
    use crate::rig::Contact;

    #[test]
    fn a_breath_is_a_periodic_surface_of_two_harmonics() {
        // cos^4(pi f t) = 3/8 + 1/2 cos(2 pi f t) + 1/8 cos(4 pi f t), as breathing is often given (Lujan et al., Med. Phys. 26, 1999, 715).
        let (size, frequency) = (8e-3, 0.3);
        let contact = Contact { surface: 0.0, stiffness: 400.0, damping: 5.0, bilateral: true };
        let values = [0.0, 0.5 * size, 0.0, 0.125 * size, 0.0, 0.0, frequency];
        let actives = [ActiveEffect { effect: &SurfaceMotion, form: 2, values: &values }];
        let mut law = ContactSimulator::new(contact, &actives);
        for row in 0..1000 {
            let time = 0.01 * f64::from(row);
            let turn = std::f64::consts::PI * frequency * time;
            let surface = size * (turn.cos().powi(4) - 0.375);
            let rate = -4.0 * size * turn.cos().powi(3) * turn.sin() * std::f64::consts::PI * frequency;
            let force = law.step(time, 0.01, 0.02, 0.0, 0.0, 0.0);
            let expected = 400.0 * (0.02 - surface) - 5.0 * rate;
            assert!((force - expected).abs() < 1e-9 * 400.0 * 0.02, "{time}: {force} {expected}");
        }
    }
}
