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
                "growth of the tangent stiffness with depth, as a share of it; below zero it softens",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )],
        },
        Form {
            name: "hyperbolic",
            equation: "spring = K x / (1 + softening x)",
            parameters: &[Parameter::new(
                "softening",
                Word::new("1/m", "1/rad"),
                "one over the depth at which half of K is left as secant stiffness",
                0.0,
                f64::INFINITY,
            )],
        },
        Form {
            name: "asymmetric",
            equation: "spring = K x + quadratic x^2 + cubic x^3: of a clamped contact stiffer one way than the other, of a pressed one softer before it is stiffer",
            parameters: &[
                Parameter::new(
                    "quadratic",
                    Word::new("N/m^2", "N m/rad^2"),
                    "above zero stiffer the deeper it is pressed and softer under tension, below it the other way round",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::new(
                    "cubic",
                    Word::new("N/m^3", "N m/rad^3"),
                    "above zero it hardens, below it softens",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "contacts that reach two or more depths",
    resembles: &["layered_stiffness", "plastic_set"],
    source: "H. Hertz (1881); I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47; Duffing's cubic spring; soft tissue: Y. C. Fung, Am. J. Physiol. 213 (1967) 1532; hyperbolic: R. L. Kondner, J. Soil Mech. Found. Div. ASCE 89 (1963) 115",
};

/// Indices of the forms.
mod form {
    pub const POWER_LAW: usize = 0;
    pub const EXPONENTIAL: usize = 2;
    pub const HYPERBOLIC: usize = 3;
    pub const ASYMMETRIC: usize = 4;
}

impl Effect for NonlinearStiffness {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let per_depth = |growths: &[f64]| {
            let starts = growths.iter().map(|growth| Start::at(&[growth / scene.depth.max(f64::MIN_POSITIVE)]));
            starts.collect()
        };
        match form {
            form::POWER_LAW => {
                let exponents = [0.6, 0.8, 1.2, 1.5, 2.0, 2.8, 4.0];
                exponents.iter().map(|exponent| Start::at(&[*exponent, scene.depth])).collect()
            }
            form::EXPONENTIAL => per_depth(&[-1.0, -0.3, 0.3, 1.0, 2.5]),
            form::HYPERBOLIC => per_depth(&[0.3, 1.0, 4.0]),
            form::ASYMMETRIC => {
                let [first, second] = [1, 2].map(|power| 0.1 * scene.stiffness / scene.depth.powi(power));
                vec![Start::sized(&[first, second], &[0, 1])]
            }
            _ => vec![Start::sized(&[0.1 * scene.stiffness / scene.depth.powi(2)], &[0])],
        }
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        let depth = touch.depth.abs();
        let straight = touch.stiffness * touch.depth;
        match form {
            form::POWER_LAW if values[1] > 0.0 && depth > 0.0 => {
                touch.spring = straight * (depth / values[1]).powf(values[0] - 1.0);
            }
            form::POWER_LAW => {}
            form::EXPONENTIAL if values[0] != 0.0 => {
                let growth = (values[0] * depth).min(MAX_EXPONENT);
                touch.spring = (touch.stiffness * growth.exp_m1() / values[0]).copysign(touch.depth);
            }
            form::EXPONENTIAL => {}
            form::HYPERBOLIC => touch.spring = straight / (1.0 + values[0] * depth),
            form::ASYMMETRIC => touch.spring += (values[0] + values[1] * touch.depth) * depth * depth,
            _ => touch.spring += values[0] * touch.depth * depth * depth,
        }
    }
}

/// Exponent beyond which no force is left to tell: a search may try anything.
const MAX_EXPONENT: f64 = 60.0;
