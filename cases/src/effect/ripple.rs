//! Outside of the list: a reading that ripples with the position, as of a cable that is bent.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// `A sin(2 pi x/l + phi)` in the reading.
#[derive(Debug, Clone, Copy)]
pub struct Ripple {
    amplitude: f64,
    wave: f64,
    phase: f64,
}

impl Ripple {
    /// N at `position`.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        self.amplitude * (self.wave * position + self.phase).sin()
    }
}

/// An error of the sensor that is periodic in position.
#[derive(Debug)]
pub struct PeriodicError {
    length: f64,
    phase: f64,
    unit: f64,
}

impl PeriodicError {
    /// Some periods over the travel.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let length = (scene.travel.1 - scene.travel.0) / chance.random_range(3.0..12.0);
        Self { length, phase: chance.random_range(0.0..TAU), unit: 0.01 * scene.force }
    }
}

impl Shape for PeriodicError {
    fn form(&self) -> &'static str {
        "a sine over position in the reading"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let amplitude = Parameter::new("amplitude", size * self.unit, Unit::Force);
        vec![amplitude, Parameter::new("period", self.length, Unit::Length)]
    }
}

impl Acting for PeriodicError {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (amplitude, wave) = (size * self.unit, TAU / self.length);
        physics.gauge.ripple = Some(Ripple { amplitude, wave, phase: self.phase });
    }
}
