//! A spring that is not straight.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct NonlinearStiffness;

const METRE: Word = Word::new("m", "rad");

static SPEC: EffectSpec = EffectSpec {
    name: "nonlinear_stiffness",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "The deeper the tool goes, the stiffness itself changes",
    forms: &[
        Form {
            name: "power_law",
            equation: "spring = K reference_depth (x / reference_depth)^exponent; K is the secant stiffness at that depth",
            parameters: &[
                Parameter::new(
                    "exponent",
                    Word::same("1"),
                    "1.5 for a sphere, 2 for a cone, 1 for a flat punch",
                    0.2,
                    6.0,
                ),
                Parameter::fixed("reference_depth", METRE, "depth at which K is stated"),
            ],
        },
        Form {
            name: "hardening",
            equation: "spring = K x + cubic x^3",
            parameters: &[Parameter::new(
                "cubic",
                Word::new("N/m^3", "N m/rad^3"),
                "above zero it hardens, below it softens",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
        Form {
            name: "exponential",
            equation: "spring = K (exp(stiffening x) - 1) / stiffening",
            parameters: &[Parameter::new(
                "stiffening",
                Word::new("1/m", "1/rad"),
                "growth of the tangent stiffness with depth, as a share of it",
                0.0,
                f64::INFINITY,
            )],
        },
    ],
    excited_by: "contacts that reach two or more depths",
    resembles: &["layered_stiffness", "plastic_set"],
    source: "H. Hertz (1881); I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47; Duffing's cubic spring; soft tissue: Y. C. Fung, Am. J. Physiol. 213 (1967) 1532",
};

impl Effect for NonlinearStiffness {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if form == 0 {
            let exponents = [0.6, 0.8, 1.2, 1.5, 2.0, 2.8, 4.0];
            return exponents.iter().map(|exponent| Start::at(&[*exponent, scene.depth])).collect();
        }
        if form == 2 {
            let growths = [0.3, 1.0, 2.5].map(|growth| growth / scene.depth.max(f64::MIN_POSITIVE));
            return growths.iter().map(|growth| Start::at(&[*growth])).collect();
        }
        vec![Start::sized(&[0.1 * scene.stiffness / scene.depth.powi(2)], &[0])]
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let depth = touch.depth.abs();
        if form == 0 {
            let (exponent, reference) = (values[0], values[1]);
            if reference > 0.0 && depth > 0.0 {
                touch.spring = touch.stiffness * touch.depth * (depth / reference).powf(exponent - 1.0);
            }
        } else if form == 1 {
            touch.spring += values[0] * touch.depth * depth * depth;
        } else if values[0] > 0.0 {
            let growth = (values[0] * depth).min(MAX_EXPONENT);
            touch.spring = (touch.stiffness * growth.exp_m1() / values[0]).copysign(touch.depth);
        }
    }
}

/// Exponent beyond which no force is left to tell: a search may try anything.
const MAX_EXPONENT: f64 = 60.0;
