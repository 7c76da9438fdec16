//! Block least mean square (BLMS): one step of steepest descent a sample, with the closed-form step size.

use crate::block::{BlockConfig, BlockState, Solution, Sums, Taken};
use crate::contact::Impedance;
use crate::error::ConfigError;
use crate::estimate::Flags;
use crate::law::{Law, Step};
use crate::math::larger;
use crate::window::Recent;

/// `theta += step u` along `u = -g/|g|`, `g = -sum phi e`, where the step minimises `sum (e - step phi'u)^2` over the
/// window: `step = sum p e / sum p^2` with `p = phi'u`.
///
/// Without the length of g, and in one pass, that is `theta += (d'd / d'Rd) d` with `d = sum phi e`, `R = sum phi phi'`.
#[derive(Debug, Clone, Copy)]
pub struct BlockLeastMeanSquare {
    config: BlockConfig,
}

impl BlockLeastMeanSquare {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()? })
    }
}

/// The step along the steepest descent of `sum (e - step)^2`; zero where the gradient is zero or no step is finite.
fn steepest_step(sums: &Sums) -> Impedance {
    let Impedance { stiffness, damping } = sums.misfit;
    let largest = larger(stiffness.abs(), damping.abs());
    if largest <= 0.0 {
        return Impedance::ZERO;
    }
    let d = Impedance { stiffness: stiffness / largest, damping: damping / largest };
    let curvature = sums.regressors.quadratic(d);
    let length = (d.stiffness * stiffness + d.damping * damping) / curvature;
    let step = Impedance::ZERO.moved(length, d);
    if step.is_finite() { step } else { Impedance::ZERO }
}

impl Law for BlockLeastMeanSquare {
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
            step: state.move_by(steepest_step(&sums)),
            innovation,
            noise_variance: solution.residual_variance(&sums),
            flags: solution.flags & Flags::HELD,
        };
        self.config.step(state, &sums, &solution, taken)
    }
}
