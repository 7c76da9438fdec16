//! `cogging`: a force of the motor that is periodic in position.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// `A (sin(2 pi x/l + phi) + r sin(4 pi x/l))`
#[derive(Debug, Clone, Copy)]
pub struct Cogging {
    amplitude: f64,
    wave: f64,
    phase: f64,
    second: f64,
}

impl Cogging {
    /// N against forward motion at `position`.
    #[must_use]
    pub fn force(&self, position: f64) -> f64 {
        let angle = self.wave * position;
        self.amplitude * ((angle + self.phase).sin() + self.second * (2.0 * angle).sin())
    }
}

/// `cogging`
#[derive(Debug)]
pub struct Teeth {
    length: f64,
    phase: f64,
    second: f64,
    unit: f64,
}

impl Teeth {
    /// Some periods over the travel.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let length = (scene.travel.1 - scene.travel.0) / chance.random_range(3.0..12.0);
        let second = if chance.random_bool(0.5) { 0.0 } else { chance.random_range(0.1..0.4) };
        Self { length, phase: chance.random_range(0.0..TAU), second, unit: 0.02 * scene.effort }
    }
}

impl Shape for Teeth {
    fn form(&self) -> &'static str {
        if self.second == 0.0 { "a sine over position" } else { "a sine over position and its harmonic" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 25.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let amplitude = Parameter::new("amplitude", size * self.unit, Unit::Force);
        vec![amplitude, Parameter::new("period", self.length, Unit::Length)]
    }
}

impl Acting for Teeth {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (amplitude, wave) = (size * self.unit, TAU / self.length);
        physics.drive.cogging = Some(Cogging { amplitude, wave, phase: self.phase, second: self.second });
    }
}
