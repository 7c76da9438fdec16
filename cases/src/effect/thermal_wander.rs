//! Outside of the list: a zero that walks at random, as with the temperature.

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::thermal_wander::{SPACING_S, ZeroWander};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// Low-passed random walk of the force.
#[derive(Debug)]
pub struct ThermalWander {
    seed: u64,
    time: f64,
    duration: f64,
    unit: f64,
}

impl ThermalWander {
    /// Slow against the motion.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let time = rng.random_range(0.5..2.0);
        Self { seed: rng.random(), time, duration: motion.duration, unit: 0.01 * motion.force }
    }
}

impl EffectShape for ThermalWander {
    fn form(&self) -> &'static str {
        "a low-passed random walk of the force"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let step = EffectParameter::new("step_per_root_second", size * self.unit, Unit::Force);
        vec![step, EffectParameter::new("smoothing", self.time, Unit::Time)]
    }
}

impl SimulatedEffect for ThermalWander {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let mut rng = CaseRng::seed_from_u64(self.seed.wrapping_add(model.trial as u64));
        let (mut walk, mut smooth) = (0.0, 0.0);
        let points = (0..(self.duration / SPACING_S) as usize + 4)
            .map(|_| {
                let step: f64 = StandardNormal.sample(&mut rng);
                walk += step * SPACING_S.sqrt() - walk * SPACING_S / 10.0;
                smooth += (walk - smooth) * SPACING_S / self.time;
                smooth * size * self.unit
            })
            .collect();
        model.sensor.zero_wander = Some(ZeroWander { points });
    }
}
