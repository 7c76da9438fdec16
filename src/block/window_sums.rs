//! The interface between a block law and the sums that are kept of its window.

use crate::block::config::BlockConfig;
use crate::block::second_order::{Moments, SecondOrderSums};
use crate::block::solution::Solution;
use crate::contact::{Impedance, Observation};
use crate::window::Recent;

/// The sums of a window, and the estimate that their residuals refer to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CentredMoments<M> {
    pub centre: Impedance,
    pub moments: M,
}

impl<M: Moments> CentredMoments<M> {
    /// The least-squares solution of so many `samples`, from the centre. Where something is held, the sums are shifted to `estimate` first:
    /// it is held there.
    #[inline(always)]
    pub fn solution(&mut self, samples: f32, config: &BlockConfig, estimate: Impedance) -> Solution {
        let solution = Solution::of(self.moments.second(), samples, config, self.centre);
        if solution.flags.is_empty() || self.centre == estimate {
            return solution;
        }
        self.moments = self.moments.shifted(estimate.moved(-1.0, self.centre));
        self.centre = estimate;
        Solution::of(self.moments.second(), samples, config, estimate)
    }
}

/// Sums of a window, updated sample by sample.
pub trait WindowSums: Copy + Default + core::fmt::Debug {
    /// The sums.
    type CentredMoments: Moments;

    /// Takes in the newest of `recent`, which is the law's own window; `estimate` is the estimate before it.
    fn push(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: Impedance);

    /// The window's sums, about `estimate` or a nearby estimate that is cheaper.
    fn centred_moments(&self, recent: &Recent<'_>, estimate: Impedance) -> CentredMoments<Self::CentredMoments>;

    /// The usual [`Self::push`]; else nothing is done, and `false` is told.
    #[inline(always)]
    fn push_usual(&mut self, _config: &BlockConfig, _recent: &Recent<'_>, _estimate: &Impedance) -> bool {
        false
    }

    /// An update that [`Self::push_usual`] left undone. The two runs of the window are handed over in registers: a `Recent` would be stored
    /// for it at each update.
    fn push_unusual(
        &mut self,
        config: &BlockConfig,
        (older, newer): (&[Observation], &[Observation]),
        estimate: Impedance,
    ) {
        self.push(config, &Recent::of_runs(older, newer), estimate);
    }

    /// The least-squares solution of the window where nothing is out of the ordinary, the same to the bit as that of its sums; `None` where
    /// they have to be asked.
    #[inline(always)]
    fn least_squares(&self) -> Option<Impedance> {
        None
    }

    /// The window's sums after [`Self::push_usual`], and how many samples they are of.
    fn usual_moments(&self) -> (CentredMoments<Self::CentredMoments>, u16) {
        Default::default()
    }
}

/// Keeps nothing: the window is summed at every update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DirectSums;

impl WindowSums for DirectSums {
    type CentredMoments = SecondOrderSums;

    fn push(&mut self, _: &BlockConfig, _: &Recent<'_>, _: Impedance) {}

    fn centred_moments(&self, recent: &Recent<'_>, estimate: Impedance) -> CentredMoments<SecondOrderSums> {
        CentredMoments { centre: estimate, moments: SecondOrderSums::over(recent, estimate) }
    }
}
