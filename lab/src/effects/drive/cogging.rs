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

const PITCH: Parameter =
    Parameter::new("pitch", Word::new("m", "rad"), "way over which it repeats", 0.0, f64::INFINITY);

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
        let pitches = match form {
            0 => [values[2]; 2],
            1 => [values[4], 0.5 * values[4]],
            _ => [values[4], values[5]],
        };
        let waves = values.chunks_exact(2).take(if form == 0 { 1 } else { 2 });
        for (wave, pitch) in waves.zip(pitches) {
            let (sine, cosine) = (TAU / pitch.max(f64::MIN_POSITIVE) * push.position).sin_cos();
            push.resistance += wave[0] * sine + wave[1] * cosine;
        }
    }
}
