//! `gravity_load`: weight, constant along a line and by the angle about an axis.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::gravity::GravityForce;
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// `gravity_load`
#[derive(Debug)]
pub struct GravityLoad {
    angle: Option<(f64, f64)>,
    unit: f64,
}

impl GravityLoad {
    /// Up or down.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let angle = motion.scale.rotary.then(|| (motion.scale.length, rng.random_range(-1.2..1.2)));
        Self { angle, unit: 0.02 * motion.effort * sign(rng) }
    }

    /// The same wherever the tool is.
    #[must_use]
    pub fn constant(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { angle: None, unit: 0.02 * motion.effort * sign(rng) }
    }
}

impl EffectShape for GravityLoad {
    fn form(&self) -> &'static str {
        if self.angle.is_some() { "by angle" } else { "constant" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let weight = EffectParameter::new("load", size * self.unit, Unit::Force);
        let zero = self.angle.map(|(_, zero)| EffectParameter::new("angle_zero", zero, Unit::Angle));
        std::iter::once(weight).chain(zero).collect()
    }
}

impl SimulatedEffect for GravityLoad {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.drive.gravity = Some(GravityForce { weight: size * self.unit, angle: self.angle });
    }
}
