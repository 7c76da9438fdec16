//! The adhesion of a sphere on Hertz's law.

use crate::effects::{ContactState, EffectState};

/// Steps of Newton's method, which comes down on the root from above and doubles its digits.
const STEPS: usize = 12;

/// Part of the root below which a step is the last: the next one would be as its square.
const SHORTEST_STEP: f64 = 1e-10;

/// A sphere that adheres (Johnson, Kendall, Roberts). The circle of contact is that of Hertz's law at a virtual depth h, from which a flat punch
/// of that circle is drawn back by b h^(1/4); b is what makes the greatest pull that asked for.
pub(super) struct Sphere {
    /// c of Hertz's law c x^1.5.
    hertz: f64,
    /// b.
    drawn_back: f64,
}

impl Sphere {
    fn new(hertz: f64, pull_off_force: f64) -> Self {
        Self { hertz, drawn_back: 4.0 / 3.0 * (pull_off_force / hertz).sqrt() }
    }

    /// Fourth root u of the least h with a balance: where u^4 - b u is least.
    fn least_root(&self) -> f64 {
        (0.25 * self.drawn_back).cbrt()
    }

    /// The place there, negative: below it no circle of contact has a balance.
    fn last_place(&self, least_root: f64) -> f64 {
        least_root * (least_root.powi(3) - self.drawn_back)
    }

    /// The fourth root u of h at `place`, no lower than [`Sphere::last_place`]: the greater root of u^4 - b u = place, where this is convex. `near`
    /// is a root not far from it, zero where none is known.
    fn root(&self, place: f64, near: f64) -> f64 {
        let slope = |root: f64| 4.0 * root.powi(3) - self.drawn_back;
        // Below the surface the slope is three times b at the least, and a near root leads to it; above it the two roots come together.
        let mut root = if place > 0.0 && slope(near) > 0.0 { near } else { self.above(place) };
        for _ in 0..STEPS {
            let step = (root.powi(4) - self.drawn_back * root - place) / slope(root);
            // From below the root a step ends above it, and may end far above it.
            root = if -step > root { (root - step).min(self.above(place)) } else { root - step };
            if step.abs() <= SHORTEST_STEP * root || slope(root) <= 0.0 {
                break;
            }
        }
        root
    }

    /// No less than the root at `place`. All derivatives are positive there, so the parabola about the least place meets it late, and exactly
    /// where the two roots meet, where Newton's steps alone would only halve.
    fn above(&self, place: f64) -> f64 {
        let least = self.least_root();
        let parabola = least + ((place - self.last_place(least)).max(0.0) / (6.0 * least * least)).sqrt();
        parabola.min(self.drawn_back.cbrt() + place.max(0.0).sqrt().sqrt())
    }

    /// The force where the fourth root of h is `root`.
    fn force(&self, root: f64) -> f64 {
        let cube = root.powi(3);
        self.hertz * cube * (cube - 1.5 * self.drawn_back)
    }

    /// Puts the adhering sphere in the place of the spring. state: whether the surface holds on, deepest place of this touch, c there, fourth
    /// root of h an instant ago, and the place at which it lets go, zero where that is not known.
    pub(super) fn act(pull_off_force: f64, state: &mut EffectState, touch: &mut ContactState) {
        let hertz_depth = touch.position.max(0.0) * touch.position.max(0.0).sqrt();
        if touch.position > 0.0 {
            if state[0] == 0.0 {
                (state[0], state[1], state[3]) = (1.0, 0.0, 0.0);
            }
            if touch.position > state[1] {
                (state[1], state[2], state[4]) = (touch.position, touch.spring / hertz_depth, 0.0);
            }
        }
        if state[0] == 0.0 || state[2] <= 0.0 || pull_off_force <= 0.0 {
            return;
        }
        let sphere = Self::new(state[2], pull_off_force);
        if touch.position <= 0.0 {
            if state[4] == 0.0 {
                state[4] = sphere.last_place(sphere.least_root());
            }
            if touch.position < state[4] {
                state[0] = 0.0;
                return;
            }
        }
        state[3] = sphere.root(touch.position, state[3]);
        touch.force += sphere.force(state[3]) - sphere.hertz * hertz_depth;
    }
}
