//! Further layers under the first: a boundary, a stop, or a pocket in which the force falls before it rises again.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start,
    linear, ramp, rounded,
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
    Parameter::new("layer_depth", Word::new("m", "rad"), "depth of the boundary", 0.0, f64::INFINITY)
        .within(Limit::ResolvableLength);

const fn added(name: &'static str) -> Parameter {
    let meaning = "what the next layer adds to the one above; below zero where it is softer, or where the force falls";
    Parameter::new(name, Word::new("N/m", "N m/rad"), meaning, f64::NEG_INFINITY, f64::INFINITY)
}

const fn boundary(name: &'static str) -> Parameter {
    Parameter::new(name, Word::new("m", "rad"), "depth of that boundary", 0.0, f64::INFINITY)
        .within(Limit::ResolvableLength)
}

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
            parameters: &[ADDED_STIFFNESS, LAYER_DEPTH, added("second_added"), boundary("second_depth")],
        },
        Form {
            name: "four_layers",
            equation: "spring = K x + added_stiffness max(0, x - layer_depth) + second_added max(0, x - second_depth) + third_added max(0, x - third_depth)",
            parameters: &[
                ADDED_STIFFNESS,
                LAYER_DEPTH,
                added("second_added"),
                boundary("second_depth"),
                added("third_added"),
                boundary("third_depth"),
            ],
        },
        Form {
            name: "five_layers",
            equation: "spring = K x + added_stiffness max(0, x - layer_depth) + second_added max(0, x - second_depth) + third_added max(0, x - third_depth) + fourth_added max(0, x - fourth_depth)",
            parameters: &[
                ADDED_STIFFNESS,
                LAYER_DEPTH,
                added("second_added"),
                boundary("second_depth"),
                added("third_added"),
                boundary("third_depth"),
                added("fourth_added"),
                boundary("fourth_depth"),
            ],
        },
    ],
    excited_by: "contacts that go through the boundary and others that stop before it",
    resembles: &["nonlinear_stiffness", "force_saturation"],
    source: "springs in series and parallel; bilinear stiffness; snap-through as negative stiffness between two layers: R. von Mises, ZAMM 3 (1923) 406",
};

/// Transitions that the boundary lies below the surface, and above the deepest point, at the least: at three, one part in twenty of what
/// is added acts at the surface, 1 / (1 + exp(3)), and one is missing at the deepest point. A spring that bends all the way is no layer.
const LEAST_TRANSITIONS: f64 = 3.0;

/// Indices of the forms.
mod form {
    pub const TWO: usize = 0;
    pub const GRADUAL: usize = 1;
    pub const THREE: usize = 2;
    pub const FOUR: usize = 3;
    pub const FIVE: usize = 4;
}

/// How many layers the forms with sharp boundaries have that are looked for from what is seen, and their indices.
pub const LAYERS_OF_FORMS: [(usize, usize); 3] = [(3, form::THREE), (4, form::FOUR), (5, form::FIVE)];

/// Places of a further boundary that are tried.
const FURTHER_BOUNDARIES: usize = 16;

