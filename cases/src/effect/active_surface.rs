//! Outside of the list: surfaces that live.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::active_surface::{PulseForce, ReflexForce};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// A pulse that is no sine.
#[derive(Debug)]
pub struct Heartbeat {
    period: f64,
    starts: [f64; 2],
    unit: f64,
}

impl Heartbeat {
    /// As hearts beat.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let period = rng.random_range(0.6..1.2);
        let starts = [rng.random_range(0.0..period), rng.random_range(0.0..period)];
        Self { period, starts, unit: 0.01 * motion.force }
    }
}

impl EffectShape for Heartbeat {
    fn form(&self) -> &'static str {
        "a beat and its echo, in contact"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let height = EffectParameter::new("height", size * self.unit, Unit::Force);
        vec![height, EffectParameter::new("period", self.period, Unit::Time)]
    }
}

impl SimulatedEffect for Heartbeat {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (height, start) = (size * self.unit, self.starts[model.trial % 2]);
        model.contact.pulse = Some(PulseForce { height, period: self.period, start });
    }
}

/// A surface that answers a touch.
#[derive(Debug)]
pub struct Reflex {
    wait: f64,
    rise: f64,
    unit: f64,
}

impl Reflex {
    /// As fast as nerves are.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let (wait, rise) = (rng.random_range(0.05..0.15), rng.random_range(0.1..0.4));
        Self { wait, rise, unit: 0.02 * motion.force }
    }
}

impl EffectShape for Reflex {
    fn form(&self) -> &'static str {
        "a push back some time after each touch"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("height", size * self.unit, Unit::Force),
            EffectParameter::new("wait", self.wait, Unit::Time),
            EffectParameter::new("rise", self.rise, Unit::Time),
        ]
    }
}

impl SimulatedEffect for Reflex {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let height = size * self.unit;
        model.contact.reflex = Some(ReflexForce { height, wait: self.wait, rise: self.rise, touched: 0.0 });
    }
}
