//! A surface that holds on.

mod sphere;

use self::sphere::Sphere;
use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Foundation, Parameter, Place, Stage, Start,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Adhesion;

const PULL: Parameter = Parameter::new("pull_off_force", Word::new("N", "N m"), "the pull", 0.0, f64::INFINITY);
const RELEASE_HEIGHT: Parameter =
    Parameter::new("release_height", Word::new("m", "rad"), "height at which it ends", 0.0, f64::INFINITY);

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
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "cohesive",
            equation: "as neck, the pull falling from pull_off_force in a straight line that would end after softening_length, until release_height",
            parameters: &[
                Parameter::new("pull_off_force", Word::new("N", "N m"), "greatest pull", 0.0, f64::INFINITY),
                RELEASE_HEIGHT,
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
                RELEASE_HEIGHT,
            ],
        },
        Form {
            name: "capillary",
            equation: "once touched, F is less by pull_off_force in contact, and -pull_off_force (1 - height / release_height) above the surface",
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "sphere",
            equation: "with Hertz's law F = c x^1.5 beneath: once touched, x = h - b h^(1/4), F = c (h^1.5 - 1.5 b h^(3/4)), b = 4/3 sqrt(pull_off_force / c), until x is least",
            parameters: &[Parameter::new(
                "pull_off_force",
                Word::new("N", "N m"),
                "greatest pull under a given force; under a given motion it lets go at 5/9 of it",
                0.0,
                f64::INFINITY,
            )],
        },
        Form {
            name: "bond",
            equation: "once touched, F is -pull_off_force height / release_height above the surface until it breaks at release_height",
            parameters: &[PULL, RELEASE_HEIGHT],
        },
        Form {
            name: "bilinear",
            equation: "once touched, F above the surface is -pull_off_force height / peak_height up to peak_height, which is no more than pull_off_force / K, and from there on falls in a straight line to nothing at release_height",
            parameters: &[
                PULL,
                RELEASE_HEIGHT,
                Parameter::new(
                    "peak_height",
                    Word::new("m", "rad"),
                    "height above the surface at which the pull is greatest",
                    0.0,
                    f64::INFINITY,
                ),
            ],
        },
    ],
    excited_by: "leaving the surface, slowly and often",
    resembles: &["force_bias", "lost_motion"],
    source: "a liquid bridge; D. S. Dugdale, J. Mech. Phys. Solids 8 (1960) 100; a pull that softens: A. Hillerborg et al., Cem. Concr. Res. 6 (1976) 773; one that rises first: P. H. Geubelle, J. S. Baylor, Compos. B 29 (1998) 589; K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin et al., J. Colloid Interface Sci. 53 (1975) 314",
};

/// Indices of the forms.
mod form {
    pub const ATTRACTION: usize = 1;
    pub const COHESIVE: usize = 2;
    pub const BRIDGE: usize = 3;
    pub const CAPILLARY: usize = 4;
    pub const SPHERE: usize = 5;
    pub const BOND: usize = 6;
    pub const BILINEAR: usize = 7;
}

/// Height of the greatest pull of a neck of its own stiffness, over that of its end, where nothing is known of it.
const USUAL_PEAK: f64 = 0.2;

/// The height at which a pull ends by `form`, of which half was measured last at a height above the surface, where it is greatest at `stretched`; `None`
/// where it was not measured above that.
fn seen_end(form: usize, scene: &ExcitationStats, stretched: f64) -> Option<f64> {
    let half = scene.half_pull_height;
    let end = match form {
        form::COHESIVE => 2.0 * half - stretched,
        form::BILINEAR => 2.0 * half / (1.0 + USUAL_PEAK),
        form::BRIDGE | form::CAPILLARY => 2.0 * half,
        _ => half,
    };
    (half > stretched).then_some(end)
}

