//! `surface_motion`: the touched surface moves by itself.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, log_uniform, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// Where the surface is beyond its place.
#[derive(Debug, Clone, Copy)]
pub enum Motion {
    /// To and fro.
    Sine {
        /// m
        amplitude: f64,
        /// rad/s
        rate: f64,
        /// rad
        phase: f64,
    },
    /// Away for good.
    Drift {
        /// m/s
        velocity: f64,
    },
}

impl Motion {
    /// Shift and velocity at time `t`.
    #[must_use]
    pub fn at(self, t: f64) -> (f64, f64) {
        match self {
            Self::Sine { amplitude, rate, phase } => {
                let (sine, cosine) = (rate * t + phase).sin_cos();
                (amplitude * sine, amplitude * rate * cosine)
            }
            Self::Drift { velocity } => (velocity * t, velocity),
        }
    }
}

/// `surface_motion`; a sine has a phase of its own in every trial.
#[derive(Debug)]
pub struct Surface {
    /// Hz, 0 for a drift
    frequency: f64,
    phases: [f64; 2],
    duration: f64,
    unit: f64,
}

impl Surface {
    /// A sine as of breathing or pulse, or a slow drift.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let frequency = if chance.random_bool(0.7) { log_uniform(chance, 0.2, 3.0) } else { 0.0 };
        let phases = [chance.random_range(0.0..TAU), chance.random_range(0.0..TAU)];
        Self { frequency, phases, duration: scene.duration, unit: 0.01 * scene.depth * sign(chance) }
    }

    fn velocity(&self, size: f64) -> f64 {
        size * self.unit / self.duration
    }
}

impl Shape for Surface {
    fn form(&self) -> &'static str {
        if self.frequency > 0.0 { "a sine in time" } else { "a drift" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        if self.frequency > 0.0 {
            let amplitude = Parameter::new("amplitude", size * self.unit.abs(), Unit::Length);
            vec![amplitude, Parameter::new("frequency", self.frequency, Unit::Frequency)]
        } else {
            vec![Parameter::new("velocity", self.velocity(size), Unit::Velocity)]
        }
    }
}

impl Acting for Surface {
    fn put(&self, size: f64, physics: &mut Physics) {
        let phase = self.phases[physics.trial % 2];
        physics.contact.motion = Some(if self.frequency > 0.0 {
            Motion::Sine { amplitude: size * self.unit.abs(), rate: TAU * self.frequency, phase }
        } else {
            Motion::Drift { velocity: self.velocity(size) }
        });
    }
}
