//! Sizes of the recordings.

/// Sizes of the recordings, in which ranges and starts are stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Standard deviation of the effort, N or N m.
    pub effort: f64,
    /// Greatest effort, N or N m.
    pub peak_effort: f64,
    /// Size of effort that is passed for [`MOST_LIMITED_TIME`](super::criteria::MOST_LIMITED_TIME), and no more than a limit of it that the rig file
    /// states, N or N m.
    pub usual_effort: f64,
    /// Greatest speed over some rows, m/s or rad/s.
    pub speed: f64,
    /// From the least to the greatest position, m or rad.
    pub travel: f64,
    /// Least position.
    pub lowest: f64,
    /// Median time between encoder rows, s.
    pub period_s: f64,
    /// Median time between recorded rows, s.
    pub recorded_period_s: f64,
    /// The latest effort that is a late recording and no physics, s.
    pub latest_effort_s: f64,
    /// Longest trial, s.
    pub duration_s: f64,
    /// Inertia of the rig file.
    pub inertia: f64,
    /// Factor by which a fitted inertia may differ from it; 1: not at all.
    pub inertia_factor: f64,
    /// Viscous friction of the rig file.
    pub viscous: f64,
    /// Encoder's step, m or rad.
    pub resolution: f64,
    /// Whether positions are angles.
    pub is_rotary: bool,
    /// Whether every trial holds the force of a contact.
    pub touches: bool,
}

impl Scales {
    /// Whether the inertia is that of the rig file, and not fitted.
    #[must_use]
    pub fn holds_inertia(&self) -> bool {
        self.inertia_factor <= 1.0
    }

    /// Density of the disturbance that a search starts from, N^2 s: a tenth of the effort, new in each row.
    #[must_use]
    pub fn starting_density(&self) -> f64 {
        1e-2 * self.effort.powi(2) * self.period_s
    }
}
