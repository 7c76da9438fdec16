//! Damping that is not constant: `hunt_crossley_damping`, `quadratic_damping`.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::damping::{DepthDamping, SpeedDamping};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `hunt_crossley_damping`
#[derive(Debug)]
pub struct HuntCrossleyDamping {
    /// Where alpha holds, m.
    depth: f64,
    exponent: f64,
    unit: f64,
}

impl HuntCrossleyDamping {
    /// With an exponent between the textbook's 1 and Hertz's 1.5.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let depth = 0.6 * motion.depth;
        let exponent = if rng.random_bool(0.5) { 1.0 } else { rng.random_range(1.0..1.5) };
        Self { depth, exponent, unit: motion.nominal.damping / depth }
    }
}

impl EffectShape for HuntCrossleyDamping {
    fn form(&self) -> &'static str {
        if self.exponent == 1.0 { "damping in proportion to depth" } else { "damping as a power of depth" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.3, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("alpha", size * self.unit, Unit::DampingGradient),
            EffectParameter::new("exponent", self.exponent, Unit::One),
        ]
    }
}

impl SimulatedEffect for HuntCrossleyDamping {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (depth, exponent) = (self.depth, self.exponent);
        model.contact.depth_damping = Some(DepthDamping { alpha: size * self.unit, depth, exponent });
    }
}

/// `quadratic_damping`
#[derive(Debug)]
pub struct QuadraticDamping {
    speed: f64,
    exponent: f64,
    unit: f64,
}

impl QuadraticDamping {
    /// With an exponent about two.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let exponent = if rng.random_bool(0.5) { 2.0 } else { rng.random_range(1.8..2.2) };
        Self { speed: motion.speed, exponent, unit: motion.nominal.damping / motion.speed }
    }
}

impl EffectShape for QuadraticDamping {
    fn form(&self) -> &'static str {
        if self.exponent == 2.0 { "v |v|" } else { "a power of speed near two" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.3, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("coefficient", size * self.unit, Unit::Drag),
            EffectParameter::new("exponent", self.exponent, Unit::One),
        ]
    }
}

impl SimulatedEffect for QuadraticDamping {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (speed, exponent) = (self.speed, self.exponent);
        model.contact.speed_damping = Some(SpeedDamping { coefficient: size * self.unit, speed, exponent });
    }
}
