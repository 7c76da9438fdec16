//! Block least squares (BLS) over a sliding window.

use core::marker::PhantomData;

use crate::block::config::BlockConfig;
use crate::block::exact_sums::ExactSums;
use crate::block::law::{BlockLaw, Criterion, CriterionStep, WindowView};
use crate::block::second_order::Moments;
use crate::block::window_sums::WindowSums;
use crate::contact::{Impedance, Observation};
use crate::error::ConfigError;
use crate::window::Recent;

/// `theta = (sum phi phi')^-1 sum phi F` over the window (eq. 5-6), by the closed 2x2 inverse.
///
/// The sums are taken about an earlier estimate and solved for its correction, which is the same solution with less
/// rounding. Where penetration and rate are in line, or the tool holds still, K alone is solved for and B is held.
///
/// An update costs the same at any window.
pub type BlockLeastSquares = BlockLaw<LeastSquares<ExactSums>>;

/// `sum (F - phi' theta)^2`, solved outright.
#[derive(Debug, Clone, Copy)]
pub struct LeastSquares<M>(PhantomData<M>);

impl<M: WindowSums> BlockLaw<LeastSquares<M>> {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastSquares(PhantomData) })
    }
}

impl<M: WindowSums> Criterion for LeastSquares<M> {
    type WindowSums = M;

    fn advance(&self, view: &WindowView<'_, M>) -> CriterionStep {
        let (sums, solution) = (view.local.moments.second(), &view.solution);
        CriterionStep {
            to: view.least_squares(),
            noise_variance: solution.residual_variance(sums, view.samples),
            flags: solution.flags,
        }
    }

    #[inline(always)]
    fn update_estimate(
        &self,
        config: &BlockConfig,
        memory: &mut M,
        recent: &Recent<'_>,
        estimate: Impedance,
    ) -> Impedance {
        match memory.push_and_solve(config, recent, estimate) {
            Some(solution) => solution,
            None => self.advance_unusual(config, memory, recent.runs(), estimate),
        }
    }
}

impl<M: WindowSums> LeastSquares<M> {
    /// [`Criterion::advance_estimate`] by the sums in internal units, where the window is young, with a prior, where B is held, and where
    /// one run is transferred to another.
    #[cold]
    #[inline(never)]
    fn advance_unusual(
        &self,
        config: &BlockConfig,
        memory: &M,
        (older, newer): (&[Observation], &[Observation]),
        estimate: Impedance,
    ) -> Impedance {
        let recent = &Recent::of_runs(older, newer);
        if recent.len() < usize::from(config.minimum_fill) {
            return estimate;
        }
        self.advance_estimate(config, memory, recent, estimate)
    }
}
