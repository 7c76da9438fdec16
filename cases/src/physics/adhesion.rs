//! An adhesive neck that forms on touch, yields and ruptures.

/// Forms on touch; bears the spring's pull up to its strength, then flows and weakens over its length until it snaps.
#[derive(Debug, Clone)]
pub struct AdhesiveNeck {
    pub(crate) pull: f64,
    pub(crate) length: f64,
    pub(crate) snap: f64,
    /// Depth at which the spring pulls with the full strength, below which the neck flows.
    pub(crate) flow: f64,
    pub(crate) formed: bool,
}

impl AdhesiveNeck {
    /// Forms or snaps, the tool being at `depth` in a surface of `stiffness`.
    pub fn advance(&mut self, depth: f64, stiffness: f64) {
        self.flow = -self.pull / stiffness;
        let stretched = (self.flow - depth).max(0.0) / self.length;
        self.formed = depth > 0.0 || (self.formed && stretched < self.snap);
    }

    /// The strongest pull it bears, as a force, at `depth`; zero where there is no neck.
    #[must_use]
    pub fn least(&self, depth: f64) -> f64 {
        if self.formed { -self.pull * (1.0 - (self.flow - depth).max(0.0) / self.length) } else { 0.0 }
    }
}
