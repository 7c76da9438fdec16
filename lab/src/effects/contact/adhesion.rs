//! A surface that holds on.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Scene, Stage, Start, Touch};
use crate::rig::Word;

/// See [`CARD`].
pub struct Adhesion;

static CARD: Card = Card {
    name: "adhesion",
    place: Place::Contact,
    stage: Stage::Limit,
    most: 1,
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
    ],
    excited_by: "leaving the surface, slowly and often",
    resembles: &["force_bias", "lost_motion"],
    source: "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin et al., J. Colloid Interface Sci. 53 (1975) 314",
};

impl Effect for Adhesion {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        if scene.releases == 0 {
            return Vec::new();
        }
        let force = 0.05 * scene.force;
        let height = force / scene.stiffness.max(f64::MIN_POSITIVE);
        let away = (scene.travel.1 - scene.travel.0 - scene.depth).max(0.3 * scene.depth);
        [0.3, 1.0, 3.0, 10.0]
            .iter()
            .map(|factor| Start::sized(&[force, (factor * height).min(away)], &[0]))
            .chain([0.05, 0.2, 0.5].iter().map(|part| Start::sized(&[force, part * away], &[0])))
            .collect()
    }

    fn touch(&self, form: usize, values: &[f64], memory: &mut Memory, touch: &mut Touch) {
        if touch.bilateral {
            return;
        }
        // memory: whether the surface holds on.
        if touch.position > 0.0 {
            memory[0] = 1.0;
        } else if touch.position < -values[1] {
            memory[0] = 0.0;
        }
        if memory[0] == 0.0 {
            return;
        }
        let pull = values[0];
        if form == 1 {
            touch.force -= pull;
            return;
        }
        let stretched = touch.stiffness * touch.position + touch.damping * touch.velocity + touch.extra;
        if touch.velocity < 0.0 || touch.position < 0.0 {
            touch.force = touch.force.max(0.0) + stretched.min(0.0).max(-pull);
        }
    }
}
