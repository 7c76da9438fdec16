//! Outside of the list: a force sensor on a spring of its own, and wires that hear the motor.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// A share of the force is read through a resonance: `y'' + 2 z w y' + w^2 (y - F) = 0`.
#[derive(Debug, Clone, Copy)]
pub struct Ringing {
    share: f64,
    rate: f64,
    ratio: f64,
    y: f64,
    slope: f64,
}

impl Ringing {
    /// The reading of `force` a step `dt` later.
    pub fn advance(&mut self, force: f64, dt: f64) -> f64 {
        let pull = self.rate * (self.rate * (force - self.y) - 2.0 * self.ratio * self.slope);
        self.slope += dt * pull;
        self.y += dt * self.slope;
        force + self.share * (self.y - force)
    }
}

/// A force that resonates.
#[derive(Debug)]
pub struct Resonance {
    frequency: f64,
    ratio: f64,
}

impl Resonance {
    /// Lightly damped between 15 and 40 Hz.
    #[must_use]
    pub fn draw(chance: &mut Chance) -> Self {
        Self { frequency: chance.random_range(15.0..40.0), ratio: chance.random_range(0.02..0.08) }
    }
}

impl Shape for Resonance {
    fn form(&self) -> &'static str {
        "a mass on a spring that rings on the force sensor"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.05, 1.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("share", size, Unit::One),
            Parameter::new("frequency", self.frequency, Unit::Frequency),
            Parameter::new("damping_ratio", self.ratio, Unit::One),
        ]
    }
}

impl Acting for Resonance {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (rate, ratio) = (TAU * self.frequency, self.ratio);
        physics.gauge.ringing = Some(Ringing { share: size, rate, ratio, y: 0.0, slope: 0.0 });
    }
}

/// Steps of the effort that couple into the reading.
#[derive(Debug)]
pub struct Crosstalk {
    unit: f64,
}

impl Crosstalk {
    /// In proportion to what the trials' effort is.
    #[must_use]
    pub fn draw(scene: &Scene) -> Self {
        Self { unit: 0.1 * scene.force / scene.effort }
    }
}

impl Shape for Crosstalk {
    fn form(&self) -> &'static str {
        "steps of the effort seen in the force"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 100.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("coupling", size * self.unit, Unit::One)]
    }
}

impl Acting for Crosstalk {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.crosstalk = size * self.unit;
    }
}
