//! What the block laws share: settings, state, and the outcome of an update.

use crate::confidence::Confidence;
use crate::contact::Impedance;
use crate::error::{ConfigError, require, require_not_negative};
use crate::flags::Flags;
use crate::law::Law;
use crate::memory::{Local, Memory, Moments};
use crate::prior::Prior;
use crate::step::Step;
use crate::sums::Solution;
use crate::window::Recent;
use serde::{Deserialize, Serialize};

/// Settings of every block law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BlockConfig {
    /// Samples that an estimate rests on, at least 2, at most the capacity of the ring.
    pub window: u16,
    /// Samples below which the estimate is held, at least 2, at most `window`.
    pub minimum_fill: u16,
    /// Independence of penetration and rate (determinant over the product of the diagonal) at and below which B is
    /// held, 1e-6 to 0.1. In single precision the solution loses its last digit at about 1e-6.
    pub independence_floor: f32,
    /// Rms rate over the window at and below which B is held, internal units, zero or above. A filter lets the rate of a
    /// held tool die away by decades a second without ever reaching zero; B would be rounding divided by next to nothing.
    pub rate_floor: f32,
    /// A prior in the least-squares sums, with which `minimum_fill` may be 2; none in the paper.
    pub prior: Option<Prior>,
}

impl Default for BlockConfig {
    /// 300 samples, at least 20 of them, 1e-4, and 1e-4 (0.1 mm/s on the bench, less than one count of its encoder in a window).
    fn default() -> Self {
        Self { window: 300, minimum_fill: 20, independence_floor: 1e-4, rate_floor: 1e-4, prior: None }
    }
}

impl BlockConfig {
    /// `window` samples, at least 20 of them (or all, where there are fewer).
    pub fn of(window: u16) -> Self {
        Self { window, minimum_fill: window.min(20), ..Self::default() }
    }

    pub(crate) fn check(self) -> Result<Self, ConfigError> {
        require(self.window >= 2, "window", "at least 2 samples")?;
        require(
            (2..=self.window).contains(&self.minimum_fill),
            "minimum_fill",
            "at least 2 samples and at most the window",
        )?;
        require((1e-6..=0.1).contains(&self.independence_floor), "independence_floor", "between 1e-6 and 0.1")?;
        require_not_negative(self.rate_floor, "rate_floor")?;
        self.prior.map(Prior::check).transpose()?;
        Ok(self)
    }
}

/// State of a block law: the estimate, and what is remembered of the window beside its samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BlockState<M> {
    /// K and B, internal units.
    pub estimate: Impedance,
    pub(crate) memory: M,
}

/// What a law makes of the window's sums.
#[derive(Debug, Clone, Copy)]
pub struct Move {
    /// Where the estimate is to go.
    pub to: Impedance,
    /// Variance per sample of the law's own criterion.
    pub noise_variance: f32,
    /// What was out of the ordinary.
    pub flags: Flags,
}

/// A window as a criterion sees it.
#[derive(Debug, Clone, Copy)]
pub struct View<'a, M: Memory> {
    pub config: &'a BlockConfig,
    pub recent: Recent<'a>,
    pub memory: &'a M,
    pub estimate: Impedance,
    pub samples: f32,
    pub local: &'a Local<M::Local>,
    /// What least squares would do, from the centre.
    pub solution: Solution,
}

impl<'a, M: Memory> View<'a, M> {
    #[inline(always)]
    pub fn of(
        config: &'a BlockConfig,
        memory: &'a M,
        recent: Recent<'a>,
        estimate: Impedance,
        local: &'a mut Local<M::Local>,
    ) -> Self {
        let samples = recent.len() as f32;
        let mut solution = Solution::of(local.moments.second(), samples, config, local.centre);
        if !solution.flags.is_empty() && local.centre != estimate {
            // What is held is held where the estimate is.
            local.moments = local.moments.shifted(estimate.moved(-1.0, local.centre));
            local.centre = estimate;
            solution = Solution::of(local.moments.second(), samples, config, estimate);
        }
        Self { config, recent, memory, estimate, samples, local, solution }
    }

    /// The least-squares solution of the window.
    #[inline(always)]
    pub fn least_squares(&self) -> Impedance {
        self.local.centre.moved(1.0, self.solution.correction)
    }
}

/// What one block law has of its own.
pub trait Criterion {
    /// What it remembers of the window.
    type Memory: Memory;

    /// The move from the estimate of `view`.
    fn advance(&self, view: &View<'_, Self::Memory>) -> Move;
}

/// A law on a sliding window: what all of them share, about the criterion of each.
#[derive(Debug, Clone, Copy)]
pub struct BlockLaw<C> {
    pub(crate) config: BlockConfig,
    pub(crate) criterion: C,
}

impl<C: Criterion> BlockLaw<C> {
    /// Moves the estimate by the newest of `recent`, and nothing else: no interval, fill or excitation. The state is that of
    /// [`Law::update`], and either may follow on the other. Returns the innovation, in internal units of force.
    pub fn learn(&self, state: &mut BlockState<C::Memory>, recent: Recent<'_>) -> f32 {
        let recent = recent.last(self.window());
        let innovation = recent.newest().unwrap_or_default().misfit(state.estimate);
        state.memory.follow(&self.config, recent, state.estimate);
        if recent.len() >= usize::from(self.config.minimum_fill) {
            let mut local = state.memory.local(recent, state.estimate);
            let view = View::of(&self.config, &state.memory, recent, state.estimate, &mut local);
            let moved = self.criterion.advance(&view).to;
            if moved.is_finite() {
                state.estimate = moved;
            }
        }
        innovation
    }
}

impl<C: Criterion> Law for BlockLaw<C> {
    type State = BlockState<C::Memory>;

    fn start(&self) -> Self::State {
        BlockState::default()
    }

    /// Whoever holds the window clears it; a window that still holds samples at the next update is summed anew once.
    fn forget(&self, state: &mut Self::State) {
        state.memory = C::Memory::default();
    }

    fn window(&self) -> usize {
        usize::from(self.config.window)
    }

    fn update(&self, state: &mut Self::State, recent: Recent<'_>) -> Step {
        let recent = recent.last(self.window());
        let innovation = recent.newest().unwrap_or_default().misfit(state.estimate);
        let fill = recent.len() as f32 / f32::from(self.config.window);
        state.memory.follow(&self.config, recent, state.estimate);
        if recent.len() < usize::from(self.config.minimum_fill) {
            let (confidence, excitation, flags) = (Confidence::NONE, 0.0, Flags::TOO_FEW);
            return Step { estimate: state.estimate, innovation, confidence, fill, excitation, flags };
        }
        let mut local = state.memory.local(recent, state.estimate);
        let view = View::of(&self.config, &state.memory, recent, state.estimate, &mut local);
        let Move { to, noise_variance, flags } = self.criterion.advance(&view);
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
                remainder: view.least_squares().moved(-1.0, estimate),
                offset_gain: solution.inverse.times(sums.regressor),
                samples: view.samples,
            },
            fill,
            excitation: sums.regressors.independence(),
            flags,
        }
    }
}