impl Effect for Adhesion {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn builds_on(&self, form: usize) -> &'static [Foundation] {
        // Hertz's law is a power law.
        const HERTZ: [Foundation; 1] = [Foundation::of_form("nonlinear_stiffness", 0)];
        if form == form::SPHERE { &HERTZ } else { &[] }
    }

    fn simpler(&self, form: usize, values: &[f64], stiffness: f64) -> Option<(usize, Vec<f64>)> {
        // On a straight spring a neck that ends where the spring pulls as much.
        (form == form::SPHERE).then(|| (0, vec![values[0], values[0] / stiffness.max(f64::MIN_POSITIVE)]))
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if scene.releases == 0 {
            return Vec::new();
        }
        let force = 0.05 * scene.force;
        let height = force / scene.stiffness.max(f64::MIN_POSITIVE);
        let away = (scene.travel.1 - scene.travel.0 - scene.depth).max(0.3 * scene.depth);
        if form == form::SPHERE {
            let measured = Some(scene.pull).filter(|pull| *pull > 0.0);
            return [0.2 * force, force, 4.0 * force]
                .into_iter()
                .chain(measured)
                .map(|pull| Start::at(&[pull]))
                .collect();
        }
        let near = [0.3, 1.0, 3.0, 10.0].iter().map(|factor| (factor * height).min(away));
        let heights = near.chain([0.05, 0.2, 0.5].iter().map(|part| part * away));
        // A small pull grows in proportion until the spring cannot pull as much: one that was measured is tried at its own size.
        let stretched = (scene.pull / scene.stiffness.max(f64::MIN_POSITIVE)).min(away);
        let measured = [0.5, 1.0, 2.0].iter().map(|times| times * stretched).filter(|height| *height > 0.0);
        // Where the pull was seen to end: beyond the end by softening a release says nothing, and before it hides the rest.
        let seen = seen_end(form, scene, stretched).into_iter();
        if form == form::COHESIVE {
            let small = heights.map(|height| Start::sized(&[force, height, 1.5 * height], &[0]));
            let measured = measured.map(|height| Start::at(&[scene.pull, height, 1.5 * height]));
            return small
                .chain(measured)
                .chain(seen.map(|end| Start::at(&[scene.pull, end, end - stretched])))
                .collect();
        }
        if form == form::BILINEAR && scene.pull > 0.0 {
            let own = measured.chain(seen).map(|height| Start::at(&[scene.pull, height, USUAL_PEAK * height]));
            return own.filter(|start| start.values[2] * scene.stiffness < scene.pull).collect();
        }
        if form == form::BILINEAR {
            return heights.map(|height| Start::sized(&[force, height, USUAL_PEAK * height], &[0])).collect();
        }
        let small = heights.map(|height| Start::sized(&[force, height], &[0]));
        small.chain(measured.chain(seen).map(|height| Start::at(&[scene.pull, height]))).collect()
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        if touch.bilateral {
            return;
        }
        if form == form::SPHERE {
            Sphere::act(values[0], state, touch);
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
        match form {
            form::ATTRACTION => {
                touch.force -= values[0];
                return;
            }
            form::CAPILLARY => {
                let above = (-touch.position).max(0.0) / values[1].max(f64::MIN_POSITIVE);
                touch.force -= values[0] * (1.0 - above).max(0.0);
                return;
            }
            form::BOND => {
                touch.force -= values[0] * (-touch.position).max(0.0) / values[1].max(f64::MIN_POSITIVE);
                return;
            }
            form::BILINEAR => {
                // A neck that is softer than the spring is the spring's own pull, as of the other forms.
                let (height, softest) =
                    ((-touch.position).max(0.0), values[0] / touch.stiffness.max(f64::MIN_POSITIVE));
                let peak = values[2].min(values[1]).min(softest);
                let rising = height / peak.max(f64::MIN_POSITIVE);
                let falling = (values[1] - height) / (values[1] - peak).max(f64::MIN_POSITIVE);
                touch.force -= values[0] * rising.min(falling).clamp(0.0, 1.0);
                return;
            }
            _ => {}
        }
        // Within the surface the law itself pulls, above it the neck as the spring would.
        let stretched = if touch.position > 0.0 {
            touch.borne()
        } else {
            touch.stiffness * touch.position + touch.damping * touch.velocity + touch.extra
        };
        if form == form::BRIDGE {
            touch.force = if touch.position > 0.0 {
                touch.force.max(0.0) + stretched.min(0.0).max(-values[0])
            } else {
                -values[0] * (1.0 + touch.position / values[1].max(f64::MIN_POSITIVE)).max(0.0)
            };
            return;
        }
        let mut pull = values[0];
        if form == form::COHESIVE {
            let beyond = (-touch.position - pull / touch.stiffness.max(f64::MIN_POSITIVE)).max(0.0);
            pull *= (1.0 - beyond / values[2].max(f64::MIN_POSITIVE)).max(0.0);
        }
        if touch.velocity < 0.0 || touch.position < 0.0 {
            touch.force = touch.force.max(0.0) + stretched.min(0.0).max(-pull);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
    use crate::rig::Contact;

    /// Force and place of an adhering sphere by the radius of its circle of contact, as Johnson, Kendall and Roberts state them: radius of
    /// the sphere, reduced modulus, work of adhesion.
    fn by_circle(radius: f64, modulus: f64, work: f64, circle: f64) -> [f64; 2] {
        let pi = std::f64::consts::PI;
        let place = circle.powi(2) / radius - (2.0 * pi * work * circle / modulus).sqrt();
        let force =
            4.0 * modulus * circle.powi(3) / (3.0 * radius) - (8.0 * pi * work * modulus * circle.powi(3)).sqrt();
        [place, force]
    }

    #[test]
    fn an_adhering_sphere_is_that_of_johnson_kendall_and_roberts_and_lets_go_where_theirs_does() {
        let (radius, modulus, work): (f64, f64, f64) = (5e-3, 1e6, 0.05);
        let hertz = 4.0 / 3.0 * modulus * radius.sqrt();
        let pull_off = 1.5 * std::f64::consts::PI * work * radius;
        let smallest = (std::f64::consts::PI * work * radius.powi(2) / (8.0 * modulus)).cbrt();
        let deepest: f64 = 1e-5;
        let contact = Contact { surface: 0.0, stiffness: hertz * deepest.sqrt(), damping: 0.0, bilateral: false };
        let spring = crate::effects::find("nonlinear_stiffness").unwrap();
        let actives = [
            ActiveEffect { effect: spring, form: 0, values: &[1.5, deepest] },
            ActiveEffect { effect: &Adhesion, form: form::SPHERE, values: &[pull_off] },
        ];
        let mut law = ContactSimulator::new(contact, &actives);
        let mut at = |place: f64| law.step(0.0, 1e-3, place, -1e-6, 0.0, 0.0);
        assert_eq!(at(-1e-6), 0.0, "nothing acts before the touch");
        at(deepest);
        let mut lowest = f64::INFINITY;
        // Out along the circle, which shrinks to its least; the force is exact to the law's rounding.
        for part in 0..=100 {
            let circle = smallest * (1.0 + 4.0 * (1.0 - f64::from(part) / 100.0) + 1e-6);
            let [place, force] = by_circle(radius, modulus, work, circle);
            if place <= deepest {
                assert!((at(place) - force).abs() < 1e-6 * pull_off, "{place}: {} {force}", at(place));
                lowest = lowest.min(force);
            }
        }
        // The greatest pull along a given motion is the pull-off force, passed on the way to 5/9 of it.
        assert!((lowest + pull_off).abs() < 1e-3 * pull_off, "{lowest} {pull_off}");
        let [last, force] = by_circle(radius, modulus, work, smallest);
        assert!((force + 5.0 / 9.0 * pull_off).abs() < 1e-3 * pull_off, "{force}");
        assert_eq!(at(last - 1e-9), 0.0);
        assert_eq!(at(last + 1e-9), 0.0, "once let go it does not pull again");
    }

    /// A tip of 4 N/m that pulls by 80 nN on its way out and pushes by 250 nN: small pulls, which grow in proportion, end where the spring pulls as
    /// much, 12 nN at 3 nm.
    #[test]
    fn a_pull_that_was_measured_is_tried_at_its_own_size() {
        let scene = ExcitationStats {
            depth: 6e-8,
            force: 2.5e-7,
            pull: 8e-8,
            travel: (-5e-8, 7e-8),
            stiffness: 4.0,
            releases: 3,
            ..ExcitationStats::default()
        };
        for form in [
            0,
            form::ATTRACTION,
            form::COHESIVE,
            form::BRIDGE,
            form::CAPILLARY,
            form::SPHERE,
            form::BOND,
            form::BILINEAR,
        ] {
            let whole = |start: &Start| start.linear_parameters.is_empty() && start.values[0] == scene.pull;
            let starts: Vec<Start> = Adhesion.starts(form, &scene).into_iter().filter(whole).collect();
            assert!(!starts.is_empty(), "form {form}");
            let is_near = |start: &Start| (start.values[1] / 2e-8).ln().abs() < 0.1;
            assert!(form == form::SPHERE || starts.iter().any(is_near), "form {form}: {starts:?}");
        }
        let none = ExcitationStats { pull: 0.0, ..scene };
        assert!(Adhesion.starts(0, &none).iter().all(|start| !start.linear_parameters.is_empty()));
    }

    /// A tape that pulls by 1.6 N at 0.4 mm and softens to nothing at 1.5 mm: half of it is seen at 0.95 mm, and a bridge that ends at 1.5 mm has half at 0.75 mm.
    #[test]
    fn a_pull_is_tried_to_the_height_where_it_was_seen_to_end() {
        let scene = |half_pull_height: f64| ExcitationStats {
            depth: 1.2e-3,
            force: 4.8,
            pull: 1.6,
            half_pull_height,
            travel: (-3e-3, 1.2e-3),
            stiffness: 4000.0,
            releases: 3,
            ..ExcitationStats::default()
        };
        let is_tried = |form: usize, half: f64, values: &[f64]| {
            let is_it = |start: &Start| start.values.iter().zip(values).all(|(a, b)| (a / b - 1.0).abs() < 1e-9);
            Adhesion.starts(form, &scene(half)).iter().any(is_it)
        };
        assert!(is_tried(form::COHESIVE, 0.95e-3, &[1.6, 1.5e-3, 1.1e-3]));
        assert!(is_tried(form::BRIDGE, 0.75e-3, &[1.6, 1.5e-3]) && is_tried(form::BOND, 0.75e-3, &[1.6, 0.75e-3]));
        assert!(Adhesion.starts(form::COHESIVE, &scene(0.0)).iter().all(|start| start.values[2] > start.values[1]));
    }

    /// A neck that is three times as stiff as the spring of 100 N/m and softens from 0.3 N at 1 mm to nothing at 4 mm.
    #[test]
    fn a_neck_of_its_own_stiffness_rises_to_its_peak_and_falls_to_its_end() {
        let contact = Contact { surface: 0.0, stiffness: 100.0, damping: 0.0, bilateral: false };
        let actives = [ActiveEffect { effect: &Adhesion, form: form::BILINEAR, values: &[0.3, 4e-3, 1e-3] }];
        let mut law = ContactSimulator::new(contact, &actives);
        let path = [-1e-3, 5e-3, -0.5e-3, -1e-3, -2.5e-3, -4e-3, -4.1e-3, -1e-3];
        let forces = path.map(|place| law.step(0.0, 1e-3, place, -1e-3, 0.0, 0.0));
        let expected = [0.0, 0.5, -0.15, -0.3, -0.15, 0.0, 0.0, 0.0];
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force - expected).abs() < 1e-12, "{forces:?}");
        }
        // A peak beyond the end, or beyond where the spring would pull as much, is there.
        for (values, expected) in [([0.3, 2e-3, 9e-3], -0.15), ([0.3, 5e-3, 4e-3], -0.1)] {
            let actives = [ActiveEffect { effect: &Adhesion, form: form::BILINEAR, values: &values }];
            let mut law = ContactSimulator::new(contact, &actives);
            let forces =
                [1e-3, -1e-3, values[1], -values[1] - 1e-4].map(|place| law.step(0.0, 1e-3, place, -1e-3, 0.0, 0.0));
            assert!((forces[1] - expected).abs() < 1e-12 && forces[3] == 0.0, "{forces:?}");
        }
    }

    #[test]
    fn a_liquid_bridge_pulls_alike_in_contact_and_less_with_height_and_ruptures() {
        let contact = Contact { surface: 0.0, stiffness: 100.0, damping: 0.0, bilateral: false };
        let actives = [ActiveEffect { effect: &Adhesion, form: form::CAPILLARY, values: &[0.4, 2e-3] }];
        let mut law = ContactSimulator::new(contact, &actives);
        let path = [-1e-3, 1e-3, 5e-3, 1e-9, -1e-3, -1.9e-3, -2.1e-3, -1e-3];
        let forces = path.map(|place| law.step(0.0, 1e-3, place, -1e-3, 0.0, 0.0));
        let expected = [0.0, 0.1 - 0.4, 0.5 - 0.4, -0.4, -0.2, -0.02, 0.0, 0.0];
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force - expected).abs() < 1e-6, "{forces:?}");
        }
    }

    /// A pull of its own stiffness, 200 N/m beside the spring's 100 N/m; what broke does not pull until the next touch.
    #[test]
    fn a_bond_stretches_by_its_own_stiffness_and_breaks_at_its_length() {
        let contact = Contact { surface: 0.0, stiffness: 100.0, damping: 0.0, bilateral: false };
        let actives = [ActiveEffect { effect: &Adhesion, form: form::BOND, values: &[0.4, 2e-3] }];
        let mut law = ContactSimulator::new(contact, &actives);
        let path = [-1e-3, 5e-3, 1e-9, -1e-3, -1.9e-3, -0.5e-3, -2.1e-3, -1e-3, 1e-3, -1e-3];
        let forces = path.map(|place| law.step(0.0, 1e-3, place, -1e-3, 0.0, 0.0));
        let expected = [0.0, 0.5, 0.0, -0.2, -0.38, -0.1, 0.0, 0.0, 0.1, -0.2];
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force - expected).abs() < 1e-6, "{forces:?}");
        }
    }
}
