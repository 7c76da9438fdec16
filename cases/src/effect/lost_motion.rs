//! `lost_motion`: play between the position sensor and the surface.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::lost_motion::PlayOperator;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `lost_motion`
#[derive(Debug)]
pub struct LostMotion {
    spread: f64,
    unit: f64,
}

impl LostMotion {
    /// With one sharp gap, or three that a worn joint spreads.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let spread = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.1..0.4) };
        Self { spread, unit: 0.01 * motion.depth }
    }
}

impl EffectShape for LostMotion {
    fn form(&self) -> &'static str {
        if self.spread == 0.0 { "one gap" } else { "three gaps side by side" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("gap", size * self.unit, Unit::Length)]
    }
}

impl SimulatedEffect for LostMotion {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let half = 0.5 * size * self.unit;
        let halves = [half * (1.0 - self.spread), half, half * (1.0 + self.spread)];
        // The tool comes from outside: whatever it pushes lags by half a gap.
        model.contact.play = Some(PlayOperator { halves, behind: [f64::NEG_INFINITY; 3] });
    }
}
