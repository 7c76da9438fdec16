//! A factor on the contact stiffness that changes over time.

/// How far the change has come.
#[derive(Debug, Clone, Copy)]
pub(crate) enum TimeCourse {
    Linear { duration: f64 },
    Exponential { time: f64 },
    Jump { at: f64, width: f64 },
}

/// A factor on the spring in time.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessFactor {
    pub(crate) course: TimeCourse,
    pub(crate) relative: f64,
}

impl StiffnessFactor {
    /// The factor at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let done = match self.course {
            TimeCourse::Linear { duration } => t / duration,
            TimeCourse::Exponential { time } => 1.0 - (-t / time).exp(),
            TimeCourse::Jump { at, width } => ((t - at) / width + 0.5).clamp(0.0, 1.0),
        };
        1.0 + self.relative * done
    }
}
