//! Outside of the list: surfaces that live.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// A sharp beat and a weaker echo, once a period, whenever the tool touches.
#[derive(Debug, Clone, Copy)]
pub struct Heartbeat {
    height: f64,
    period: f64,
    start: f64,
}

impl Heartbeat {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let phase = ((t + self.start) / self.period).fract();
        let hump = |at: f64, width: f64| (-((phase - at) / width).powi(2)).exp();
        self.height * (hump(0.2, 0.05) + 0.4 * hump(0.45, 0.07))
    }
}

/// A pulse that is no sine.
#[derive(Debug)]
pub struct Beating {
    period: f64,
    starts: [f64; 2],
    unit: f64,
}

impl Beating {
    /// As hearts beat.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let period = chance.random_range(0.6..1.2);
        let starts = [chance.random_range(0.0..period), chance.random_range(0.0..period)];
        Self { period, starts, unit: 0.01 * scene.force }
    }
}

impl Shape for Beating {
    fn form(&self) -> &'static str {
        "a beat and its echo, in contact"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let height = Parameter::new("height", size * self.unit, Unit::Force);
        vec![height, Parameter::new("period", self.period, Unit::Time)]
    }
}

impl Acting for Beating {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (height, start) = (size * self.unit, self.starts[physics.trial % 2]);
        physics.contact.heartbeat = Some(Heartbeat { height, period: self.period, start });
    }
}

/// A muscle that pushes back some time after each touch, and lets go again.
#[derive(Debug, Clone, Copy)]
pub struct Reflex {
    height: f64,
    wait: f64,
    rise: f64,
    touched: f64,
}

impl Reflex {
    /// N, a step `dt` after the last call.
    pub fn advance(&mut self, touching: bool, dt: f64) -> f64 {
        self.touched = if touching { self.touched + dt } else { 0.0 };
        let since = (self.touched - self.wait).max(0.0) / self.rise;
        // Rises to one at since = 1 and fades over the next few rises.
        self.height * since * (1.0 - since).exp()
    }
}

/// A surface that answers a touch.
#[derive(Debug)]
pub struct Answering {
    wait: f64,
    rise: f64,
    unit: f64,
}

impl Answering {
    /// As fast as nerves are.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let (wait, rise) = (chance.random_range(0.05..0.15), chance.random_range(0.1..0.4));
        Self { wait, rise, unit: 0.02 * scene.force }
    }
}

impl Shape for Answering {
    fn form(&self) -> &'static str {
        "a push back some time after each touch"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("height", size * self.unit, Unit::Force),
            Parameter::new("wait", self.wait, Unit::Time),
            Parameter::new("rise", self.rise, Unit::Time),
        ]
    }
}

impl Acting for Answering {
    fn put(&self, size: f64, physics: &mut Physics) {
        let height = size * self.unit;
        physics.contact.reflex = Some(Reflex { height, wait: self.wait, rise: self.rise, touched: 0.0 });
    }
}
