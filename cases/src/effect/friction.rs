//! Dry friction: `coulomb_friction`, `stribeck_friction`, `load_dependent_friction`. Set-valued: it holds what stands.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::friction::StribeckCurve;
use crate::rng::{CaseRng, log_uniform};
use crate::scale::Unit;

/// `coulomb_friction`
#[derive(Debug)]
pub struct CoulombFriction {
    asymmetry: f64,
    unit: f64,
}

impl CoulombFriction {
    /// Alike in both directions half of the time.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let asymmetry = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-0.4..0.4) };
        Self { asymmetry, unit: 0.02 * motion.effort }
    }

    /// Alike in both directions.
    #[must_use]
    pub fn even(motion: &NominalMotion) -> Self {
        Self { asymmetry: 0.0, unit: 0.02 * motion.effort }
    }

    fn levels(&self, size: f64) -> (f64, f64) {
        let level = size * self.unit;
        (level * (1.0 + self.asymmetry), level * (1.0 - self.asymmetry))
    }
}

impl EffectShape for CoulombFriction {
    fn form(&self) -> &'static str {
        if self.asymmetry == 0.0 { "set-valued" } else { "set-valued, asymmetric" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 25.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let (forward, backward) = self.levels(size);
        vec![
            EffectParameter::new("coulomb", 0.5 * (forward + backward), Unit::Force),
            EffectParameter::new("coulomb_forward", forward, Unit::Force),
            EffectParameter::new("coulomb_backward", backward, Unit::Force),
        ]
    }
}

impl SimulatedEffect for CoulombFriction {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.drive.friction.coulomb = self.levels(size);
    }
}

/// `stribeck_friction`
#[derive(Debug)]
pub struct StribeckFriction {
    ratio: f64,
    speed: f64,
    exponent: i32,
    unit: f64,
}

impl StribeckFriction {
    /// At rest two to four times as much as at speed.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let speed = motion.speed * log_uniform(rng, 0.05, 0.4);
        let exponent = if rng.random_bool(0.5) { 1 } else { 2 };
        Self { ratio: rng.random_range(0.25..0.5), speed, exponent, unit: 0.02 * motion.effort }
    }

    /// Falling off as an exponential of the speed.
    #[must_use]
    pub fn exponential(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { exponent: 1, ..Self::draw(motion, rng) }
    }
}

impl EffectShape for StribeckFriction {
    fn form(&self) -> &'static str {
        if self.exponent == 1 { "set-valued, exponential" } else { "set-valued, Gaussian" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let level = size * self.unit;
        vec![
            EffectParameter::new("static", level, Unit::Force),
            EffectParameter::new("coulomb", self.ratio * level, Unit::Force),
            EffectParameter::new("stribeck_velocity", self.speed, Unit::Velocity),
        ]
    }
}

impl SimulatedEffect for StribeckFriction {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let level = size * self.unit;
        let (kinetic, extra) = (self.ratio * level, (1.0 - self.ratio) * level);
        model.drive.friction.stribeck =
            Some(StribeckCurve { kinetic, extra, speed: self.speed, exponent: self.exponent });
    }
}

/// `load_dependent_friction`: `mu |F|`
#[derive(Debug)]
pub struct LoadDependentFriction;

impl EffectShape for LoadDependentFriction {
    fn form(&self) -> &'static str {
        "set-valued, in proportion to the contact force"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.05, 0.6)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("coefficient", size, Unit::One)]
    }
}

impl SimulatedEffect for LoadDependentFriction {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.drive.friction.load = size;
    }
}
