//! A sensor that is late: `channel_delay`, `force_lag`, and the mass beyond it, `tool_inertia`.

use super::{EffectParameter, EffectShape, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::delay::DelayLine;
use crate::scale::Unit;

/// `channel_delay`
#[derive(Debug)]
pub struct ChannelDelay;

impl EffectShape for ChannelDelay {
    fn form(&self) -> &'static str {
        "pure delay of the force"
    }

    fn size_range(&self) -> SizeRange {
        // A quarter of a sample is what the clock leaves open.
        SizeRange { smallest: 2.5e-4, initial: 5e-4, largest: 0.01 }
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("delay", size, Unit::Time)]
    }
}

impl SimulatedEffect for ChannelDelay {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.delay = Some(DelayLine::new(size, model.step_s));
    }
}

/// `force_lag`: first order
#[derive(Debug)]
pub struct ForceLag;

impl EffectShape for ForceLag {
    fn form(&self) -> &'static str {
        "first order"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange { smallest: 2.5e-4, initial: 5e-4, largest: 0.03 }
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("time_constant", size, Unit::Time)]
    }
}

impl SimulatedEffect for ForceLag {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.lag_time_constant_s = size;
    }
}

/// `tool_inertia`: the reading holds `m a` besides
#[derive(Debug)]
pub struct ToolInertia {
    /// The moving mass, kg.
    pub mass: f64,
}

impl EffectShape for ToolInertia {
    fn form(&self) -> &'static str {
        "mass beyond the force sensor"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.03, 0.7)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("mass", size * self.mass, Unit::Mass)]
    }
}

impl SimulatedEffect for ToolInertia {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.sensor.inertia = size * self.mass;
    }
}
