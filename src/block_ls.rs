//! Block least squares (BLS) over a sliding window.

use crate::block::{BlockConfig, BlockLaw, Criterion, Move, View};
use crate::error::ConfigError;

/// `theta = (sum phi phi')^-1 sum phi F` over the window (eq. 5-6), by the closed 2x2 inverse.
///
/// The sums are taken about the estimate before and solved for its correction, which is the same solution with less
/// rounding. Where penetration and rate are in line, or the tool holds still, K alone is solved for and B is held.
pub type BlockLeastSquares = BlockLaw<LeastSquares>;

/// `sum (F - phi' theta)^2`, solved outright.
#[derive(Debug, Clone, Copy)]
pub struct LeastSquares;

impl BlockLeastSquares {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastSquares })
    }
}

impl Criterion for LeastSquares {
    fn advance(&self, view: &View<'_>) -> Move {
        let (sums, solution) = (&view.sums, &view.solution);
        Move { step: solution.correction, noise_variance: solution.residual_variance(sums), flags: solution.flags }
    }
}
