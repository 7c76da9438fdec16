//! `plastic_set`: what the deepest contact leaves behind.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::plastic_set::ResidualIndent;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `plastic_set`
#[derive(Debug)]
pub struct PlasticSet {
    yield_depth: f64,
    depth: f64,
}

impl PlasticSet {
    /// With or without a depth that is borne elastically.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let share = if rng.random_bool(0.4) { 0.0 } else { rng.random_range(0.1..0.5) };
        Self { yield_depth: share * motion.depth, depth: motion.depth }
    }

    fn share(size: f64) -> f64 {
        0.05 * size
    }
}

impl EffectShape for PlasticSet {
    fn form(&self) -> &'static str {
        "memory of the deepest point, elastic unloading"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 15.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let share = Self::share(size);
        vec![
            EffectParameter::new("set_ratio", share, Unit::One),
            EffectParameter::new("yield_depth", self.yield_depth, Unit::Length),
            EffectParameter::new("set_at_full_depth", share * (self.depth - self.yield_depth), Unit::Length),
        ]
    }
}

impl SimulatedEffect for PlasticSet {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (share, yield_depth) = (Self::share(size), self.yield_depth);
        model.contact.indent = Some(ResidualIndent { share, yield_depth, deepest: f64::NEG_INFINITY });
    }
}
