//! An error of the force reading that is periodic in position.

/// `A sin(2 pi x/l + phi)` in the reading.
#[derive(Debug, Clone, Copy)]
pub struct PositionRipple {
    pub(crate) amplitude: f64,
    pub(crate) wave: f64,
    pub(crate) phase: f64,
}

impl PositionRipple {
    /// N at `position`.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        self.amplitude * (self.wave * position + self.phase).sin()
    }
}
