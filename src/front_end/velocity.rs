//! How the rate of penetration is computed.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// How the rate of penetration is computed from the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Velocity {
    /// As the paper: the difference of the position, low-passed; position and force are not filtered. The filter delays the
    /// rate against the force, which biases B: measured on K = 300 N/m with a cut-off of 20 Hz, by -5 % at a motion of
    /// 5 Hz, -26 % at 10 Hz, -60 % at 15 Hz.
    Paper,
    /// Penetration, rate and force pass the same filter, so the filter cancels from `F = K x + B v`. Penetration and
    /// force enter as the mean of two samples, for the difference belongs to the instant half-way between them.
    #[default]
    Matched,
}
