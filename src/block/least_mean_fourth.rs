//! Block least mean fourth (BLMF): one exact line search of `sum e^4` a sample.

use crate::block::compensated_sums::CompensatedSums;
use crate::block::config::BlockConfig;
use crate::block::fourth_order::{FourthOrderSums, QuarticSums};
use crate::block::law::{BlockLaw, Criterion, CriterionStep, WindowView};
use crate::block::second_order::Moments;
use crate::block::second_order::SecondOrderSums;
use crate::block::solution::Solution;
use crate::block::window_sums::WindowSums;
use crate::contact::Impedance;
use crate::error::ConfigError;
use crate::math::cubic::depressed_root;
use crate::math::larger;
use crate::math::sym2::Sym2;
use crate::quality::Flags;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Along which direction a sample's line search goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Direction {
    /// `u = -g/|g|`, `g = -sum phi e^3` (the paper). On a window of the bench it needs 63 steps from zero to within 2 %
    /// of the minimum.
    #[default]
    SteepestDescent,
    /// `u` along `(sum phi phi' e^2)^-1 sum phi e^3`: one step for the same.
    Newton,
}

impl Direction {
    pub(crate) fn flags(self, solution: &Solution) -> Flags {
        match self {
            // It moves both along its gradient, whatever least squares could have solved for.
            Self::SteepestDescent => solution.flags & Flags::HELD,
            Self::Newton => solution.flags,
        }
    }
}

/// Minimises `J = sum (F - phi' theta)^4` over the window (eq. 7-14), one step a sample after the sample entered.
///
/// Along a direction u, with `p = phi'u`, the step solves `A t^3 + B t^2 + C t + D = 0` where `A = sum p^4`,
/// `B = -3 sum p^3 e`, `C = 3 sum p^2 e^2`, `D = -sum p e^3`. J is convex, so there is exactly one real root. It is found
/// about the centre `l = sum p^3 e / A`, where the quadratic term vanishes.
///
/// J is a polynomial in theta whose fifteen coefficients are kept as running sums, so an update costs the same at any
/// window. Fourth powers are those of internal units ([`crate::Units`]): a residual within 1e-8 to 1e8 of them neither
/// underflows nor overflows.
///
/// The interval is that of least mean fourth at its minimum, `E e^6 / (9 (E e^2)^2)` in place of the variance (with the sixth
/// moment that a Gaussian of the same second and fourth has: 1.4 times too wide a variance for uniform noise, and for rare
/// spikes up to four times too narrow a one), widened by
/// the distance to the least-squares solution of the window, towards which an unfinished descent still has to go. Mean
/// fourth is no friend of outliers: its standard deviation of K over that of least squares is 1.27 for Gaussian noise, 0.67
/// for uniform noise, and 18 where one sample in 200 is a spike of 3 N (`host-tests/fourth.rs` measures these figures).
pub type BlockLeastMeanFourth = BlockLaw<LeastMeanFourth>;

/// `sum (F - phi' theta)^4`, descended by one exact line search a sample.
#[derive(Debug, Clone, Copy)]
pub struct LeastMeanFourth {
    direction: Direction,
}

impl BlockLeastMeanFourth {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig, direction: Direction) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastMeanFourth { direction } })
    }
}

/// The direction of search, scaled so that its larger entry has magnitude one; `None` where the gradient is zero. Where B is not
/// identifiable, Newton's direction is along K alone.
pub(crate) fn search_direction<M: WindowSums>(
    direction: Direction,
    view: &WindowView<'_, M>,
    descent: Impedance,
    hessian: Sym2,
) -> Option<Impedance> {
    let newton = match direction {
        Direction::SteepestDescent => None,
        Direction::Newton if view.solution.flags.contains(Flags::DAMPING_HELD) => {
            Some(Impedance { damping: 0.0, ..descent })
        }
        Direction::Newton => hessian.solve(descent, view.config.independence_floor),
    };
    scaled_to_one(newton.filter(|d| d.is_finite()).unwrap_or(descent))
}

/// `d` scaled so that its larger entry has magnitude one; `None` where it is zero.
fn scaled_to_one(d: Impedance) -> Option<Impedance> {
    let largest = larger(d.stiffness.abs(), d.damping.abs());
    if largest.is_nan() || largest <= 0.0 {
        return None;
    }
    Some(Impedance { stiffness: d.stiffness / largest, damping: d.damping / largest })
}

