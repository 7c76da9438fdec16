//! A motor force periodic in position.

/// `A (sin(2 pi x/l + phi) + r sin(4 pi x/l))`
#[derive(Debug, Clone, Copy)]
pub struct CoggingForce {
    pub(crate) amplitude: f64,
    pub(crate) wave: f64,
    pub(crate) phase: f64,
    pub(crate) second: f64,
}

impl CoggingForce {
    /// N against forward motion at `position`.
    #[must_use]
    pub fn force(&self, position: f64) -> f64 {
        let angle = self.wave * position;
        self.amplitude * ((angle + self.phase).sin() + self.second * (2.0 * angle).sin())
    }
}
