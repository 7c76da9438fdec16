//! A ripple over the way.

use std::f64::consts::TAU;

use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Cogging;

const fn part(name: &'static str) -> Parameter {
    Parameter::new(name, Word::new("N", "N m"), "part of the ripple", f64::NEG_INFINITY, f64::INFINITY)
}

const fn way(name: &'static str) -> Parameter {
    Parameter::new(name, Word::new("m", "rad"), "way over which the pattern repeats", 0.0, f64::INFINITY)
}

const PITCH: Parameter =
    Parameter::new("pitch", Word::new("m", "rad"), "way over which it repeats", 0.0, f64::INFINITY);

/// Patterns at most: of a slotted motor its slots, its poles, and their sums and differences.
pub const MOST_PATTERNS: usize = 6;

/// Of each pattern in turn, as the forms of three patterns and more have them.
static PATTERNS: [Parameter; 3 * MOST_PATTERNS] = [
    part("sine"),
    part("cosine"),
    way("pitch"),
    part("second_sine"),
    part("second_cosine"),
    way("second_pitch"),
    part("third_sine"),
    part("third_cosine"),
    way("third_pitch"),
    part("fourth_sine"),
    part("fourth_cosine"),
    way("fourth_pitch"),
    part("fifth_sine"),
    part("fifth_cosine"),
    way("fifth_pitch"),
    part("sixth_sine"),
    part("sixth_cosine"),
    way("sixth_pitch"),
];

const fn patterns(name: &'static str, count: usize) -> Form {
    Form {
        name,
        equation: "load = the sum over the patterns of sine sin(2 pi position / pitch) + cosine cos(2 pi position / pitch)",
        parameters: PATTERNS.split_at(3 * count).0,
    }
}

/// The waves of the form numbered `form` with `values`: sine, cosine, and wavenumber, rad/m or periods a turn.
pub fn waves(form: usize, values: &[f64]) -> impl Iterator<Item = [f64; 3]> {
    // One pattern, and three and more, stand one after the other; of two the pitches stand behind the sizes.
    let count = if matches!(form, 1 | 2) { 2 } else { values.len() / 3 };
    (0..count).map(move |at| {
        let (first, pitch) = match form {
            1 => (2 * at, values[4] / (at + 1) as f64),
            2 => (2 * at, values[4 + at]),
            _ => (3 * at, values[3 * at + 2]),
        };
        [values[first], values[first + 1], TAU / pitch.max(f64::MIN_POSITIVE)]
    })
}

static SPEC: EffectSpec = EffectSpec {
    name: "cogging",
    place: Place::Drive,
    stage: Stage::Load,
    max_instances: 1,
    statement: "The drive pulls and pushes in a pattern that repeats along the way",
    forms: &[
        Form {
            name: "first_harmonic",
            equation: "load = sine sin(2 pi position / pitch) + cosine cos(2 pi position / pitch)",
            parameters: &[part("sine"), part("cosine"), PITCH],
        },
        Form {
            name: "two_harmonics",
            equation: "load = sine sin(2 pi position / pitch) + cosine cos(2 pi position / pitch) + second_sine sin(4 pi position / pitch) + second_cosine cos(4 pi position / pitch)",
            parameters: &[part("sine"), part("cosine"), part("second_sine"), part("second_cosine"), PITCH],
        },
        Form {
            name: "two_patterns",
            equation: "load = sine sin(2 pi position / pitch) + cosine cos(2 pi position / pitch) + second_sine sin(2 pi position / second_pitch) + second_cosine cos(2 pi position / second_pitch)",
            parameters: &[
                part("sine"),
                part("cosine"),
                part("second_sine"),
                part("second_cosine"),
                PITCH,
                Parameter::new(
                    "second_pitch",
                    Word::new("m", "rad"),
                    "way over which the second pattern repeats",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        patterns("three_patterns", 3),
        patterns("four_patterns", 4),
        patterns("five_patterns", 5),
        patterns("six_patterns", 6),
    ],
    excited_by: "slow motion over many pitches",
    resembles: &["gravity_load"],
    source: "slot and magnet ripple of a motor, run-out of a gear",
};

impl Effect for Cogging {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, _scene: &ExcitationStats) -> Vec<Start> {
        Vec::new()
    }

    fn act_on_drive(&self, form: usize, values: &[f64], _state: &mut EffectState, push: &mut DriveState) {
        for [along_sine, along_cosine, wavenumber] in waves(form, values) {
            let (sine, cosine) = (wavenumber * push.position).sin_cos();
            push.resistance += along_sine * sine + along_cosine * cosine;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_waves_of_every_form_are_its_equation() {
        let all = |form: usize, values: &[f64]| waves(form, values).collect::<Vec<_>>();
        assert_eq!(all(0, &[1.0, 2.0, 0.5]), [[1.0, 2.0, TAU / 0.5]]);
        assert_eq!(all(1, &[1.0, 2.0, 3.0, 4.0, 0.5]), [[1.0, 2.0, TAU / 0.5], [3.0, 4.0, TAU / 0.25]]);
        assert_eq!(all(2, &[1.0, 2.0, 3.0, 4.0, 0.5, 0.2]), [[1.0, 2.0, TAU / 0.5], [3.0, 4.0, TAU / 0.2]]);
        for (form, count) in [(3, 3), (4, 4), (5, 5), (6, MOST_PATTERNS)] {
            let names: Vec<&str> = SPEC.forms[form].parameters.iter().map(|parameter| parameter.name).collect();
            assert_eq!(names.len(), 3 * count, "{names:?}");
            let each = (0..count).flat_map(|at| [at as f64, -1.0, 0.1 * (at + 1) as f64]);
            let expected: Vec<[f64; 3]> =
                (0..count).map(|at| [at as f64, -1.0, TAU / (0.1 * (at + 1) as f64)]).collect();
            assert_eq!(all(form, &each.collect::<Vec<f64>>()), expected);
            for (wave, part) in names.chunks(3).zip(["", "second_", "third_", "fourth_", "fifth_", "sixth_"]) {
                assert_eq!(wave, ["sine", "cosine", "pitch"].map(|end| format!("{part}{end}")));
            }
        }
    }
}
