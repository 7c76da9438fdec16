//! What a block law remembers of its window beside the samples themselves.

use crate::block::BlockConfig;
use crate::contact::{Impedance, Observation};
use crate::sums::Sums;
use crate::window::Recent;

/// Sums over samples that can be added, taken off, and seen from another estimate.
pub trait Moments: Copy + Default + core::fmt::Debug {
    /// Of one sample with misfit `e`.
    fn of(o: &Observation, e: f32) -> Self;
    /// The samples of both, which are summed about the same estimate.
    #[must_use]
    fn with(&self, other: &Self) -> Self;
    /// Adds `sign` times `terms` by Kahan's summation: `lost` is what rounding has kept out so far.
    fn gather(&mut self, lost: &mut Self, terms: &Self, sign: f32);
    /// The same samples about an estimate that is `shift` further.
    #[must_use]
    fn shifted(&self, shift: Impedance) -> Self;
    /// The sums of second order.
    fn second(&self) -> &Sums;
}

/// The sums of a window, and what they were taken about.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Local<M> {
    pub centre: Impedance,
    pub moments: M,
}

/// What is remembered from one update to the next.
pub trait Memory: Copy + Default + core::fmt::Debug {
    /// The sums that it tells of.
    type Local: Moments;

    /// Takes in the newest of `recent`, which is the law's own window; `estimate` is the estimate before it.
    fn follow(&mut self, config: &BlockConfig, recent: Recent<'_>, estimate: Impedance);

    /// The window's sums, about `estimate` or whatever near it comes cheaper.
    fn local(&self, recent: Recent<'_>, estimate: Impedance) -> Local<Self::Local>;
}

/// Nothing is remembered: the window is summed anew at every update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Anew;

impl Memory for Anew {
    type Local = Sums;

    fn follow(&mut self, _: &BlockConfig, _: Recent<'_>, _: Impedance) {}

    fn local(&self, recent: Recent<'_>, estimate: Impedance) -> Local<Sums> {
        Local { centre: estimate, moments: Sums::over(recent, estimate) }
    }
}

/// One term of Kahan's summation.
#[inline(always)]
pub fn gather(sum: &mut f32, lost: &mut f32, term: f32) {
    let term = term - *lost;
    let next = *sum + term;
    *lost = (next - *sum) - term;
    *sum = next;
}
