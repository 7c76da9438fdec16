//! A sample in whole numbers.

/// A sample and its residual in fixed-point numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FixedPoint {
    pub(super) penetration: i32,
    pub(super) rate: i32,
    pub(super) residual: i32,
}

impl FixedPoint {
    /// Whether each is smaller in magnitude than `limit`, a power of two.
    #[inline(always)]
    pub(super) fn is_below(self, limit: i32) -> bool {
        // The magnitude, or one less.
        let magnitude = |value: i32| value ^ (value >> 31);
        (magnitude(self.penetration) | magnitude(self.rate) | magnitude(self.residual)) < limit
    }
}
