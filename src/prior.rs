//! Gaussian prior of stiffness and damping.

use crate::contact::Impedance;
use crate::error::{ConfigError, require, require_positive};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Zero mean and a standard deviation for K and for B: a ridge term in block sums, the initial covariance of a recursion.
///
/// It takes the place of a minimum fill: while the samples say less than the prior the estimate stays small, and a few of
/// them outweigh it. On the bench it is worth 1e-8 m^2 of `sum x^2`, one sample 0.1 mm deep.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Prior {
    /// Standard deviation of the force that one sample is trusted for, internal units (N on the bench).
    pub noise: f32,
    /// Spread of K, internal units (N/m on the bench).
    pub stiffness: f32,
    /// Spread of B, internal units (N s/m on the bench).
    pub damping: f32,
}

impl Default for Prior {
    /// 0.1 N, 1000 N/m, 30 N s/m.
    fn default() -> Self {
        Self { noise: 0.1, stiffness: 1e3, damping: 30.0 }
    }
}

impl Prior {
    /// What it adds to `sum x^2` and `sum v^2`: `(noise / spread)^2`.
    pub fn ridge(&self) -> Impedance {
        let (k, b) = (self.noise / self.stiffness, self.noise / self.damping);
        Impedance { stiffness: k * k, damping: b * b }
    }

    /// Variances of K and B per unit of noise variance: `(spread / noise)^2`.
    pub fn variances(&self) -> Impedance {
        let (k, b) = (self.stiffness / self.noise, self.damping / self.noise);
        Impedance { stiffness: k * k, damping: b * b }
    }

    pub(crate) fn check(self) -> Result<Self, ConfigError> {
        require_positive(self.noise, "prior.noise")?;
        require_positive(self.stiffness, "prior.stiffness")?;
        require_positive(self.damping, "prior.damping")?;
        let largest = self.variances();
        let fits = |variance: f32| (1e-6..=1e12).contains(&variance);
        require(fits(largest.stiffness), "prior.stiffness", "1e-3 to 1e6 times prior.noise")?;
        require(fits(largest.damping), "prior.damping", "1e-3 to 1e6 times prior.noise")?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ridge_and_variances_are_inverse_squares() {
        let prior = Prior { noise: 0.5, stiffness: 4.0, damping: 2.0 };
        assert_eq!(prior.ridge(), Impedance { stiffness: 1.0 / 64.0, damping: 1.0 / 16.0 });
        assert_eq!(prior.variances(), Impedance { stiffness: 64.0, damping: 16.0 });
    }

    #[test]
    fn a_prior_is_checked_at_its_limits() {
        let d = Prior { noise: 1.0, stiffness: 8.0, damping: 2.0 };
        for (prior, accepted) in [
            (d, true),
            (Prior { noise: 0.0, ..d }, false),
            (Prior { stiffness: 0.0, ..d }, false),
            (Prior { damping: -2.0, ..d }, false),
            (Prior { stiffness: 0.9e6, ..d }, true),
            (Prior { stiffness: 1.1e6, ..d }, false),
            (Prior { stiffness: 0.9e-3, ..d }, false),
            (Prior { damping: 1.1e6, ..d }, false),
            (Prior { damping: 0.9e-3, ..d }, false),
            (Prior { damping: 1.1e-3, ..d }, true),
        ] {
            assert_eq!(prior.check().ok(), accepted.then_some(prior), "{prior:?}");
        }
    }
}
