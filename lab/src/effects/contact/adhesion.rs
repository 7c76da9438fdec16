//! A surface that holds on.

use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Adhesion;

static SPEC: EffectSpec = EffectSpec {
    name: "adhesion",
    place: Place::Contact,
    stage: Stage::Limit,
    max_instances: 1,
    statement: "On leaving, the surface holds on to the tool and pulls before it lets go",
    forms: &[
        Form {
            name: "neck",
            equation: "leaving, F falls below zero down to -pull_off_force and lets go at a height of release_height",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                Parameter::new(
                    "release_height",
                    Word::new("m", "rad"),
                    "height above the surface at which it ends",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "attraction",
            equation: "once touched, F is less by pull_off_force until the tool is release_height above the surface",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "the pull", 0.0, f64::INFINITY),
                Parameter::new("release_height", Word::new("m", "rad"), "height at which it ends", 0.0, f64::INFINITY),
            ],
        },
        Form {
            name: "cohesive",
            equation: "as neck, the pull falling from pull_off_force in a straight line that would end after softening_length, until release_height",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                Parameter::new("release_height", Word::new("m", "rad"), "height at which it ends", 0.0, f64::INFINITY),
                Parameter::new(
                    "softening_length",
                    Word::new("m", "rad"),
                    "way over which the pull would fall to nothing",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
        Form {
            name: "bridge",
            equation: "leaving, F falls no lower than -pull_off_force, and is -pull_off_force (1 - height / release_height) above the surface",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                Parameter::new("release_height", Word::new("m", "rad"), "height at which it ends", 0.0, f64::INFINITY),
            ],
        },
    ],
    excited_by: "leaving the surface, slowly and often",
    resembles: &["force_bias", "lost_motion"],
    source: "a liquid bridge; D. S. Dugdale, J. Mech. Phys. Solids 8 (1960) 100; a pull that softens: A. Hillerborg et al., Cem. Concr. Res. 6 (1976) 773; K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin et al., J. Colloid Interface Sci. 53 (1975) 314",
};

impl Effect for Adhesion {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if scene.releases == 0 {
            return Vec::new();
        }
        let force = 0.05 * scene.force;
        let height = force / scene.stiffness.max(f64::MIN_POSITIVE);
        let away = (scene.travel.1 - scene.travel.0 - scene.depth).max(0.3 * scene.depth);
        let near = [0.3, 1.0, 3.0, 10.0].iter().map(|factor| (factor * height).min(away));
        let heights = near.chain([0.05, 0.2, 0.5].iter().map(|part| part * away));
        if form == 2 {
            return heights.map(|height| Start::sized(&[force, height, 1.5 * height], &[0])).collect();
        }
        heights.map(|height| Start::sized(&[force, height], &[0])).collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        if touch.bilateral {
            return;
        }
        // state: whether the surface holds on.
        if touch.position > 0.0 {
            state[0] = 1.0;
        } else if touch.position < -values[1] {
            state[0] = 0.0;
        }
        if state[0] == 0.0 {
            return;
        }
        if form == 1 {
            touch.force -= values[0];
            return;
        }
        // Within the surface the law itself pulls, above it the neck as the spring would.
        let stretched = if touch.position > 0.0 {
            touch.borne()
        } else {
            touch.stiffness * touch.position + touch.damping * touch.velocity + touch.extra
        };
        if form == 3 {
            touch.force = if touch.position > 0.0 {
                touch.force.max(0.0) + stretched.min(0.0).max(-values[0])
            } else {
                -values[0] * (1.0 + touch.position / values[1].max(f64::MIN_POSITIVE)).max(0.0)
            };
            return;
        }
        let mut pull = values[0];
        if form == 2 {
            let beyond = (-touch.position - pull / touch.stiffness.max(f64::MIN_POSITIVE)).max(0.0);
            pull *= (1.0 - beyond / values[2].max(f64::MIN_POSITIVE)).max(0.0);
        }
        if touch.velocity < 0.0 || touch.position < 0.0 {
            touch.force = touch.force.max(0.0) + stretched.min(0.0).max(-pull);
        }
    }
}
