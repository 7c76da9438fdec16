//! A second layer under the first.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start, linear, ramp,
    rounded,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct LayeredStiffness;

const ADDED_STIFFNESS: Parameter = Parameter::new(
    "added_stiffness",
    Word::new("N/m", "N m/rad"),
    "what the second layer adds; below zero where it is softer",
    f64::NEG_INFINITY,
    f64::INFINITY,
);

const LAYER_DEPTH: Parameter =
    Parameter::new("layer_depth", Word::new("m", "rad"), "depth of the boundary", 0.0, f64::INFINITY);

static SPEC: EffectSpec = EffectSpec {
    name: "layered_stiffness",
    place: Place::Contact,
    stage: Stage::Law,
    max_instances: 1,
    statement: "From a certain depth on, the tool presses on something else",
    forms: &[
        Form {
            name: "two_layers",
            equation: "spring = K x + added_stiffness max(0, x - layer_depth)",
            parameters: &[ADDED_STIFFNESS, LAYER_DEPTH],
        },
        Form {
            name: "gradual",
            equation: "spring = K x + added_stiffness (s(x) - s(0)), s(x) = transition ln(1 + exp((x - layer_depth) / transition))",
            parameters: &[
                ADDED_STIFFNESS,
                LAYER_DEPTH,
                Parameter::new(
                    "transition",
                    Word::new("m", "rad"),
                    "depth over which one layer gives way to the other",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "three_layers",
            equation: "spring = K x + added_stiffness max(0, x - layer_depth) + second_added max(0, x - second_depth)",
            parameters: &[
                ADDED_STIFFNESS,
                LAYER_DEPTH,
                Parameter::new(
                    "second_added",
                    Word::new("N/m", "N m/rad"),
                    "what the third layer adds to the second, a stop say",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::new(
                    "second_depth",
                    Word::new("m", "rad"),
                    "depth of the second boundary",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "contacts that go through the boundary and others that stop before it",
    resembles: &["nonlinear_stiffness", "force_saturation"],
    source: "springs in series and parallel; bilinear stiffness",
};

/// Transitions that the boundary lies below the surface, and above the deepest point, at the least: at three, one part in twenty of what
/// is added acts at the surface, 1 / (1 + exp(3)), and one is missing at the deepest point. A spring that bends all the way is no layer.
const LEAST_TRANSITIONS: f64 = 3.0;

impl Effect for LayeredStiffness {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let depths = linear(0.15, 0.9, 8).into_iter().map(|part| part * scene.depth);
        let added = 0.1 * scene.stiffness;
        if form == 2 {
            // A preload that is overcome at once, a soft way, a stop near its end; and layers of like thickness.
            let shallow = [0.01, 0.03, 0.08, 0.25, 0.45];
            let deep = [0.55, 0.7, 0.8, 0.88, 0.95];
            let pairs = shallow
                .iter()
                .flat_map(|first| deep.iter().map(move |second| (first * scene.depth, second * scene.depth)));
            return pairs.map(|(first, second)| Start::sized(&[added, first, added, second], &[0, 2])).collect();
        }
        if form == 0 {
            return depths.map(|depth| Start::sized(&[added, depth], &[0])).collect();
        }
        depths.map(|depth| Start::sized(&[added, depth, 0.05 * scene.depth], &[0])).collect()
    }

    fn is_itself(&self, form: usize, values: &[f64], deepest: f64) -> bool {
        form != 1 || values[2] * LEAST_TRANSITIONS < values[1].min(deepest - values[1])
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        if form == 1 {
            let transition = values[2].max(f64::MIN_POSITIVE);
            let rest = rounded(-values[1], transition);
            let beyond = rounded(touch.depth.abs() - values[1], transition) - rest;
            touch.spring += values[0] * beyond.copysign(touch.depth);
            return;
        }
        let width = touch.velocity.abs() * touch.smoothing_width;
        let beyond = if touch.bilateral {
            touch.position.signum() * ramp(touch.position.abs() - values[1], width)
        } else {
            ramp(touch.position - values[1], width)
        };
        touch.spring += values[0] * beyond;
        if form == 2 {
            let depth = if touch.bilateral { touch.position.abs() } else { touch.position };
            let further = ramp(depth - values[3], width);
            touch.spring += values[2] * if touch.bilateral { further.copysign(touch.position) } else { further };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_boundary_that_bends_all_the_way_is_no_layer() {
        let is_layer =
            |boundary: f64, transition: f64| LayeredStiffness.is_itself(1, &[500.0, boundary, transition], 6e-3);
        assert!(is_layer(3e-3, 0.9e-3));
        assert!(!is_layer(2e-3, 0.7e-3), "it bends from the surface on");
        assert!(!is_layer(4e-3, 0.7e-3), "it bends to the deepest point");
        assert!(!is_layer(8e-3, 0.1e-3), "it was not reached");
        assert!(!is_layer(3e-3, f64::NAN));
        assert!(LayeredStiffness.is_itself(0, &[500.0, 5e-3], 6e-3), "a sharp one has no width");
    }
}
