//! Outside of the list: a person pushes the tool.

use rand::{RngExt, SeedableRng};

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::external_push::PushForce;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// A burst of pushes in every trial, at another time in each.
#[derive(Debug)]
pub struct ExternalPush {
    seed: u64,
    duration: f64,
    unit: f64,
}

impl ExternalPush {
    /// At random.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { seed: rng.random(), duration: motion.duration, unit: 0.05 * motion.effort }
    }
}

impl EffectShape for ExternalPush {
    fn form(&self) -> &'static str {
        "bursts of pushes on the tool"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 20.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("height", size * self.unit, Unit::Force)]
    }
}

impl SimulatedEffect for ExternalPush {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let mut rng = CaseRng::seed_from_u64(self.seed.wrapping_add(model.trial as u64));
        let start = self.duration * rng.random_range(0.1..0.6);
        let height = size * self.unit;
        let all = (0..8)
            .map(|_| {
                let at = start + rng.random_range(0.0..0.3) * self.duration;
                (at, rng.random_range(0.05..0.3), height * rng.random_range(-1.0..1.0))
            })
            .collect();
        model.drive.pushes = Some(PushForce { all });
    }
}
