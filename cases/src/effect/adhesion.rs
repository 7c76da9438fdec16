//! `adhesion`: a neck that stretches and snaps.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::adhesion::AdhesiveNeck;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `adhesion`
#[derive(Debug)]
pub struct Adhesion {
    length: f64,
    snap: f64,
    unit: f64,
}

impl Adhesion {
    /// With a neck that is short against the contact's depth.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let length = motion.depth * rng.random_range(0.05..0.4);
        Self { length, snap: rng.random_range(0.3..1.0), unit: 0.02 * motion.force }
    }
}

impl EffectShape for Adhesion {
    fn form(&self) -> &'static str {
        "a neck that flows and snaps"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("pull_off", size * self.unit, Unit::Force),
            EffectParameter::new("neck_length", self.length * self.snap, Unit::Length),
        ]
    }
}

impl SimulatedEffect for Adhesion {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (length, snap) = (self.length, self.snap);
        model.contact.neck = Some(AdhesiveNeck { pull: size * self.unit, length, snap, flow: 0.0, formed: false });
    }
}
