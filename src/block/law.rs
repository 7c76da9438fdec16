//! What the block laws share: state, and the outcome of an update.

use crate::block::config::BlockConfig;
use crate::block::second_order::Moments;
use crate::block::solution::Solution;
use crate::block::window_sums::{CentredMoments, WindowSums};
use crate::contact::Impedance;
use crate::quality::Confidence;
use crate::quality::Flags;
use crate::quality::Step;
use crate::update_law::UpdateLaw;
use crate::window::Recent;

/// State of a block law: the estimate, and the sums of the window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BlockState<M> {
    /// K and B, internal units.
    pub estimate: Impedance,
    pub(crate) memory: M,
}

/// The step of a criterion.
#[derive(Debug, Clone, Copy)]
pub struct CriterionStep {
    /// Where the estimate is to go.
    pub to: Impedance,
    /// Variance per sample of the law's own criterion.
    pub noise_variance: f32,
    /// What was out of the ordinary.
    pub flags: Flags,
}

/// The window with its sums, as a criterion needs them.
#[derive(Debug, Clone, Copy)]
pub struct WindowView<'a, M: WindowSums> {
    pub config: &'a BlockConfig,
    pub recent: &'a Recent<'a>,
    pub memory: &'a M,
    pub estimate: Impedance,
    pub samples: f32,
    pub local: &'a CentredMoments<M::CentredMoments>,
    /// What least squares would do, from the centre.
    pub solution: Solution,
}

impl<'a, M: WindowSums> WindowView<'a, M> {
    #[inline(always)]
    pub fn of(
        config: &'a BlockConfig,
        memory: &'a M,
        recent: &'a Recent<'a>,
        estimate: Impedance,
        local: &'a mut CentredMoments<M::CentredMoments>,
    ) -> Self {
        let samples = recent.len() as f32;
        let solution = local.solution(samples, config, estimate);
        Self { config, recent, memory, estimate, samples, local, solution }
    }

    /// The least-squares solution of the window.
    #[inline(always)]
    pub fn least_squares(&self) -> Impedance {
        self.local.centre.moved(1.0, self.solution.correction)
    }
}

/// The criterion that a block law minimises.
pub trait Criterion {
    /// How it keeps the sums of the window.
    type WindowSums: WindowSums;

    /// The move from the estimate of `view`.
    fn advance(&self, view: &WindowView<'_, Self::WindowSums>) -> CriterionStep;

    /// Takes in the newest of `recent`, and moves the estimate, without what tells of its quality.
    // The estimate is looked up where it is needed: kept aside for what is rare it would be moved at each update.
    #[inline(always)]
    fn update_estimate(&self, config: &BlockConfig, state: &mut BlockState<Self::WindowSums>, recent: &Recent<'_>) {
        state.memory.push(config, recent, state.estimate);
        if recent.len() >= usize::from(config.minimum_fill) {
            state.estimate = self.advance_estimate(config, &state.memory, recent, state.estimate);
        }
    }

    /// The estimate after `estimate`, without what tells of its quality; the same where the next is not finite.
    #[inline(always)]
    fn advance_estimate(
        &self,
        config: &BlockConfig,
        memory: &Self::WindowSums,
        recent: &Recent<'_>,
        estimate: Impedance,
    ) -> Impedance {
        let mut local = memory.centred_moments(recent, estimate);
        let to = self.advance(&WindowView::of(config, memory, recent, estimate, &mut local)).to;
        if to.is_finite() { to } else { estimate }
    }
}

/// A law on a sliding window, for a given criterion.
#[derive(Debug, Clone, Copy)]
pub struct BlockLaw<C> {
    pub(crate) config: BlockConfig,
    pub(crate) criterion: C,
}

impl<C: Criterion> BlockLaw<C> {
    /// Updates the estimate with the newest of `recent`, without interval, fill or excitation. The state is that of
    /// [`UpdateLaw::update`], and both may be mixed. Returns the innovation, in internal units of force.
    pub fn update_estimate(&self, state: &mut BlockState<C::WindowSums>, recent: Recent<'_>) -> f32 {
        let recent = &recent.last(self.window());
        let innovation = recent.newest().unwrap_or_default().residual(state.estimate);
        self.criterion.update_estimate(&self.config, state, recent);
        innovation
    }
}

impl<C: Criterion> UpdateLaw for BlockLaw<C> {
    type State = BlockState<C::WindowSums>;

    fn initial_state(&self) -> Self::State {
        BlockState::default()
    }

    /// Whoever holds the window clears it; a window that still holds samples at the next update is summed anew once.
    fn reset_memory(&self, state: &mut Self::State) {
        state.memory = C::WindowSums::default();
    }

    fn window(&self) -> usize {
        usize::from(self.config.window)
    }

    fn update(&self, state: &mut Self::State, recent: Recent<'_>) -> Step {
        let recent = &recent.last(self.window());
        let innovation = recent.newest().unwrap_or_default().residual(state.estimate);
        let fill = recent.len() as f32 / f32::from(self.config.window);
        state.memory.push(&self.config, recent, state.estimate);
        if recent.len() < usize::from(self.config.minimum_fill) {
            let (confidence, excitation, flags) = (Confidence::NONE, 0.0, Flags::TOO_FEW);
            return Step { estimate: state.estimate, innovation, confidence, fill, excitation, flags };
        }
        let mut local = state.memory.centred_moments(recent, state.estimate);
        let view = WindowView::of(&self.config, &state.memory, recent, state.estimate, &mut local);
        let CriterionStep { to, noise_variance, flags } = self.criterion.advance(&view);
        let (sums, solution) = (view.local.moments.second(), &view.solution);
        // Not at all where that would leave the finite numbers.
        let estimate = if to.is_finite() { to } else { state.estimate };
        state.estimate = estimate;
        Step {
            estimate,
            innovation,
            confidence: Confidence {
                noise: solution.inverse.scaled(noise_variance),
                noise_gain: solution.inverse,
                startup_bias: view.least_squares().moved(-1.0, estimate),
                offset_gain: solution.inverse.times(sums.regressor),
                samples: view.samples,
            },
            fill,
            excitation: sums.regressors.independence(),
            flags,
        }
    }
}
