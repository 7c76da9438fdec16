//! `hysteresis`: a loop that no slowness closes.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::hysteresis::{HysteresisLoop, IWAN_ELEMENTS};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// `hysteresis`
#[derive(Debug)]
pub struct Hysteresis {
    bundle: bool,
    distance: f64,
    sharpness: f64,
    unit: f64,
}

impl Hysteresis {
    /// Of either form.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let distance = motion.depth * rng.random_range(0.02..0.1);
        let sharpness = rng.random_range(1.0..2.0);
        Self { bundle: rng.random_bool(0.5), distance, sharpness, unit: 0.02 * motion.force }
    }
}

impl EffectShape for Hysteresis {
    fn form(&self) -> &'static str {
        if self.bundle { "a bundle of springs that slip" } else { "Bouc-Wen" }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("amplitude", size * self.unit, Unit::Force),
            EffectParameter::new("yield_distance", self.distance, Unit::Length),
        ]
    }
}

impl SimulatedEffect for Hysteresis {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (height, distance, sharpness) = (size * self.unit, self.distance, self.sharpness);
        model.contact.hysteresis = Some(if self.bundle {
            // From a third of the distance to three times it.
            let reach = std::array::from_fn(|at| distance * 9f64.powf(at as f64 / (IWAN_ELEMENTS - 1) as f64 - 0.5));
            HysteresisLoop::Iwan {
                share: height / IWAN_ELEMENTS as f64,
                reach,
                stretch: [0.0; IWAN_ELEMENTS],
                last: 0.0,
            }
        } else {
            HysteresisLoop::BoucWen { height, distance, sharpness, state: 0.0, last: 0.0 }
        });
    }
}
