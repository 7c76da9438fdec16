//! What one update of a law found.

use crate::contact::Impedance;
use crate::quality::confidence::Confidence;
use crate::quality::flags::Flags;

/// What one update found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The estimate after it.
    pub estimate: Impedance,
    /// Newest force minus what the estimate before the update predicted.
    pub innovation: f32,
    /// How sure the estimate is.
    pub confidence: Confidence,
    /// Share of the window or memory that is filled, 0 to 1.
    pub fill: f32,
    /// Independence of penetration and rate in the window or memory, 0 (one line) to 1 (at right angles).
    pub excitation: f32,
    /// What was out of the ordinary.
    pub flags: Flags,
}
