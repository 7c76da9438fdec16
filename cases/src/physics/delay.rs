//! A delay line with linear interpolation between steps.

/// Pure delay, between steps by linear interpolation.
#[derive(Debug, Clone)]
pub struct DelayLine {
    /// The last readings, a ring.
    pub(crate) ring: Vec<f64>,
    pub(crate) at: usize,
    /// How far between its step and the next older one the delay ends.
    pub(crate) share: f64,
}

impl DelayLine {
    /// Of `delay` seconds, in steps of `dt`.
    #[must_use]
    pub fn new(delay: f64, dt: f64) -> Self {
        let steps = delay / dt;
        Self { ring: vec![0.0; steps as usize + 2], at: 0, share: steps.fract() }
    }

    /// Takes a reading in and hands out the late one.
    pub fn pass(&mut self, force: f64) -> f64 {
        let length = self.ring.len();
        self.ring[self.at] = force;
        self.at = (self.at + 1) % length;
        // The ring holds whole + 2 readings: at `at` the oldest, after it the one that is late by whole steps.
        let (older, newer) = (self.ring[self.at], self.ring[(self.at + 1) % length]);
        newer + self.share * (older - newer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delay_shifts_by_whole_and_broken_steps() {
        for steps in [0.0, 0.25, 1.0, 3.0, 7.6] {
            let mut delay = DelayLine::new(steps * 1e-4 + 1e-12, 1e-4);
            let last = (0..100).map(|step| delay.pass(f64::from(step))).last();
            assert!((last.unwrap() - (99.0 - steps)).abs() < 1e-6, "{steps}: {last:?}");
        }
    }
}
