//! A surface that holds on.

mod neck;
mod spec;
mod sphere;
mod starts;

use self::spec::{SPEC, form};
use self::sphere::Sphere;
use crate::effects::{ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Foundation, Start};

/// See [`SPEC`].
pub struct Adhesion;

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
        starts::starts(form, scene)
    }

    fn act_on_contact(&self, form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        if touch.bilateral {
            return;
        }
        if form == form::SPHERE {
            Sphere::act(values[0], state, touch);
            return;
        }
        neck::act(form, values, state, touch);
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
}
