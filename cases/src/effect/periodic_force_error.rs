//! Outside of the list: a reading that ripples with the position, as of a cable that is bent.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::periodic_force_error::PositionRipple;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// An error of the sensor that is periodic in position.
#[derive(Debug)]
pub struct PeriodicForceError {
    length: f64,
    phase: f64,
    unit: f64,
}

impl PeriodicForceError {
    /// Some periods over the travel.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let length = (motion.travel.1 - motion.travel.0) / rng.random_range(3.0..12.0);
        Self { length, phase: rng.random_range(0.0..TAU), unit: 0.01 * motion.force }
    }
}

impl EffectShape for PeriodicForceError {
    fn form(&self) -> &'static str {
        "a sine over position in the reading"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let amplitude = EffectParameter::new("amplitude", size * self.unit, Unit::Force);
        vec![amplitude, EffectParameter::new("period", self.length, Unit::Length)]
    }
}

impl SimulatedEffect for PeriodicForceError {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (amplitude, wave) = (size * self.unit, TAU / self.length);
        model.sensor.ripple = Some(PositionRipple { amplitude, wave, phase: self.phase });
    }
}
