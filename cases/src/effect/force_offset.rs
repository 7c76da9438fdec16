//! A zero that is none: `force_bias`, `force_drift`.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// `force_bias`
#[derive(Debug)]
pub struct ForceBias {
    unit: f64,
}

impl ForceBias {
    /// Up or down.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { unit: 0.01 * motion.force * sign(rng) }
    }
}

impl EffectShape for ForceBias {
    fn form(&self) -> &'static str {
        "constant"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("bias", size * self.unit, Unit::Force)]
    }
}

impl SimulatedEffect for ForceBias {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.offset.get_or_insert_default().bias = size * self.unit;
    }
}

/// `force_drift`; every trial starts at zero, as a tared sensor does.
#[derive(Debug)]
pub struct ForceDrift {
    duration: f64,
    /// s, 0 for a steady drift
    time: f64,
    unit: f64,
}

impl ForceDrift {
    /// Steady, or as a sensor warms up.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let duration = motion.duration;
        let time = if rng.random_bool(0.6) { 0.0 } else { duration * rng.random_range(0.3..0.8) };
        Self { duration, time, unit: 0.01 * motion.force * sign(rng) }
    }
}

impl EffectShape for ForceDrift {
    fn form(&self) -> &'static str {
        if self.time > 0.0 { "exponential in time" } else { "linear in time" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 80.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let total = size * self.unit;
        if self.time > 0.0 {
            vec![
                EffectParameter::new("drift", total, Unit::Force),
                EffectParameter::new("time_constant", self.time, Unit::Time),
            ]
        } else {
            vec![EffectParameter::new("rate", total / self.duration, Unit::ForceRate)]
        }
    }
}

impl SimulatedEffect for ForceDrift {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let offset = model.sensor.offset.get_or_insert_default();
        let total = size * self.unit;
        if self.time > 0.0 {
            (offset.drift, offset.time) = (total, self.time);
        } else {
            offset.rate = total / self.duration;
        }
    }
}
