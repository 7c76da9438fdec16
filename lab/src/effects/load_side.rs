//! The tool's side of a transmission, as a recording shows it.

/// What is seen of the tool over a whole trial: what its side of a transmission bears follows from it, without a motor.
#[derive(Debug, Clone, Copy)]
pub struct LoadSideSignals<'a> {
    /// Seconds between rows.
    pub step: f64,
    /// Width of the smoothing filter, s.
    pub filter_width: f64,
    /// Inertia of motor and tool.
    pub inertia: f64,
    /// Viscous friction of the tool's side.
    pub viscous: f64,
    /// Tool velocity.
    pub velocity: &'a [f64],
    /// Its rate.
    pub acceleration: &'a [f64],
    /// What reaches the transmission of the commanded effort.
    pub effort: &'a [f64],
    /// Contact force on the tool, positive when the tool pushes.
    pub force: &'a [f64],
    /// What of velocity, acceleration and force is noise.
    pub noise: [f64; 3],
}

impl LoadSideSignals<'_> {
    /// What the transmission gives a tool of inertia `tool` at row `at`.
    #[must_use]
    pub fn borne(&self, tool: f64, at: usize) -> f64 {
        tool * self.acceleration[at] + self.viscous * self.velocity[at] + self.force[at]
    }

    /// What a drive without play or softness leaves of the balance at row `at`.
    #[must_use]
    pub fn balance_residual(&self, at: usize) -> f64 {
        self.effort[at] - self.inertia * self.acceleration[at] - self.viscous * self.velocity[at] - self.force[at]
    }
}