/// Where the quadratic term is more than this share of the curvature, the sums are shifted to the centre of the cubic before the
/// difference is formed, because it would lose digits by cancellation.
const MAX_CENTRE_FRACTION: f32 = 0.5;

/// How far to go along `u`, in its length; `None` where nothing is excited along it.
fn length_along(
    u: Impedance,
    here: &QuarticSums,
    memory: &CompensatedSums<FourthOrderSums>,
    estimate: Impedance,
) -> Option<f32> {
    let quartic = here.quartic(u);
    if quartic.is_nan() || quartic <= 0.0 {
        return None;
    }
    let (cubic, square, slope) = (here.cubic(u), here.square(u), here.slope(u));
    let centre = cubic / quartic;
    let (spread, skew) = if centre * cubic > MAX_CENTRE_FRACTION * square {
        let there = memory.quartic_about(estimate.moved(centre, u));
        (larger(there.square(u), 0.0), there.slope(u))
    } else {
        (square - centre * cubic, slope - centre * (3.0 * square - 2.0 * (centre * cubic)))
    };
    let length = centre + depressed_root(spread / quartic, -skew / quartic)?;
    length.is_finite().then_some(length)
}

/// Where the line search along `u` leads from `estimate`; `estimate` itself where there is no step.
fn line_search(
    u: Option<Impedance>,
    here: &QuarticSums,
    memory: &CompensatedSums<FourthOrderSums>,
    estimate: Impedance,
) -> Impedance {
    let step = u
        .and_then(|u| Some((length_along(u, here, memory, estimate)?, u)))
        .map_or(Impedance::ZERO, |(length, u)| Impedance::ZERO.moved(length, u));
    estimate.moved(1.0, step)
}

impl LeastMeanFourth {
    /// The step along Newton's direction, which the solution of second order may restrict.
    #[inline(never)]
    fn newton_step(
        &self,
        config: &BlockConfig,
        memory: &CompensatedSums<FourthOrderSums>,
        recent: &Recent<'_>,
        estimate: Impedance,
    ) -> Impedance {
        let mut local = memory.centred_moments(recent, estimate);
        self.advance(&WindowView::of(config, memory, recent, estimate, &mut local)).to
    }
}

/// Variance per sample at the minimum of the fourth power, `E e^6 / (9 (E e^2)^2)`, with the sixth moment of a Gaussian of
/// the same second and fourth, `E e^6 = 5/3 (E e^4)^2 / E e^2`. For uniform noise that is 1.4 times too much; for rare
/// spikes too little, by up to a factor of four.
fn noise_variance(sums: &SecondOrderSums, samples: f32, cost: f32) -> f32 {
    let square = sums.residual_energy / samples;
    // Never less than Cauchy and Schwarz allow, whatever rounding has left.
    let kurtosis = larger(cost / (samples * square * square), 1.0);
    if square > 0.0 { 5.0 / 27.0 * (kurtosis * kurtosis * square) } else { 0.0 }
}

impl Criterion for LeastMeanFourth {
    type WindowSums = CompensatedSums<FourthOrderSums>;

    fn advance(&self, view: &WindowView<'_, CompensatedSums<FourthOrderSums>>) -> CriterionStep {
        let here = view.local.moments.quartic();
        let u = search_direction(self.direction, view, here.descent(), here.hessian());
        CriterionStep {
            to: line_search(u, here, view.memory, view.estimate),
            noise_variance: noise_variance(view.local.moments.second(), view.samples, here.cost()),
            flags: self.direction.flags(&view.solution),
        }
    }

    /// A steepest descent needs neither the sums of second order nor their solution.
    #[inline(always)]
    fn advance_estimate(
        &self,
        config: &BlockConfig,
        memory: &CompensatedSums<FourthOrderSums>,
        recent: &Recent<'_>,
        estimate: Impedance,
    ) -> Impedance {
        let to = match self.direction {
            Direction::SteepestDescent => {
                let here = memory.quartic_about(estimate);
                line_search(scaled_to_one(here.descent()), &here, memory, estimate)
            }
            Direction::Newton => self.newton_step(config, memory, recent, estimate),
        };
        if to.is_finite() { to } else { estimate }
    }
}
