//! `mains_hum`: periodic in time, in and out of contact.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::mains_hum::MainsTone;
use crate::rng::{CaseRng, pick};
use crate::scale::Unit;

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
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let frequency = pick(rng, &[50.0, 60.0]) * (1.0 + rng.random_range(-1e-3..1e-3));
        let phases = [rng.random_range(0.0..TAU), rng.random_range(0.0..TAU)];
        let share = if rng.random_bool(0.4) { 0.0 } else { rng.random_range(0.1..0.5) };
        Self { frequency, phases, order: pick(rng, &[2.0, 3.0]), share, unit: 0.01 * motion.force }
    }
}

impl EffectShape for MainsHum {
    fn form(&self) -> &'static str {
        if self.share > 0.0 { "a sine and a harmonic" } else { "a sine" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 80.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("amplitude", size * self.unit, Unit::Force),
            EffectParameter::new("frequency", self.frequency, Unit::Frequency),
        ]
    }
}

impl SimulatedEffect for MainsHum {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (amplitude, rate, phase) = (size * self.unit, TAU * self.frequency, self.phases[model.trial % 2]);
        model.sensor.mains_tone = Some(MainsTone { amplitude, rate, phase, order: self.order, share: self.share });
    }
}
