//! Saturation of the force sensor.

/// Readings end at a limit; how sharply is the sensor's own.
#[derive(Debug, Clone, Copy)]
pub struct ForceRange {
    pub(crate) limit: f64,
    /// Share of the limit over which it rounds off, 0 for a sharp end.
    pub(crate) knee: f64,
}

impl ForceRange {
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
