//! What the rate, the mean depth and the mean force of a sample take from the one before.

/// A sample as the next one needs it, in internal units.
#[derive(Debug, Clone, Copy, Default)]
pub struct PreviousSample {
    /// What the rate is the difference of: the depth below the surface, zero outside, where the filter is matched; else, or where the
    /// contact is bilateral, negative outside.
    pub position: f32,
    pub force: f32,
}
