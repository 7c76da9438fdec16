//! Damping that grows with depth.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct HuntCrossleyDamping;

static SPEC: EffectSpec = EffectSpec {
    name: "hunt_crossley_damping",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "The damping is not constant: it grows with depth, from nothing at the surface",
    forms: &[
        Form {
            name: "linear_in_depth",
            equation: "F = K x + B v + alpha x v",
            parameters: &[Parameter::new(
                "alpha",
                Word::new("N s/m^2", "N m s/rad^2"),
                "growth of the damping with depth",
                0.0,
                f64::INFINITY,
            )],
        },
        Form {
            name: "power_of_depth",
            equation: "F = K x + B v + damping_there (x / reference_depth)^exponent v",
            parameters: &[
                Parameter::new(
                    "damping_there",
                    Word::new("N s/m", "N m s/rad"),
                    "what is added at the reference depth",
                    0.0,
                    f64::INFINITY,
                ),
                Parameter::new("exponent", Word::same("1"), "1.5 goes with a sphere's spring", 0.25, 4.0),
                Parameter::fixed("reference_depth", Word::new("m", "rad"), "depth at which it is stated"),
            ],
        },
    ],
    excited_by: "motion at two depths, and touching at speed",
    resembles: &["quadratic_damping", "environment_mass", "hysteresis"],
    source: "K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440",
};

impl Effect for HuntCrossleyDamping {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn on_drive(&self) -> Option<&'static str> {
        Some("ParameterRls with ContactModel::GrowingDamping follows K, B and alpha: regressor x v")
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let growth = 0.1 * scene.stiffness / scene.speed.max(f64::MIN_POSITIVE);
        if form == 0 {
            return vec![Start::sized(&[growth], &[0])];
        }
        let there = growth * scene.depth;
        [0.5, 1.5, 2.0].iter().map(|exponent| Start::sized(&[there, *exponent, scene.depth], &[0])).collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let depth = touch.depth.abs();
        touch.extra += touch.rate
            * if form == 0 {
                values[0] * depth
            } else if values[2] > 0.0 && depth > 0.0 {
                values[0] * (depth / values[2]).powf(values[1])
            } else {
                0.0
            };
    }
}
