//! What a block law remembers of its window beside the samples themselves.

use crate::block::config::BlockConfig;
use crate::block::second_order::{Moments, Sums};
use crate::contact::Impedance;
use crate::window::Recent;

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
