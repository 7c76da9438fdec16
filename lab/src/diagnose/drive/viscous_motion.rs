//! A body under a constant force and viscous friction: exact, however long the step is beside the time in which the friction stops it.

/// Terms of the series beyond which, at [`SHORT`], nothing is left of sixteen digits.
const SHORT: f64 = 1e-2;

/// Motion over a step: m v' = force - b v, with `rate` b / m (1/s) and `acceleration` force / m.
#[derive(Debug, Clone, Copy)]
pub struct ViscousMotion {
    velocity: f64,
    acceleration: f64,
    rate: f64,
}

impl ViscousMotion {
    /// From `velocity`, m/s or rad/s.
    #[must_use]
    pub const fn new(velocity: f64, acceleration: f64, rate: f64) -> Self {
        Self { velocity, acceleration, rate }
    }

    /// Way and velocity after `step` seconds: v exp(-x) + a step E(x) and step (v E(x) + a step G(x)), x = rate step, E(x) = (1 - exp(-x)) / x,
    /// G(x) = (1 - E(x)) / x.
    #[must_use]
    pub fn after(&self, step: f64) -> [f64; 2] {
        let [first, second] = means(self.rate * step);
        let pushed = self.acceleration * step;
        let way = step * (self.velocity * first + pushed * second);
        [way, self.velocity * (1.0 - self.rate * step * first) + pushed * first]
    }

    /// When it stands still, s; not a number where it never does.
    #[must_use]
    pub fn stops_after(&self) -> f64 {
        let braked = -self.velocity / self.acceleration;
        let part = self.rate * braked;
        if part.abs() < SHORT {
            braked * (1.0 - part * (0.5 - part * (1.0 / 3.0 - part * (0.25 - 0.2 * part))))
        } else {
            part.ln_1p() / self.rate
        }
    }
}

/// E and G of [`ViscousMotion::after`].
fn means(part: f64) -> [f64; 2] {
    if part.abs() < SHORT {
        let second = 0.5 - part * (1.0 / 6.0 - part * (1.0 / 24.0 - part * (1.0 / 120.0 - part / 720.0)));
        return [1.0 - part * second, second];
    }
    let first = -(-part).exp_m1() / part;
    [first, (1.0 - first) / part]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By small steps of the midpoint rule, from short steps to ones in which the friction stops the body many times over.
    #[test]
    fn a_step_is_as_many_small_ones() {
        for rate in [0.0, 0.03, 2.0, 60.0] {
            let (velocity, acceleration, step) = (0.3, -0.7, 0.2);
            let [way, after] = ViscousMotion::new(velocity, acceleration, rate).after(step);
            let (mut x, mut v) = (0.0, velocity);
            const STEPS: usize = 200_000;
            let small = step / STEPS as f64;
            for _ in 0..STEPS {
                let middle = v + 0.5 * small * (acceleration - rate * v);
                let next = v + small * (acceleration - rate * middle);
                (x, v) = (x + 0.5 * small * (v + next), next);
            }
            // Rounding of 2e5 sums, and (60 * 1e-6)^2 of the rule.
            assert!((way - x).abs() < 1e-9 && (after - v).abs() < 1e-9, "{rate}: {way} {x} {after} {v}");
        }
    }

    #[test]
    fn the_series_goes_on_as_the_exponential() {
        let (below, above) = (means(SHORT * (1.0 - 1e-9)), means(SHORT * (1.0 + 1e-9)));
        // A step of 2e-11 in the argument, and sixteen digits over a hundredth.
        assert!((below[0] - above[0]).abs() < 2e-11 && (below[1] - above[1]).abs() < 1e-10, "{below:?} {above:?}");
    }

    #[test]
    fn where_it_stops_it_has_no_velocity() {
        for rate in [0.0, 1e-3, 0.5, 40.0] {
            let motion = ViscousMotion::new(0.2, -1.5, rate);
            let stops = motion.stops_after();
            assert!(stops > 0.0 && motion.after(stops)[1].abs() < 1e-12, "{rate}: {stops}");
        }
        assert!(!ViscousMotion::new(0.2, 1.5, 40.0).stops_after().is_finite());
    }
}
