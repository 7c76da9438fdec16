//! `environment_mass`: mass that the tool moves along.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::environment_mass::EntrainedMass;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `environment_mass`
#[derive(Debug)]
pub struct EnvironmentMass {
    depth: f64,
    bilateral: bool,
    unit: f64,
}

impl EnvironmentMass {
    /// Engaged within a tenth of the contact's depth.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let depth = motion.depth * rng.random_range(0.04..0.12);
        Self { depth, bilateral: motion.nominal.bilateral, unit: 0.05 * motion.nominal.mass }
    }
}

impl EffectShape for EnvironmentMass {
    fn form(&self) -> &'static str {
        if self.bilateral { "mass clamped to the tool" } else { "mass that engages over a depth" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("mass", size * self.unit, Unit::Mass)]
    }
}

impl SimulatedEffect for EnvironmentMass {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let depth = (!self.bilateral).then_some(self.depth);
        model.contact.entrained_mass = Some(EntrainedMass { mass: size * self.unit, depth });
    }
}
