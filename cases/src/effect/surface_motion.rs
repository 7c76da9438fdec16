//! `surface_motion`: the touched surface moves by itself.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::surface_motion::SurfacePath;
use crate::rng::{CaseRng, log_uniform, sign};
use crate::scale::Unit;

/// `surface_motion`; a sine has a phase of its own in every trial.
#[derive(Debug)]
pub struct SurfaceMotion {
    /// Hz, 0 for a drift
    frequency: f64,
    phases: [f64; 2],
    duration: f64,
    unit: f64,
}

impl SurfaceMotion {
    /// A sine as of breathing or pulse, or a slow drift.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let frequency = if rng.random_bool(0.7) { log_uniform(rng, 0.2, 3.0) } else { 0.0 };
        let phases = [rng.random_range(0.0..TAU), rng.random_range(0.0..TAU)];
        Self { frequency, phases, duration: motion.duration, unit: 0.01 * motion.depth * sign(rng) }
    }

    fn velocity(&self, size: f64) -> f64 {
        size * self.unit / self.duration
    }
}

impl EffectShape for SurfaceMotion {
    fn form(&self) -> &'static str {
        if self.frequency > 0.0 { "a sine in time" } else { "a drift" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        if self.frequency > 0.0 {
            let amplitude = EffectParameter::new("amplitude", size * self.unit.abs(), Unit::Length);
            vec![amplitude, EffectParameter::new("frequency", self.frequency, Unit::Frequency)]
        } else {
            vec![EffectParameter::new("velocity", self.velocity(size), Unit::Velocity)]
        }
    }
}

impl SimulatedEffect for SurfaceMotion {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let phase = self.phases[model.trial % 2];
        model.contact.surface_path = Some(if self.frequency > 0.0 {
            SurfacePath::Sine { amplitude: size * self.unit.abs(), rate: TAU * self.frequency, phase }
        } else {
            SurfacePath::Drift { velocity: self.velocity(size) }
        });
    }
}
