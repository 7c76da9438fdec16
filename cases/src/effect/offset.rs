//! A zero that is none: `force_bias`, `force_drift`.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// What the sensor reads when nothing touches.
#[derive(Debug, Clone, Copy, Default)]
pub struct Offset {
    bias: f64,
    /// Limit and time constant of an exponential drift; rate alone where the time is infinite.
    drift: f64,
    rate: f64,
    time: f64,
}

impl Offset {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let warming = if self.time > 0.0 { -self.drift * (-t / self.time).exp_m1() } else { 0.0 };
        self.bias + self.rate * t + warming
    }
}

/// `force_bias`
#[derive(Debug)]
pub struct ForceBias {
    unit: f64,
}

impl ForceBias {
    /// Up or down.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { unit: 0.01 * scene.force * sign(chance) }
    }
}

impl Shape for ForceBias {
    fn form(&self) -> &'static str {
        "constant"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("bias", size * self.unit, Unit::Force)]
    }
}

impl Acting for ForceBias {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.offset.get_or_insert_default().bias = size * self.unit;
    }
}

/// `force_drift`; every trial starts at zero, as a tared sensor does.
#[derive(Debug)]
pub struct ForceDrift {
    duration: f64,
    /// s, 0 for a steady drift
    time: f64,
    unit: f64,
}

impl ForceDrift {
    /// Steady, or as a sensor warms up.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let duration = scene.duration;
        let time = if chance.random_bool(0.6) { 0.0 } else { duration * chance.random_range(0.3..0.8) };
        Self { duration, time, unit: 0.01 * scene.force * sign(chance) }
    }
}

impl Shape for ForceDrift {
    fn form(&self) -> &'static str {
        if self.time > 0.0 { "exponential in time" } else { "linear in time" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 80.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let total = size * self.unit;
        if self.time > 0.0 {
            vec![Parameter::new("drift", total, Unit::Force), Parameter::new("time_constant", self.time, Unit::Time)]
        } else {
            vec![Parameter::new("rate", total / self.duration, Unit::ForceRate)]
        }
    }
}

impl Acting for ForceDrift {
    fn put(&self, size: f64, physics: &mut Physics) {
        let offset = physics.gauge.offset.get_or_insert_default();
        let total = size * self.unit;
        if self.time > 0.0 {
            (offset.drift, offset.time) = (total, self.time);
        } else {
            offset.rate = total / self.duration;
        }
    }
}
