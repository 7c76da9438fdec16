//! Limits of the motor: saturation of the effort, and a first-order lag.

/// No effort beyond a limit.
#[derive(Debug, Clone, Copy)]
pub struct EffortLimit {
    pub(crate) limit: f64,
}

impl EffortLimit {
    /// What acts of `effort`, N.
    #[must_use]
    pub fn apply(&self, effort: f64) -> f64 {
        effort.clamp(-self.limit, self.limit)
    }
}

/// First order: `tau u' = command - u`.
#[derive(Debug, Clone, Copy)]
pub struct FirstOrderLag {
    pub(crate) time: f64,
    pub(crate) effort: f64,
}

impl FirstOrderLag {
    /// The mean effort over the next step of `dt`, exact for a command that is held.
    pub fn advance(&mut self, command: f64, dt: f64) -> f64 {
        let gone = -(-dt / self.time).exp_m1();
        let before = self.effort - command;
        self.effort -= before * gone;
        command + before * gone * self.time / dt
    }
}
