//! What the block laws share: the window's sums about the present estimate.

use crate::confidence::Confidence;
use crate::contact::Impedance;
use crate::error::{ConfigError, require, require_not_negative};
use crate::flags::Flags;
use crate::law::Law;
use crate::math::larger;
use crate::step::Step;
use crate::sym2::Sym2;
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
}

impl Default for BlockConfig {
    /// 300 samples, at least 20 of them, 1e-4, and 1e-4 (0.1 mm/s on the bench, less than one count of its encoder in a window).
    fn default() -> Self {
        Self { window: 300, minimum_fill: 20, independence_floor: 1e-4, rate_floor: 1e-4 }
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
        Ok(self)
    }
}

/// State of a block law: the window holds all the rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BlockState {
    /// K and B, internal units.
    pub estimate: Impedance,
}

/// Sums over a window of regressors and of the misfit `e = F - phi' theta` of the present estimate. Taken about an
/// estimate that is near, they lose less to rounding than sums of raw force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    pub samples: f32,
    pub regressors: Sym2,
    pub regressor: Impedance,
    pub misfit: Impedance,
    pub misfit_energy: f32,
    pub largest_misfit: f32,
}

impl Sums {
    pub fn over(recent: Recent<'_>, about: Impedance) -> Self {
        let mut s = Self { samples: recent.len() as f32, ..Self::default() };
        recent.for_each(|o| {
            let (x, v, e) = (o.penetration, o.rate, o.misfit(about));
            s.regressors = s.regressors.plus_outer(1.0, x, v);
            s.regressor.stiffness += x;
            s.regressor.damping += v;
            s.misfit.stiffness += x * e;
            s.misfit.damping += v * e;
            s.misfit_energy += e * e;
            s.largest_misfit = larger(e.abs(), s.largest_misfit);
        });
        s
    }
}

/// The least-squares solution of a window, as a move from the estimate that the sums were taken about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    pub correction: Impedance,
    pub inverse: Sym2,
    pub flags: Flags,
}

impl Solution {
    /// Both where the tool moves and the columns are independent, K alone where they are in line or it holds still,
    /// neither where it is not in the surface.
    pub fn of(sums: &Sums, config: &BlockConfig) -> Self {
        let moving = sums.regressors.vv > sums.samples * (config.rate_floor * config.rate_floor);
        if let Some(inverse) = sums.regressors.invert(config.independence_floor).filter(|_| moving) {
            let correction = inverse.times(sums.misfit);
            if correction.is_finite() {
                return Self { correction, inverse, flags: Flags::empty() };
            }
        }
        let stiffness = sums.misfit.stiffness / sums.regressors.xx;
        if sums.regressors.xx > 0.0 && stiffness.is_finite() {
            return Self {
                correction: Impedance { stiffness, damping: 0.0 },
                inverse: Sym2 { xx: 1.0 / sums.regressors.xx, ..Sym2::UNKNOWN },
                flags: Flags::DAMPING_HELD,
            };
        }
        Self { correction: Impedance::ZERO, inverse: Sym2::UNKNOWN, flags: Flags::HELD }
    }

    /// Mean square of the residual that the solution leaves.
    pub fn residual_variance(&self, sums: &Sums) -> f32 {
        let explained =
            self.correction.stiffness * sums.misfit.stiffness + self.correction.damping * sums.misfit.damping;
        let left = sums.misfit_energy - explained;
        if left > 0.0 { left / larger(sums.samples - 2.0, 1.0) } else { 0.0 }
    }
}

impl BlockState {
    /// Moves the estimate by `step`, or not at all where that would leave the finite numbers; what was done.
    fn move_by(&mut self, step: Impedance) -> Impedance {
        let next = self.estimate.moved(1.0, step);
        if next.is_finite() {
            self.estimate = next;
            step
        } else {
            Impedance::ZERO
        }
    }
}

/// What a law makes of the window's sums.
#[derive(Debug, Clone, Copy)]
pub struct Move {
    /// How the estimate is to move.
    pub step: Impedance,
    /// Variance per sample of the law's own criterion.
    pub noise_variance: f32,
    /// What was out of the ordinary.
    pub flags: Flags,
}

/// A window as a criterion sees it.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    pub config: &'a BlockConfig,
    pub recent: Recent<'a>,
    /// The estimate that `sums` are taken about.
    pub estimate: Impedance,
    pub sums: Sums,
    /// What least squares would do.
    pub solution: Solution,
}

impl<'a> View<'a> {
    pub fn of(config: &'a BlockConfig, recent: Recent<'a>, estimate: Impedance) -> Self {
        let sums = Sums::over(recent, estimate);
        let solution = Solution::of(&sums, config);
        Self { config, recent, estimate, sums, solution }
    }
}

/// What one block law has of its own.
pub trait Criterion {
    /// The move from the estimate of `view`.
    fn advance(&self, view: &View<'_>) -> Move;
}

/// A law on a sliding window: what all of them share, about the criterion of each.
#[derive(Debug, Clone, Copy)]
pub struct BlockLaw<C> {
    pub(crate) config: BlockConfig,
    pub(crate) criterion: C,
}

impl<C: Criterion> Law for BlockLaw<C> {
    type State = BlockState;

    fn start(&self) -> BlockState {
        BlockState::default()
    }

    /// The window is all the memory there is, and whoever holds it clears it.
    fn forget(&self, _: &mut BlockState) {}

    fn window(&self) -> usize {
        usize::from(self.config.window)
    }

    fn update(&self, state: &mut BlockState, recent: Recent<'_>) -> Step {
        let recent = recent.last(self.window());
        let innovation = recent.newest().unwrap_or_default().misfit(state.estimate);
        let fill = recent.len() as f32 / f32::from(self.config.window);
        if recent.len() < usize::from(self.config.minimum_fill) {
            let (confidence, excitation, flags) = (Confidence::NONE, 0.0, Flags::TOO_FEW);
            return Step { estimate: state.estimate, innovation, confidence, fill, excitation, flags };
        }
        let view = View::of(&self.config, recent, state.estimate);
        let Move { step, noise_variance, flags } = self.criterion.advance(&view);
        let View { sums, solution, .. } = view;
        let taken = state.move_by(step);
        Step {
            estimate: state.estimate,
            innovation,
            confidence: Confidence {
                noise: solution.inverse.scaled(noise_variance),
                noise_gain: solution.inverse,
                remainder: solution.correction.moved(-1.0, taken),
                offset_gain: solution.inverse.times(sums.regressor),
                samples: sums.samples,
            },
            fill,
            excitation: sums.regressors.independence(),
            flags,
        }
    }
}
