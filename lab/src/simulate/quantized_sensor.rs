//! A sensor: noise first, then the rounding of its steps.

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// A channel's sensor.
#[derive(Debug, Clone, Copy)]
pub struct QuantizedSensor {
    /// Step; 0: continuous.
    pub resolution: f64,
    /// Standard deviation before rounding.
    pub noise: f64,
    /// Reading when there is nothing to measure.
    pub zero: f64,
}

impl QuantizedSensor {
    /// What the sensor shows for `truth`.
    pub fn read(&self, truth: f64, rng: &mut impl Rng) -> f64 {
        let noise: f64 = if self.noise > 0.0 { StandardNormal.sample(rng) } else { 0.0 };
        rounded(truth + self.zero + self.noise * noise, self.resolution)
    }
}

/// `value` to whole steps.
fn rounded(value: f64, step: f64) -> f64 {
    if step == 0.0 {
        return value;
    }
    // A count of minus zero is a count of zero, and is to be written so.
    let counts = (value / step).round() + 0.0;
    // 3 * 0.1 is 0.30000000000000004, 3 / 10 is 0.3: a decimal step keeps a short text, and one text a count.
    let per_unit = step.recip().round();
    if (per_unit * step - 1.0).abs() < 4.0 * f64::EPSILON { counts / per_unit } else { counts * step }
}
