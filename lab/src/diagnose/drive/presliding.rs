//! How dry friction builds up: over a way before all of it slides.
//!
//! Elements in parallel, each a spring whose force ends at its own share of the friction (W. D. Iwan, *J. Appl. Mech.* 33, 1966, 893; F.
//! Al-Bender, V. Lampaert, J. Swevers, *IEEE Trans. Autom. Control* 50, 2005, 1883: Maxwell slips, whose limit together is the law of
//! sliding). From rest their sum follows level (1 - exp(-way / length)), the curve of Dahl and of the bristles of LuGre, along chords; unlike
//! those it does not creep where the body is at rest and only its measured position trembles.

/// Elements.
const ELEMENTS: usize = 4;

/// Ways over lengths at which the elements begin to slide: ends of the chords.
const YIELDS: [f64; ELEMENTS] = [0.25, 0.65, 1.5, 3.0];

/// Share of the friction of each: the change of the chord's slope at its end, times the way there. They sum to one.
const SHARES: [f64; ELEMENTS] = [0.063_909, 0.198_529, 0.372_711, 0.364_851];

/// How far each element is stretched, over what it slides at: -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slips([f64; ELEMENTS]);

/// A body on its way through a step, under constant forces.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// m/s or rad/s at its start.
    pub velocity: f64,
    /// Everything but friction, N or N m.
    pub push: f64,
    /// N s/m or N m s/rad.
    pub viscous: f64,
    /// kg or kg m^2.
    pub inertia: f64,
    /// s
    pub duration: f64,
}

impl Slips {
    /// Moves them by `way`, over their `length`, without a body.
    pub fn follow(&mut self, way: f64, length: f64) {
        for (stretch, end) in self.0.iter_mut().zip(YIELDS) {
            *stretch = (*stretch + way / (length * end)).clamp(-1.0, 1.0);
        }
    }

    /// Takes a body whose friction is `level` and builds up over `length` through `step`; the way and the velocity at its end. The force of the
    /// elements is that at the end of the step, so that a spring too stiff for the step holds the body instead of throwing it.
    #[must_use]
    pub fn advance(&mut self, level: f64, length: f64, step: &Step) -> [f64; 2] {
        let pace = 0.5 * step.duration / step.inertia;
        let stiffness = level / length;
        // Mean velocity where the elements that do not slide have the force `held` and the stiffness `springs`, the others `slid`.
        let mean = |slid: f64, held: f64, springs: f64| {
            (step.velocity + pace * (step.push - level * (slid + held)))
                / (1.0 + pace * (step.viscous + springs * step.duration))
        };
        let direction = step.velocity.signum();
        let mut middle = mean(direction, 0.0, 0.0);
        let mut springs = 0.0;
        let all_slide = |stretch: &[f64; ELEMENTS], way: f64| {
            stretch.iter().zip(YIELDS).all(|(stretch, end)| stretch * direction + way / (length * end) >= 1.0)
        };
        if !all_slide(&self.0, middle * direction * step.duration) {
            // All hold at first; those that are stretched too far slide, and so the others have to hold more.
            let mut slides = [0.0; ELEMENTS];
            for _ in 0..=ELEMENTS {
                let (mut slid, mut held) = (0.0, 0.0);
                springs = 0.0;
                for at in 0..ELEMENTS {
                    if slides[at] == 0.0 {
                        held += SHARES[at] * self.0[at];
                        springs += stiffness * SHARES[at] / YIELDS[at];
                    } else {
                        slid += SHARES[at] * slides[at];
                    }
                }
                middle = mean(slid, held, springs);
                let mut is_new = false;
                for at in 0..ELEMENTS {
                    let stretch = self.0[at] + middle * step.duration / (length * YIELDS[at]);
                    if slides[at] == 0.0 && stretch.abs() > 1.0 {
                        (slides[at], is_new) = (stretch.signum(), true);
                    }
                }
                if !is_new {
                    break;
                }
            }
        }
        let way = middle * step.duration;
        self.follow(way, length);
        // The midpoint rule, and where the springs swing faster than the steps show, the mean velocity: else that would turn in each step.
        let swing = 0.5 * pace * springs * step.duration;
        [way, middle + (middle - step.velocity) / (1.0 + swing * swing)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_are_those_of_an_exponential() {
        let reached = |way: f64| (1.0 - (-way).exp()) / (1.0 - (-YIELDS[ELEMENTS - 1]).exp());
        let mut slips = Slips::default();
        let mut before = 0.0;
        for end in YIELDS {
            slips.follow((end - before) * 2e-3, 2e-3);
            before = end;
            let force: f64 = slips.0.iter().zip(SHARES).map(|(stretch, share)| stretch * share).sum();
            // Shares have six digits.
            assert!((force - reached(end)).abs() < 3e-6, "{end} {force}");
        }
    }

    #[test]
    fn below_the_friction_a_body_is_held_by_the_springs_and_above_it_slides() {
        let settled = |push: f64, length: f64| {
            let (mut slips, mut velocity, mut position) = (Slips::default(), 0.0, 0.0);
            for _ in 0..4000 {
                let step = Step { velocity, push, viscous: 40.0, inertia: 2.0, duration: 1e-3 };
                let [way, after] = slips.advance(1.0, length, &step);
                (position, velocity) = (position + way, after);
            }
            (position, velocity)
        };
        // Within the first chord, 0.25 of the length and 0.2328 of the friction.
        let (position, velocity) = settled(0.1, 1e-3);
        assert!(
            (position / (0.1 / 0.232_789 * 0.25e-3) - 1.0).abs() < 1e-3 && velocity.abs() < 1e-6,
            "{position} {velocity}"
        );
        // Springs of a nanometre: at rest as under a set-valued law.
        let (position, velocity) = settled(0.9, 1e-9);
        assert!(position.abs() < 1e-8 && velocity.abs() < 1e-8, "{position} {velocity}");
        // 0.5 N more than the friction against 40 N s/m.
        assert!((settled(1.5, 1e-3).1 - 0.5 / 40.0).abs() < 1e-9);
    }
}
