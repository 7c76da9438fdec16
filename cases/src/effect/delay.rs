//! A sensor that is late: `channel_delay`, `force_lag`, and the mass beyond it, `tool_inertia`.

use super::{Acting, Parameter, Shape, Sizes};
use crate::physics::Physics;
use crate::scale::Unit;

/// Pure delay, between steps by linear interpolation.
#[derive(Debug, Clone)]
pub struct Delay {
    /// The last readings, a ring.
    ring: Vec<f64>,
    at: usize,
    /// How far between its step and the next older one the delay ends.
    share: f64,
}

impl Delay {
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

/// `channel_delay`
#[derive(Debug)]
pub struct ChannelDelay;

impl Shape for ChannelDelay {
    fn form(&self) -> &'static str {
        "pure delay of the force"
    }

    fn sizes(&self) -> Sizes {
        // A quarter of a sample is what the clock leaves open.
        Sizes { smallest: 2.5e-4, first: 5e-4, largest: 0.01 }
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("delay", size, Unit::Time)]
    }
}

impl Acting for ChannelDelay {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.delay = Some(Delay::new(size, physics.step));
    }
}

/// `force_lag`: first order
#[derive(Debug)]
pub struct ForceLag;

impl Shape for ForceLag {
    fn form(&self) -> &'static str {
        "first order"
    }

    fn sizes(&self) -> Sizes {
        Sizes { smallest: 2.5e-4, first: 5e-4, largest: 0.03 }
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("time_constant", size, Unit::Time)]
    }
}

impl Acting for ForceLag {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.lag_s = size;
    }
}

/// `tool_inertia`: the reading holds `m a` besides
#[derive(Debug)]
pub struct ToolInertia {
    /// The moving mass, kg.
    pub mass: f64,
}

impl Shape for ToolInertia {
    fn form(&self) -> &'static str {
        "mass beyond the force sensor"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.03, 0.7)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("mass", size * self.mass, Unit::Mass)]
    }
}

impl Acting for ToolInertia {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.inertia = size * self.mass;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delay_shifts_by_whole_and_broken_steps() {
        for steps in [0.0, 0.25, 1.0, 3.0, 7.6] {
            let mut delay = Delay::new(steps * 1e-4 + 1e-12, 1e-4);
            let last = (0..100).map(|step| delay.pass(f64::from(step))).last();
            assert!((last.unwrap() - (99.0 - steps)).abs() < 1e-6, "{steps}: {last:?}");
        }
    }
}
