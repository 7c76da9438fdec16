//! Friction and damping that vary over the travel.

/// Narrow places with dry friction.
#[derive(Debug, Clone)]
pub struct StickyPatches {
    pub(crate) places: Vec<f64>,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl StickyPatches {
    /// Friction at `position`, N.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        if self.places.iter().any(|place| (position - place).abs() < self.width) { self.height } else { 0.0 }
    }
}

/// Damping `c sin(2 pi x / l)` that feeds energy back where it is negative.
#[derive(Debug, Clone, Copy)]
pub struct PositionDamping {
    pub(crate) damping: f64,
    pub(crate) wave: f64,
    pub(crate) phase: f64,
}

impl PositionDamping {
    /// N at `position` and `velocity`.
    #[must_use]
    pub fn force(&self, position: f64, velocity: f64) -> f64 {
        self.damping * (self.wave * position + self.phase).sin() * velocity
    }
}