impl Effect for LayeredStiffness {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        let depths = linear(0.15, 0.9, 8).into_iter().map(|part| part * scene.depth);
        let added = 0.1 * scene.stiffness;
        // From three layers on, which are refined.
        if form > form::THREE {
            return Vec::new();
        }
        if form == form::THREE {
            // A preload that is overcome at once, a soft way, a stop near its end; and layers of like thickness.
            let shallow = [0.01, 0.03, 0.08, 0.25, 0.45];
            let deep = [0.55, 0.7, 0.8, 0.88, 0.95];
            let pairs = shallow
                .iter()
                .flat_map(|first| deep.iter().map(move |second| (first * scene.depth, second * scene.depth)));
            return pairs.map(|(first, second)| Start::sized(&[added, first, added, second], &[0, 2])).collect();
        }
        if form == form::TWO {
            return depths.map(|depth| Start::sized(&[added, depth], &[0])).collect();
        }
        depths.map(|depth| Start::sized(&[added, depth, 0.05 * scene.depth], &[0])).collect()
    }

    fn refined(&self, form: usize, values: &[f64], scene: &ExcitationStats) -> Option<(usize, Vec<Vec<f64>>)> {
        let next = match form {
            form::TWO => form::THREE,
            form::THREE => form::FOUR,
            form::FOUR => form::FIVE,
            _ => return None,
        };
        let depths = linear(0.02, 0.98, FURTHER_BOUNDARIES).into_iter().map(|part| part * scene.depth);
        let with = |depth: f64| values.iter().copied().chain([0.01 * scene.stiffness, depth]).collect();
        Some((next, depths.map(with).collect()))
    }

    fn may_fall(&self, form: usize) -> bool {
        form >= form::THREE
    }

    fn is_itself(&self, form: usize, values: &[f64], deepest: f64) -> bool {
        form != form::GRADUAL || values[2] * LEAST_TRANSITIONS < values[1].min(deepest - values[1])
    }

    fn act_on_contact(&self, form: usize, values: &[f64], _state: &mut EffectState, touch: &mut ContactState) {
        if form == form::GRADUAL {
            let transition = values[2].max(f64::MIN_POSITIVE);
            let rest = rounded(-values[1], transition);
            let beyond = rounded(touch.depth.abs() - values[1], transition) - rest;
            touch.spring += values[0] * beyond.copysign(touch.depth);
            return;
        }
        let width = touch.velocity.abs() * touch.smoothing_width;
        let depth = if touch.bilateral { touch.position.abs() } else { touch.position };
        let added: f64 = values.chunks_exact(2).map(|layer| layer[0] * ramp(depth - layer[1], width)).sum();
        touch.spring += if touch.bilateral { added * touch.position.signum() } else { added };
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

    /// A preload, a soft way, a pocket in which the force falls, and a stop: each layer adds its own, by hand.
    #[test]
    fn layers_add_up_and_a_pocket_falls() {
        let contact = crate::rig::Contact { surface: 0.0, stiffness: 4000.0, damping: 0.0, bilateral: false };
        let values = [-3900.0, 1e-4, -300.0, 1e-3, 300.0, 2e-3, 5000.0, 4e-3];
        let active = crate::effects::ActiveEffect { effect: &LayeredStiffness, form: form::FIVE, values: &values };
        let mut law = crate::effects::ContactSimulator::new(contact, &[active]);
        let mut force = |depth: f64| law.step(0.0, 1.0, depth, 0.0, 0.0, 0.0);
        for (depth, by_hand) in [
            (1e-4, 0.4),
            (1e-3, 0.4 + 100.0 * 0.9e-3),
            (2e-3, 0.4 + 100.0 * 0.9e-3 - 200.0 * 1e-3),
            (4e-3, 0.4 + 100.0 * 0.9e-3 - 200.0 * 1e-3 + 100.0 * 2e-3),
            (4.1e-3, 0.4 + 100.0 * 0.9e-3 - 200.0 * 1e-3 + 100.0 * 2e-3 + 5100.0 * 1e-4),
        ] {
            assert!((force(depth) - by_hand).abs() < 1e-12, "{depth}: {} not {by_hand}", force(depth));
        }
    }

    #[test]
    fn a_further_layer_begins_from_the_law_that_it_refines() {
        let scene = ExcitationStats { depth: 4e-3, stiffness: 200.0, ..ExcitationStats::default() };
        let before = [900.0, 3e-3];
        let (next, starts) = LayeredStiffness.refined(form::TWO, &before, &scene).unwrap();
        assert_eq!((next, starts.len()), (form::THREE, FURTHER_BOUNDARIES));
        assert!(starts.iter().all(|values| values[..2] == before && (0.0..4e-3).contains(&values[3])));
        assert!(LayeredStiffness.refined(form::FIVE, &[0.0; 8], &scene).is_none(), "no more than five");
    }
}
