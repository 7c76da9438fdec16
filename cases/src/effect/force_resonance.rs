//! Outside of the list: a force sensor on a spring of its own, and wires that hear the motor.

use std::f64::consts::TAU;

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::force_resonance::SensorResonance;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// A force that resonates.
#[derive(Debug)]
pub struct ForceResonance {
    frequency: f64,
    ratio: f64,
}

impl ForceResonance {
    /// Lightly damped between 15 and 40 Hz.
    #[must_use]
    pub fn draw(rng: &mut CaseRng) -> Self {
        Self { frequency: rng.random_range(15.0..40.0), ratio: rng.random_range(0.02..0.08) }
    }
}

impl EffectShape for ForceResonance {
    fn form(&self) -> &'static str {
        "a mass on a spring that rings on the force sensor"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.05, 1.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("share", size, Unit::One),
            EffectParameter::new("frequency", self.frequency, Unit::Frequency),
            EffectParameter::new("damping_ratio", self.ratio, Unit::One),
        ]
    }
}

impl SimulatedEffect for ForceResonance {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (rate, ratio) = (TAU * self.frequency, self.ratio);
        model.sensor.ringing = Some(SensorResonance { share: size, rate, ratio, y: 0.0, slope: 0.0 });
    }
}

/// Steps of the effort that couple into the reading.
#[derive(Debug)]
pub struct EffortCrosstalk {
    unit: f64,
}

impl EffortCrosstalk {
    /// In proportion to what the trials' effort is.
    #[must_use]
    pub fn draw(motion: &NominalMotion) -> Self {
        Self { unit: 0.1 * motion.force / motion.effort }
    }
}

impl EffectShape for EffortCrosstalk {
    fn form(&self) -> &'static str {
        "steps of the effort seen in the force"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 100.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("coupling", size * self.unit, Unit::One)]
    }
}

impl SimulatedEffect for EffortCrosstalk {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.crosstalk = size * self.unit;
    }
}
