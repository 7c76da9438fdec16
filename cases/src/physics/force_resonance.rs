//! Resonance of the force sensor.

/// A share of the force is read through a resonance: `y'' + 2 z w y' + w^2 (y - F) = 0`.
#[derive(Debug, Clone, Copy)]
pub struct SensorResonance {
    pub(crate) share: f64,
    pub(crate) rate: f64,
    pub(crate) ratio: f64,
    pub(crate) y: f64,
    pub(crate) slope: f64,
}

impl SensorResonance {
    /// The reading of `force` a step `dt` later.
    pub fn advance(&mut self, force: f64, dt: f64) -> f64 {
        let pull = self.rate * (self.rate * (force - self.y) - 2.0 * self.ratio * self.slope);
        self.slope += dt * pull;
        self.y += dt * self.slope;
        force + self.share * (self.y - force)
    }
}
