//! The interface between a block law and the sums that are kept of its window.

use crate::block::config::BlockConfig;
use crate::block::second_order::{Moments, SecondOrderSums};
use crate::contact::Impedance;
use crate::window::Recent;

/// The sums of a window, and the estimate that their residuals refer to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CentredMoments<M> {
    pub centre: Impedance,
    pub moments: M,
}

/// Sums of a window, updated sample by sample.
pub trait WindowSums: Copy + Default + core::fmt::Debug {
    /// The sums.
    type CentredMoments: Moments;

    /// Takes in the newest of `recent`, which is the law's own window; `estimate` is the estimate before it.
    fn push(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: Impedance);

    /// The window's sums, about `estimate` or a nearby estimate that is cheaper.
    fn centred_moments(&self, recent: &Recent<'_>, estimate: Impedance) -> CentredMoments<Self::CentredMoments>;

    /// As [`Self::push`]. The least-squares solution where nothing is out of the ordinary, the same to the bit as that of the sums; `None`
    /// where they have to be asked.
    #[inline(always)]
    fn push_and_solve(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: Impedance) -> Option<Impedance> {
        self.push(config, recent, estimate);
        None
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
