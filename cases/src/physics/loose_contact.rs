//! Short jumps of the force reading, as of a loose cable.

/// Short jumps of the reading.
#[derive(Debug, Clone)]
pub struct Glitches {
    /// Start and end, s, and height, N, of each.
    pub(crate) all: Vec<(f64, f64, f64)>,
}

impl Glitches {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        self.all.iter().filter(|(start, end, _)| t >= *start && t < *end).map(|(_, _, height)| height).sum()
    }
}
