//! Outside of the list: a drive that is not the same everywhere.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::position_dependent_friction::{PositionDamping, StickyPatches};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// Friction at a few places of the travel.
#[derive(Debug)]
pub struct StickySpots {
    places: Vec<f64>,
    width: f64,
    unit: f64,
}

impl StickySpots {
    /// Anywhere in the travel.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let (low, high) = motion.travel;
        let places = (0..rng.random_range(3..6)).map(|_| rng.random_range(low..high)).collect();
        Self { places, width: (high - low) * rng.random_range(0.01..0.03), unit: 0.05 * motion.effort }
    }
}

impl EffectShape for StickySpots {
    fn form(&self) -> &'static str {
        "dry friction at a few places"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 20.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let height = EffectParameter::new("friction", size * self.unit, Unit::Force);
        vec![height, EffectParameter::new("half_width", self.width, Unit::Length)]
    }
}

impl SimulatedEffect for StickySpots {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (places, height) = (self.places.clone(), size * self.unit);
        model.drive.friction.spots = Some(StickyPatches { places, width: self.width, height });
    }
}

/// Damping whose sign depends on the position.
#[derive(Debug)]
pub struct SignedDamping {
    length: f64,
    phase: f64,
    unit: f64,
}

impl SignedDamping {
    /// A few waves over the travel.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let length = (motion.travel.1 - motion.travel.0) / rng.random_range(2.0..5.0);
        Self { length, phase: rng.random_range(0.0..6.2), unit: motion.nominal.viscous }
    }
}

impl EffectShape for SignedDamping {
    fn form(&self) -> &'static str {
        "viscous friction that changes sign over the travel"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.5, 10.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let damping = EffectParameter::new("damping", size * self.unit, Unit::Damping);
        vec![damping, EffectParameter::new("period", self.length, Unit::Length)]
    }
}

impl SimulatedEffect for SignedDamping {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let wave = std::f64::consts::TAU / self.length;
        model.drive.position_damping = Some(PositionDamping { damping: size * self.unit, wave, phase: self.phase });
    }
}
