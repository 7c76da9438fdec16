//! What a model leaves of a trial, channel by channel.

/// What the model leaves of one trial.
#[derive(Debug, Clone, Default)]
pub struct Residual {
    /// Measured minus predicted force.
    pub force: Vec<f64>,
    /// What is left of the drive's balance.
    pub effort: Vec<f64>,
}

/// Which channels are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channels {
    /// The force reading.
    pub force: bool,
    /// The drive's balance.
    pub effort: bool,
}

impl Channels {
    /// Both.
    pub const BOTH: Self = Self { force: true, effort: true };
}
