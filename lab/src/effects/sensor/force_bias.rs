//! A zero that is not zero.

use crate::effects::{Effect, EffectSpec, ExcitationStats, Form, Parameter, Place, Reading, Stage, Start};
use crate::rig::Word;

/// See [`SPEC`].
pub struct ForceBias;

static SPEC: EffectSpec = EffectSpec {
    name: "force_bias",
    place: Place::Sensor,
    stage: Stage::Zero,
    max_instances: 1,
    statement: "The force sensor shows a force when nothing is touched",
    forms: &[Form {
        name: "constant",
        equation: "reading = F + bias",
        parameters: &[Parameter::new(
            "bias",
            Word::new("N", "N m"),
            "reading at no force",
            f64::NEG_INFINITY,
            f64::INFINITY,
        )],
    }],
    excited_by: "free motion beside contact",
    resembles: &["gravity_load", "adhesion"],
    source: "offset of a strain-gauge bridge",
};

impl Effect for ForceBias {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn on_drive(&self) -> Option<&'static str> {
        Some(
            "ParameterRls with ContactModel::BiasedKelvinVoigt follows K, B and the bias: regressor 1; or tare before touching",
        )
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // Without a free moment it is a surface that lies elsewhere.
        if scene.is_bilateral || scene.shows_sensor_zero() {
            vec![Start::sized(&[0.01 * scene.force], &[0])]
        } else {
            Vec::new()
        }
    }

    fn act_on_reading(&self, _form: usize, values: &[f64], reading: &mut Reading<'_>) {
        reading.force.iter_mut().for_each(|force| *force += values[0]);
    }
}
