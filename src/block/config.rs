//! Settings that all block laws share.

use crate::error::{ConfigError, require, require_not_negative};
use crate::prior::Prior;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of every block law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct BlockConfig {
    /// Samples that an estimate rests on, at least 2, at most the capacity of the ring.
    pub window: u16,
    /// Samples below which the estimate is held, at least 2, at most `window`.
    pub minimum_fill: u16,
    /// Independence of penetration and rate (determinant over the product of the diagonal) at and below which B is
    /// held, 1e-6 to 0.1. In single precision the solution loses its last digit at about 1e-6.
    pub independence_floor: f32,
    /// Rms rate over the window at and below which B is held, internal units, zero or above. A filter lets the rate of a
    /// held tool die away by decades a second without ever reaching zero; B would be rounding divided by next to nothing.
    pub rate_floor: f32,
    /// A prior in the least-squares sums, with which `minimum_fill` may be 2; none in the paper.
    pub prior: Option<Prior>,
}

impl Default for BlockConfig {
    /// 300 samples, at least 20 of them, 1e-4, and 1e-4 (0.1 mm/s on the bench, less than one count of its encoder in a window).
    fn default() -> Self {
        Self { window: 300, minimum_fill: 20, independence_floor: 1e-4, rate_floor: 1e-4, prior: None }
    }
}

impl BlockConfig {
    /// `window` samples, at least 20 of them (or all, where there are fewer).
    pub fn of(window: u16) -> Self {
        Self { window, minimum_fill: window.min(20), ..Self::default() }
    }

    pub(crate) fn check(self) -> Result<Self, ConfigError> {
        require(self.window >= 2, "window", "at least 2 samples")?;
        require(
            (2..=self.window).contains(&self.minimum_fill),
            "minimum_fill",
            "at least 2 samples and at most the window",
        )?;
        require((1e-6..=0.1).contains(&self.independence_floor), "independence_floor", "between 1e-6 and 0.1")?;
        require_not_negative(self.rate_floor, "rate_floor")?;
        self.prior.map(Prior::check).transpose()?;
        Ok(self)
    }
}
