//! A sensor that ends or is off in its gain: `force_saturation`, `force_gain`.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::force_range::ForceRange;
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// `force_saturation`
#[derive(Debug)]
pub struct ForceSaturation {
    peak: f64,
    knee: f64,
}

impl ForceSaturation {
    /// Below the peak of the trials.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { peak: motion.force, knee: if rng.random_bool(0.6) { 0.0 } else { rng.random_range(0.01..0.05) } }
    }

    /// With a sharp end below the peak of the trials.
    #[must_use]
    pub fn sharp(motion: &NominalMotion) -> Self {
        Self { peak: motion.force, knee: 0.0 }
    }

    fn limit(&self, size: f64) -> f64 {
        self.peak / (1.0 + size) / (1.0 - self.knee)
    }
}

impl EffectShape for ForceSaturation {
    fn form(&self) -> &'static str {
        if self.knee == 0.0 { "clipping" } else { "clipping with a rounded knee" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.2, 3.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("limit", self.limit(size), Unit::Force)]
    }
}

impl SimulatedEffect for ForceSaturation {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.range = Some(ForceRange { limit: self.limit(size), knee: self.knee });
    }
}

/// `force_gain`
#[derive(Debug)]
pub struct ForceGain {
    sign: f64,
}

impl ForceGain {
    /// Too much or too little.
    #[must_use]
    pub fn draw(rng: &mut CaseRng) -> Self {
        Self { sign: sign(rng) }
    }
}

impl EffectShape for ForceGain {
    fn form(&self) -> &'static str {
        "constant factor"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.02, 0.5)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("gain", 1.0 + self.sign * size, Unit::One)]
    }
}

impl SimulatedEffect for ForceGain {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.gain_error = self.sign * size;
    }
}
