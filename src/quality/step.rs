//! The outcome of one update of a law.

use crate::contact::Impedance;
use crate::quality::confidence::Confidence;
use crate::quality::flags::Flags;

/// The outcome of one update of a law, in internal units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The estimate after it.
    pub estimate: Impedance,
    /// Newest force minus what the estimate before the update predicted.
    pub innovation: f32,
    /// The parts of its uncertainty.
    pub confidence: Confidence,
    /// Share of the window or memory that is filled, 0 to 1.
    pub fill: f32,
    /// Independence of penetration and rate in the window or memory, 0 (one line) to 1 (at right angles).
    pub excitation: f32,
    /// Conditions that limit its validity.
    pub flags: Flags,
}
