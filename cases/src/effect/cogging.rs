//! `cogging`: a force of the motor that is periodic in position.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::cogging::CoggingForce;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `cogging`
#[derive(Debug)]
pub struct Cogging {
    length: f64,
    phase: f64,
    second: f64,
    unit: f64,
}

impl Cogging {
    /// Some periods over the travel.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let length = (motion.travel.1 - motion.travel.0) / rng.random_range(3.0..12.0);
        let second = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.1..0.4) };
        Self { length, phase: rng.random_range(0.0..TAU), second, unit: 0.02 * motion.effort }
    }
}

impl EffectShape for Cogging {
    fn form(&self) -> &'static str {
        if self.second == 0.0 { "a sine over position" } else { "a sine over position and its harmonic" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 25.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let amplitude = EffectParameter::new("amplitude", size * self.unit, Unit::Force);
        vec![amplitude, EffectParameter::new("period", self.length, Unit::Length)]
    }
}

impl SimulatedEffect for Cogging {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (amplitude, wave) = (size * self.unit, TAU / self.length);
        model.drive.cogging = Some(CoggingForce { amplitude, wave, phase: self.phase, second: self.second });
    }
}
