//! Block least squares (BLS) over a sliding window.

use crate::block::{BlockConfig, BlockState, Solution, Sums, Taken};
use crate::error::ConfigError;
use crate::law::{Law, Step};
use crate::window::Recent;

/// `theta = (sum phi phi')^-1 sum phi F` over the window (eq. 5-6), by the closed 2x2 inverse.
///
/// The sums are taken about the estimate before and solved for its correction, which is the same solution with less
/// rounding. Where penetration and rate are in line, or the tool holds still, K alone is solved for and
/// B is held.
#[derive(Debug, Clone, Copy)]
pub struct BlockLeastSquares {
    config: BlockConfig,
}

impl BlockLeastSquares {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()? })
    }
}

impl Law for BlockLeastSquares {
    type State = BlockState;

    fn start(&self) -> BlockState {
        BlockState::default()
    }

    fn forget(&self, _: &mut BlockState) {}

    fn window(&self) -> usize {
        usize::from(self.config.window)
    }

    fn update(&self, state: &mut BlockState, recent: Recent<'_>) -> Step {
        let recent = recent.last(self.window());
        if recent.len() < usize::from(self.config.minimum_fill) {
            return self.config.too_few(state, recent);
        }
        let sums = Sums::over(recent, state.estimate);
        let solution = Solution::of(&sums, &self.config);
        let innovation = recent.newest().unwrap_or_default().misfit(state.estimate);
        let taken = Taken {
            step: state.move_by(solution.correction),
            innovation,
            noise_variance: solution.residual_variance(&sums),
            flags: solution.flags,
        };
        self.config.step(state, &sums, &solution, taken)
    }
}
