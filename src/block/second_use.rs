//! Which samples of a window its second run holds, beside the first or in its place.

/// What the second run of [`ExactSums`](crate::block::exact_sums::ExactSums) is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SecondUse {
    /// Out of use.
    #[default]
    Unused,
    /// Being prepared: it holds so many of the newest samples, which the first run holds as well. Once these are all, it takes the place of
    /// the first at the next update.
    Prepared(u16),
    /// It holds so many of the oldest samples, which the first run does not hold.
    Older(u16),
}
