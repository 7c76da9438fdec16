//! A mains tone with one harmonic in the force reading.

/// A sine and one of its harmonics.
#[derive(Debug, Clone, Copy)]
pub struct MainsTone {
    pub(crate) amplitude: f64,
    pub(crate) rate: f64,
    pub(crate) phase: f64,
    pub(crate) order: f64,
    pub(crate) share: f64,
}

impl MainsTone {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let angle = self.rate * t + self.phase;
        self.amplitude * (angle.sin() + self.share * (self.order * angle + 1.0).sin())
    }
}
