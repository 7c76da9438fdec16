//! The indent that the deepest contact leaves.

/// Memory of the deepest point: beyond a yield depth a share of the way stays as a dent, and unloading is elastic.
#[derive(Debug, Clone)]
pub struct ResidualIndent {
    pub(crate) share: f64,
    pub(crate) yield_depth: f64,
    pub(crate) deepest: f64,
}

impl ResidualIndent {
    /// The dent, m, once the tool has been at `depth` below the surface as it was.
    pub fn left_by(&mut self, depth: f64) -> f64 {
        self.deepest = self.deepest.max(depth);
        self.share * (self.deepest - self.yield_depth).max(0.0)
    }
}
