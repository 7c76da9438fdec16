//! Outside of the list: a loose contact in the sensor's cable.

use rand::{RngExt, SeedableRng};

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::loose_contact::Glitches;
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// Jumps at random.
#[derive(Debug)]
pub struct LooseContact {
    seed: u64,
    duration: f64,
    unit: f64,
}

impl LooseContact {
    /// Some in every trial.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { seed: rng.random(), duration: motion.duration, unit: 0.1 * motion.force }
    }
}

impl EffectShape for LooseContact {
    fn form(&self) -> &'static str {
        "short jumps of the reading"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 10.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("height", size * self.unit, Unit::Force)]
    }
}

impl SimulatedEffect for LooseContact {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let mut rng = CaseRng::seed_from_u64(self.seed.wrapping_add(model.trial as u64));
        let all = (0..15)
            .map(|_| {
                let start = rng.random_range(0.0..self.duration);
                let end = start + rng.random_range(0.005..0.06);
                (start, end, size * self.unit * sign(&mut rng) * rng.random_range(0.3..1.0))
            })
            .collect();
        model.sensor.glitches = Some(Glitches { all });
    }
}
