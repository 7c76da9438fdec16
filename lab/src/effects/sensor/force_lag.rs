//! A force that is smoothed before it is written down.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start, geometric};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ForceLag;

static SPEC: EffectSpec = EffectSpec {
    name: "force_lag",
    place: Place::Sensor,
    stage: Stage::Response,
    max_instances: 1,
    statement: "The force sensor follows slowly, as behind a low-pass filter",
    forms: &[Form {
        name: "first_order",
        equation: "time_constant d(reading)/dt = F - reading",
        parameters: &[Parameter::new("time_constant", Word::same("s"), "of the low-pass", 0.0, f64::INFINITY)],
    }],
    excited_by: "touching at speed; two or more frequencies in contact",
    resembles: &["channel_delay", "stress_relaxation", "tool_inertia"],
    source: "anti-alias filter of an amplifier",
};

impl Effect for ForceLag {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // F + T dF/dt = K x + B v is a spring of K beside a Maxwell branch of B / T - K: only a force that fades after the tool has
        // left, or the drive, tells a slow sensor from a body that relaxes, and a body is what is seldom known.
        if scene.releases == 0 && !scene.has_effort {
            return Vec::new();
        }
        geometric(0.3 * scene.sample, 30.0 * scene.step, 8).iter().map(|time| Start::at(&[*time])).collect()
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.low_pass(values[0]);
    }
}
