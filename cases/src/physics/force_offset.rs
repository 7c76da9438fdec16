//! Offset of the force sensor: bias and drift.

/// What the sensor reads when nothing touches.
#[derive(Debug, Clone, Copy, Default)]
pub struct ForceOffset {
    pub(crate) bias: f64,
    /// Limit and time constant of an exponential drift; rate alone where the time is infinite.
    pub(crate) drift: f64,
    pub(crate) rate: f64,
    pub(crate) time: f64,
}

impl ForceOffset {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let warming = if self.time > 0.0 { -self.drift * (-t / self.time).exp_m1() } else { 0.0 };
        self.bias + self.rate * t + warming
    }
}
