//! What a block law remembers of its window beside the samples themselves.

use crate::block::config::BlockConfig;
use crate::block::second_order::{Moments, SecondOrderSums};
use crate::contact::Impedance;
use crate::window::Recent;

/// The sums of a window, and what they were taken about.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CentredMoments<M> {
    pub centre: Impedance,
    pub moments: M,
}

/// What is remembered from one update to the next.
pub trait WindowSums: Copy + Default + core::fmt::Debug {
    /// The sums that it tells of.
    type CentredMoments: Moments;

    /// Takes in the newest of `recent`, which is the law's own window; `estimate` is the estimate before it.
    fn push(&mut self, config: &BlockConfig, recent: Recent<'_>, estimate: Impedance);

    /// The window's sums, about `estimate` or whatever near it comes cheaper.
    fn centred_moments(&self, recent: Recent<'_>, estimate: Impedance) -> CentredMoments<Self::CentredMoments>;
}

/// Nothing is remembered: the window is summed anew at every update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DirectSums;

impl WindowSums for DirectSums {
    type CentredMoments = SecondOrderSums;

    fn push(&mut self, _: &BlockConfig, _: Recent<'_>, _: Impedance) {}

    fn centred_moments(&self, recent: Recent<'_>, estimate: Impedance) -> CentredMoments<SecondOrderSums> {
        CentredMoments { centre: estimate, moments: SecondOrderSums::over(recent, estimate) }
    }
}
