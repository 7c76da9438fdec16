//! A dent that stays.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct PlasticSet;

static SPEC: EffectSpec = EffectSpec {
    name: "plastic_set",
    place: Place::Contact,
    stage: Stage::Depth,
    max_instances: 1,
    statement: "The surface keeps a dent: it springs back only part of the way",
    forms: &[
        Form {
            name: "proportional",
            equation: "F = K (x - dent), dent = set_ratio max x so far",
            parameters: &[Parameter::new(
                "set_ratio",
                Word::same("1"),
                "dent over the deepest depth so far",
                0.0,
                0.98,
            )],
        },
        Form {
            name: "yield",
            equation: "F = K (x - dent), dent = set_ratio max(0, max x so far - yield_depth)",
            parameters: &[
                Parameter::new("set_ratio", Word::same("1"), "dent over the depth beyond yield", 0.0, 0.98),
                Parameter::new(
                    "yield_depth",
                    Word::new("m", "rad"),
                    "depth up to which all springs back",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "viscoplastic",
            equation: "F = K (x - dent), d(dent)/dt = flow_rate max(0, K (x - dent) - yield_force)",
            parameters: &[
                Parameter::new(
                    "flow_rate",
                    Word::new("m/(N s)", "rad/(N m s)"),
                    "speed at which the dent grows for each newton beyond yield",
                    0.0,
                    f64::INFINITY,
                ),
                Parameter::new(
                    "yield_force",
                    Word::new("N", "N m"),
                    "force up to which all springs back",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "a second contact after a deeper one; unloading from two depths",
    resembles: &["hysteresis", "time_varying_stiffness", "stress_relaxation"],
    source: "W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564; elastic unloading from the deepest point; viscoplastic: P. Perzyna, Adv. Appl. Mech. 9 (1966) 243",
};

impl Effect for PlasticSet {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if !scene.has_unloading() {
            return Vec::new();
        }
        let ratios = [0.02, 0.1, 0.3, 0.6, 0.85];
        if form == 0 {
            return ratios.iter().map(|ratio| Start::at(&[*ratio])).collect();
        }
        if form == 2 {
            let force = scene.stiffness * scene.depth;
            let rate = 0.2 * scene.depth / (force * scene.duration);
            return [0.0, 0.2, 0.4, 0.6, 0.8]
                .iter()
                .map(|part| Start::sized(&[rate, (part * force).max(1e-3 * force)], &[0]))
                .collect();
        }
        let depths = [0.3, 0.65].map(|part| part * scene.depth);
        depths
            .iter()
            .flat_map(|depth| ratios.iter().skip(1).step_by(2).map(|ratio| Start::at(&[*ratio, *depth])))
            .collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        if form == 2 {
            // state: the dent. Implicit, so that a quick flow comes to rest at yield and not beyond.
            let over = touch.stiffness * (touch.position - state[0]) - values[1];
            let step = touch.step * values[0];
            state[0] += step * over.max(0.0) / (1.0 + step * touch.stiffness);
            touch.position -= state[0];
            touch.enter();
            return;
        }
        let spared = if form == 0 { 0.0 } else { values[1] };
        state[0] = state[0].max(touch.position);
        let dent = values[0] * (state[0] - spared).max(0.0);
        touch.position -= dent;
        touch.enter();
    }
}
