//! What becomes of the effort before it acts: `effort_saturation`, `effort_lag`. The recording holds the command.

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::actuator::{EffortLimit, FirstOrderLag};
use crate::scale::Unit;

/// `effort_saturation`
#[derive(Debug)]
pub struct EffortSaturation {
    peak: f64,
}

impl EffortSaturation {
    /// Below the peak that the trials ask for.
    #[must_use]
    pub fn draw(motion: &NominalMotion) -> Self {
        Self { peak: motion.effort }
    }

    fn limit(&self, size: f64) -> f64 {
        self.peak / (1.0 + size)
    }
}

impl EffectShape for EffortSaturation {
    fn form(&self) -> &'static str {
        "clipping"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.3, 3.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("limit", self.limit(size), Unit::Force)]
    }
}

impl SimulatedEffect for EffortSaturation {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.drive.effort_limit = Some(EffortLimit { limit: self.limit(size) });
    }
}

/// `effort_lag`
#[derive(Debug)]
pub struct EffortLag;

impl EffectShape for EffortLag {
    fn form(&self) -> &'static str {
        "first order"
    }

    fn size_range(&self) -> SizeRange {
        // Half a sample is what the hold of the effort leaves open; beyond that a whole one.
        SizeRange { smallest: 1.5e-3, initial: 2e-3, largest: 0.03 }
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("time_constant", size, Unit::Time)]
    }
}

impl SimulatedEffect for EffortLag {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.drive.effort_lag = Some(FirstOrderLag { time: size, effort: 0.0 });
    }
}
