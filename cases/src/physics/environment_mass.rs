//! Environment mass that the tool entrains.

/// Mass that engages over a depth, `m(p) = m (1 - exp(-p/d))`: by Lagrange `F = m(p) a + m'(p) v^2 / 2`, which keeps
/// the energy and needs no impulse at the first touch.
#[derive(Debug, Clone, Copy)]
pub struct EntrainedMass {
    pub(crate) mass: f64,
    /// None: clamped to the tool, all there at any depth and on either side.
    pub(crate) depth: Option<f64>,
}

impl EntrainedMass {
    /// Mass at depth `p`, and the force that moving in at `velocity` takes.
    #[must_use]
    pub fn at(&self, p: f64, velocity: f64) -> (f64, f64) {
        let Some(depth) = self.depth else { return (self.mass, 0.0) };
        if p <= 0.0 {
            return (0.0, 0.0);
        }
        let left = (-p / depth).exp();
        (self.mass * (1.0 - left), 0.5 * self.mass * left / depth * velocity * velocity)
    }
}
