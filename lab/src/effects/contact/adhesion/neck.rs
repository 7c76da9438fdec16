//! The pull of what is between tool and surface, by its height above the surface.

use super::spec::form;
use crate::effects::{ContactState, EffectState};

/// Whether the surface still holds on to a tool at `position`: from the first touch up to the `end` of the pull. The state keeps it.
fn holds_on(end: f64, position: f64, state: &mut EffectState) -> bool {
    if position > 0.0 {
        state[0] = 1.0;
    } else if position < -end {
        state[0] = 0.0;
    }
    state[0] != 0.0
}

/// Adds the pull of `form` with its `values` to the force of `touch`.
pub(super) fn act(form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
    if !holds_on(values[1], touch.position, state) {
        return;
    }
    match form {
        form::ATTRACTION => touch.force -= values[0],
        form::CAPILLARY | form::BOND | form::BILINEAR | form::SOFTENING => {
            touch.force -= values[0] * part(form, values, touch)
        }
        form::BRIDGE | form::EXPONENTIAL if touch.position <= 0.0 => {
            touch.force = -values[0] * part(form, values, touch)
        }
        _ => hold(form, values, touch),
    }
}

/// The part of the greatest pull that acts at the height of `touch`, of the forms that have one.
fn part(form: usize, values: &[f64], touch: &ContactState) -> f64 {
    let height = (-touch.position).max(0.0);
    let over = height / values[1].max(f64::MIN_POSITIVE);
    match form {
        form::BOND => over,
        form::EXPONENTIAL => {
            let over = height / values[2].max(f64::MIN_POSITIVE);
            over * (1.0 - over).exp()
        }
        form::BILINEAR | form::SOFTENING => {
            // A neck that is softer than the spring is the spring's own pull, as of the other forms.
            let softest = values[0] / touch.stiffness.max(f64::MIN_POSITIVE);
            let peak = values[2].min(values[1]).min(softest);
            let rising = height / peak.max(f64::MIN_POSITIVE);
            let falling = (values[1] - height) / (values[1] - peak).max(f64::MIN_POSITIVE);
            let falling = if form == form::SOFTENING { falling.max(0.0).powf(values[3]) } else { falling };
            rising.min(falling).clamp(0.0, 1.0)
        }
        _ => (1.0 - over).max(0.0),
    }
}

/// Lets the contact's own law pull, which beneath the surface it does by its damper, and above it as the spring would, by no more than the greatest pull.
fn hold(form: usize, values: &[f64], touch: &mut ContactState) {
    let is_within = touch.position > 0.0;
    let own = if is_within {
        touch.borne()
    } else {
        touch.stiffness * touch.position + touch.damping * touch.velocity + touch.extra
    };
    let mut pull = values[0];
    if form == form::COHESIVE {
        let beyond = (-touch.position - pull / touch.stiffness.max(f64::MIN_POSITIVE)).max(0.0);
        pull *= (1.0 - beyond / values[2].max(f64::MIN_POSITIVE)).max(0.0);
    }
    let pulls = matches!(form, form::BRIDGE | form::EXPONENTIAL) || touch.velocity < 0.0 || !is_within;
    if pulls {
        touch.force = touch.force.max(0.0) + own.min(0.0).max(-pull);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Adhesion;
    use super::*;
    use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
    use crate::rig::Contact;

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

    /// A pull of 0.3 N at 1 mm, of which x exp(1 - x) acts at x times that height: 0.3 exp(0.5) / 2 at half of it, 0.3 e / e^2 x 2 at twice. Within the surface the damper
    /// pulls, and by no more than the greatest pull.
    #[test]
    fn a_pull_that_falls_off_exponentially_is_greatest_at_its_peak() {
        let contact = Contact { surface: 0.0, stiffness: 100.0, damping: 50.0, bilateral: false };
        let actives = [ActiveEffect { effect: &Adhesion, form: form::EXPONENTIAL, values: &[0.3, 6e-3, 1e-3] }];
        let mut law = ContactSimulator::new(contact, &actives);
        let path = [
            (-1e-3, 1e-3, 0.0),
            (5e-3, -2e-3, 0.4),
            (1e-3, -4e-3, -0.1),
            (1e-3, -1e-2, -0.3),
            (-0.5e-3, -1e-3, -0.15 * 0.5f64.exp()),
            (-1e-3, -1e-3, -0.3),
            (-2e-3, -1e-3, -0.6 * (-1.0f64).exp()),
            (-5.9e-3, -1e-3, -1.77 * (-4.9f64).exp()),
            (-6.1e-3, -1e-3, 0.0),
            (-1e-3, 1e-3, 0.0),
        ];
        for (place, velocity, expected) in path {
            let force = law.step(0.0, 1e-3, place, velocity, 0.0, 0.0);
            assert!((force - expected).abs() < 1e-12, "{place}: {force} for {expected}");
        }
    }

    /// The neck above, whose pull of 0.3 N falls by the root of the way to its end: 0.3 sqrt(1 / 3) where a third of that way is left, and 0.3 sqrt(1 / 4) at a quarter.
    #[test]
    fn a_pull_that_falls_late_falls_by_a_power_of_the_way_to_its_end() {
        let contact = Contact { surface: 0.0, stiffness: 100.0, damping: 0.0, bilateral: false };
        let actives = [ActiveEffect { effect: &Adhesion, form: form::SOFTENING, values: &[0.3, 4e-3, 1e-3, 0.5] }];
        let mut law = ContactSimulator::new(contact, &actives);
        let path = [5e-3, -0.5e-3, -1e-3, -3e-3, -3.25e-3, -4.1e-3, -1e-3];
        let forces = path.map(|place| law.step(0.0, 1e-3, place, -1e-3, 0.0, 0.0));
        let expected = [0.5, -0.15, -0.3, -0.3 / 3f64.sqrt(), -0.15, 0.0, 0.0];
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force - expected).abs() < 1e-12, "{forces:?}");
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
