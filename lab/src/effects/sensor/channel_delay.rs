//! A force that is written down late.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start, geometric};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ChannelDelay;

static SPEC: EffectSpec = EffectSpec {
    name: "channel_delay",
    place: Place::Sensor,
    stage: Stage::Response,
    max_instances: 1,
    statement: "The force is written down later than the position it belongs to",
    forms: &[Form {
        name: "pure",
        equation: "reading(t) = F(t - delay)",
        parameters: &[Parameter::new("delay", Word::same("s"), "force late against position", 0.0, f64::INFINITY)],
    }],
    excited_by: "touching at speed; two or more frequencies in contact; the drive in quick motion",
    resembles: &["force_lag", "tool_inertia", "stress_relaxation", "environment_mass"],
    source: "bus and converter latency",
};

impl Effect for ChannelDelay {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        geometric(0.3 * scene.sample, 6.0 * scene.step, 6).iter().map(|delay| Start::at(&[*delay])).collect()
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.delay(values[0].max(0.0));
    }
}
