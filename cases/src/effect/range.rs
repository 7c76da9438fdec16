//! A sensor that ends or is off in its gain: `force_saturation`, `force_gain`.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// Readings end at a limit; how sharply is the sensor's own.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    limit: f64,
    /// Share of the limit over which it rounds off, 0 for a sharp end.
    knee: f64,
}

impl Range {
    /// The reading of `force`.
    #[must_use]
    pub fn apply(&self, force: f64) -> f64 {
        let (from, over) = (self.limit * (1.0 - self.knee), force.abs() - self.limit * (1.0 - self.knee));
        if over <= 0.0 {
            return force;
        }
        let rest = self.limit - from;
        let rounded = if rest > 0.0 { rest * (1.0 - (-over / rest).exp()) } else { 0.0 };
        (from + rounded).copysign(force)
    }
}

/// `force_saturation`
#[derive(Debug)]
pub struct ForceSaturation {
    peak: f64,
    knee: f64,
}

impl ForceSaturation {
    /// Below the peak of the trials.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { peak: scene.force, knee: if chance.random_bool(0.6) { 0.0 } else { chance.random_range(0.01..0.05) } }
    }

    /// With a sharp end below the peak of the trials.
    #[must_use]
    pub fn sharp(scene: &Scene) -> Self {
        Self { peak: scene.force, knee: 0.0 }
    }

    fn limit(&self, size: f64) -> f64 {
        self.peak / (1.0 + size) / (1.0 - self.knee)
    }
}

impl Shape for ForceSaturation {
    fn form(&self) -> &'static str {
        if self.knee == 0.0 { "clipping" } else { "clipping with a rounded knee" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.2, 3.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("limit", self.limit(size), Unit::Force)]
    }
}

impl Acting for ForceSaturation {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.range = Some(Range { limit: self.limit(size), knee: self.knee });
    }
}

/// `force_gain`
#[derive(Debug)]
pub struct ForceGain {
    sign: f64,
}

impl ForceGain {
    /// Too much or too little.
    #[must_use]
    pub fn draw(chance: &mut Chance) -> Self {
        Self { sign: sign(chance) }
    }
}

impl Shape for ForceGain {
    fn form(&self) -> &'static str {
        "constant factor"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.02, 0.5)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("gain", 1.0 + self.sign * size, Unit::One)]
    }
}

impl Acting for ForceGain {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.gauge.gain_error = self.sign * size;
    }
}
