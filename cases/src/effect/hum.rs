//! `mains_hum`: periodic in time, in and out of contact.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, pick};
use crate::physics::Physics;
use crate::scale::Unit;

/// A sine and one of its harmonics.
#[derive(Debug, Clone, Copy)]
pub struct Hum {
    amplitude: f64,
    rate: f64,
    phase: f64,
    order: f64,
    share: f64,
}

impl Hum {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let angle = self.rate * t + self.phase;
        self.amplitude * (angle.sin() + self.share * (self.order * angle + 1.0).sin())
    }
}

/// `mains_hum`; the phase is each trial's own.
#[derive(Debug)]
pub struct MainsHum {
    frequency: f64,
    phases: [f64; 2],
    order: f64,
    share: f64,
    unit: f64,
}

impl MainsHum {
    /// As the mains are: within a tenth of a percent of 50 or 60 Hz.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let frequency = pick(chance, &[50.0, 60.0]) * (1.0 + chance.random_range(-1e-3..1e-3));
        let phases = [chance.random_range(0.0..TAU), chance.random_range(0.0..TAU)];
        let share = if chance.random_bool(0.4) { 0.0 } else { chance.random_range(0.1..0.5) };
        Self { frequency, phases, order: pick(chance, &[2.0, 3.0]), share, unit: 0.01 * scene.force }
    }
}

impl Shape for MainsHum {
    fn form(&self) -> &'static str {
        if self.share > 0.0 { "a sine and a harmonic" } else { "a sine" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 80.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("amplitude", size * self.unit, Unit::Force),
            Parameter::new("frequency", self.frequency, Unit::Frequency),
        ]
    }
}

impl Acting for MainsHum {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (amplitude, rate, phase) = (size * self.unit, TAU * self.frequency, self.phases[physics.trial % 2]);
        physics.gauge.hum = Some(Hum { amplitude, rate, phase, order: self.order, share: self.share });
    }
}
