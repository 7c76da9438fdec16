//! Weight, constant or by angle.

/// `G`, or `G sin(q + q0)` about an axis.
#[derive(Debug, Clone, Copy)]
pub struct GravityForce {
    pub(crate) weight: f64,
    /// Radians per metre of the bench, and q0.
    pub(crate) angle: Option<(f64, f64)>,
}

impl GravityForce {
    /// N against forward motion at `position`.
    #[must_use]
    pub fn force(&self, position: f64) -> f64 {
        self.angle.map_or(self.weight, |(slope, zero)| self.weight * (slope * position + zero).sin())
    }
}
