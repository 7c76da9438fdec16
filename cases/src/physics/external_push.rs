//! Pushes on the tool by a person.

/// Half sines of force on the tool.
#[derive(Debug, Clone)]
pub struct PushForce {
    /// Start and length, s, and height, N, of each.
    pub(crate) all: Vec<(f64, f64, f64)>,
}

impl PushForce {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let during = |&&(start, length, _): &&(f64, f64, f64)| t > start && t < start + length;
        self.all
            .iter()
            .filter(during)
            .map(|(start, length, height)| height * (std::f64::consts::PI * (t - start) / length).sin())
            .sum()
    }
}
