//! Something that has to be carried along.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct EnvironmentMass;

const MOVED_MASS: Parameter =
    Parameter::new("moved_mass", Word::new("kg", "kg m^2"), "mass that moves along", 0.0, f64::INFINITY);

static SPEC: EffectSpec = EffectSpec {
    name: "environment_mass",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "What is touched has a mass of its own that moves along with the tool",
    forms: &[
        Form { name: "carried", equation: "F = K x + B v + moved_mass a, in contact only", parameters: &[MOVED_MASS] },
        Form {
            name: "gathered",
            equation: "F = K x + B v + m a + m' v^2 / 2, m = moved_mass (1 - exp(-x / gathering_depth)), m' = dm/dx",
            parameters: &[
                MOVED_MASS,
                Parameter::new(
                    "gathering_depth",
                    Word::new("m", "rad"),
                    "depth over which it comes along; touching takes no blow",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "quick motion in contact, two or more frequencies, and the same in free space",
    resembles: &["tool_inertia", "channel_delay", "hunt_crossley_damping"],
    source: "the mass term of impedance: N. Hogan, J. Dyn. Syst. Meas. Control 107 (1985) 1; a mass that grows with depth: Lagrange's equation of m(x) v^2 / 2",
};

impl Effect for EnvironmentMass {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let mass = 0.05 * scene.force / scene.acceleration.max(f64::MIN_POSITIVE);
        if form == 0 {
            return vec![Start::sized(&[mass], &[0])];
        }
        if scene.is_bilateral {
            return Vec::new();
        }
        [0.03, 0.1, 0.3].iter().map(|part| Start::sized(&[mass, part * scene.depth], &[0])).collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        if form == 0 {
            touch.extra += values[0] * touch.acceleration * touch.inside;
        } else if touch.depth > 0.0 && values[1] > 0.0 {
            let left = (-touch.depth / values[1]).exp();
            let gathering = 0.5 * left / values[1] * touch.rate * touch.rate;
            touch.extra += values[0] * ((1.0 - left) * touch.acceleration * touch.inside + gathering);
        }
    }
}
