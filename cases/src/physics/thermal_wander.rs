//! A random walk of the force sensor's zero.

/// Time between two points of the random walk, s.
pub(crate) const SPACING_S: f64 = 0.05;

/// A walk between points.
#[derive(Debug, Clone)]
pub struct ZeroWander {
    pub(crate) points: Vec<f64>,
}

impl ZeroWander {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let place = (t / SPACING_S).max(0.0);
        let at = (place as usize).min(self.points.len() - 2);
        self.points[at] + (place - at as f64).min(1.0) * (self.points[at + 1] - self.points[at])
    }
}
