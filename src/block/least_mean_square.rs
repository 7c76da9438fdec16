//! Block least mean square (BLMS): one step of steepest descent a sample, with the closed-form step size.

use core::marker::PhantomData;

use crate::block::config::BlockConfig;
use crate::block::exact_sums::ExactSums;
use crate::block::law::{BlockLaw, Criterion, CriterionStep, WindowView};
use crate::block::second_order::Moments;
use crate::block::second_order::SecondOrderSums;
use crate::block::window_sums::WindowSums;
use crate::contact::Impedance;
use crate::error::ConfigError;
use crate::math::larger;
use crate::quality::Flags;

/// `theta += step u` along `u = -g/|g|`, `g = -sum phi e`, where the step minimises `sum (e - step phi'u)^2` over the
/// window: `step = sum p e / sum p^2` with `p = phi'u`.
///
/// Without the length of g, and in one pass, that is `theta += (d'd / d'Rd) d` with `d = sum phi e`, `R = sum phi phi'`.
///
/// An update costs the same at any window.
pub type BlockLeastMeanSquare = BlockLaw<LeastMeanSquare<ExactSums>>;

/// `sum (F - phi' theta)^2`, descended by one step a sample.
#[derive(Debug, Clone, Copy)]
pub struct LeastMeanSquare<M>(PhantomData<M>);

impl<M: WindowSums> BlockLaw<LeastMeanSquare<M>> {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastMeanSquare(PhantomData) })
    }
}

impl<M: WindowSums> Criterion for LeastMeanSquare<M> {
    type WindowSums = M;

    fn advance(&self, view: &WindowView<'_, M>) -> CriterionStep {
        let (sums, solution) = (view.local.moments.second(), &view.solution);
        let here = sums.shifted(view.estimate.moved(-1.0, view.local.centre));
        CriterionStep {
            to: view.estimate.moved(1.0, steepest_step(&here)),
            noise_variance: solution.residual_variance(sums, view.samples),
            // A descent moves both along its gradient, whatever least squares could have solved for.
            flags: solution.flags & Flags::HELD,
        }
    }
}

/// The step along the steepest descent of `sum (e - step)^2`; zero where the gradient is zero or no step is finite.
fn steepest_step(sums: &SecondOrderSums) -> Impedance {
    let Impedance { stiffness, damping } = sums.residual;
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
