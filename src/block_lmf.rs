//! Block least mean fourth (BLMF): one exact line search of `sum e^4` a sample.

use crate::block::{BlockConfig, BlockLaw, Criterion, Move, View};
use crate::contact::Impedance;
use crate::cubic::depressed_root;
use crate::error::ConfigError;
use crate::flags::Flags;
use crate::math::{larger, sqrt};
use crate::sym2::Sym2;
use crate::window::Recent;
use serde::{Deserialize, Serialize};

/// Along which direction a sample's line search goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Direction {
    /// `u = -g/|g|`, `g = -sum phi e^3` (the paper). On a window of the bench it needs 63 steps from zero to within 2 %
    /// of the minimum.
    #[default]
    SteepestDescent,
    /// `u` along `(sum phi phi' e^2)^-1 sum phi e^3`: one step for the same.
    Newton,
}

/// Minimises `J = sum (F - phi' theta)^4` over the window (eq. 7-14), one step a sample after the sample entered.
///
/// Along the unit vector u, with `p = phi'u`, the step solves `A t^3 + B t^2 + C t + D = 0` where `A = sum p^4`,
/// `B = -3 sum p^3 e`, `C = 3 sum p^2 e^2`, `D = -sum p e^3`. J is convex, so there is exactly one real root. It is found
/// about the centre `l = sum p^3 e / A`, where the quadratic term vanishes. Misfits and regressors are scaled by their
/// largest, so that fourth powers neither underflow nor overflow at any scale of force and length.
///
/// The interval is that of least mean fourth at its minimum, `E e^6 / (9 (E e^2)^2)` in place of the variance, widened by
/// the distance to the least-squares solution of the window, towards which an unfinished descent still has to go. Mean
/// fourth is no friend of outliers: its standard deviation of K over that of least squares is 1.27 for Gaussian noise, 0.67
/// for uniform noise, and 18 where one sample in 200 is a spike of 3 N (`host-tests/fourth.rs` measures these figures).
pub type BlockLeastMeanFourth = BlockLaw<LeastMeanFourth>;

/// `sum (F - phi' theta)^4`, descended by one exact line search a sample.
#[derive(Debug, Clone, Copy)]
pub struct LeastMeanFourth {
    direction: Direction,
}

/// The coefficients of one line search, for misfits over their largest and p over its bound on the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSearch {
    /// Unit vector of the search.
    pub direction: Impedance,
    /// A = sum p^4.
    pub a: f32,
    /// B = -3 sum p^3 e.
    pub b: f32,
    /// C = 3 sum p^2 e^2.
    pub c: f32,
    /// D = -sum p e^3.
    pub d: f32,
    /// The root, times the scales: how far to go along `direction`.
    pub length: f32,
}

/// Sums of the misfit's third power and of what weighs it, misfits over the largest.
#[derive(Debug, Clone, Copy, Default)]
struct Powers {
    largest: f32,
    descent: Impedance,
    hessian: Sym2,
    square: f32,
    sixth: f32,
    reach: Impedance,
}

impl BlockLeastMeanFourth {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig, direction: Direction) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastMeanFourth { direction } })
    }

    /// The line search from `estimate` over `recent`; `None` where the gradient is zero or nothing is excited.
    pub fn line_search(&self, recent: Recent<'_>, estimate: Impedance) -> Option<LineSearch> {
        let view = View::of(&self.config, recent, estimate);
        self.criterion.search(&view, &Powers::of(&view)?)
    }
}

/// Below this scaled `sum p^4` no observation says anything along the direction.
const FLAT: f32 = 1e-22;

/// The exact line search along the unit vector `u`; `None` where nothing is excited along it.
fn search_along(u: Impedance, view: &View<'_>, powers: &Powers) -> Option<LineSearch> {
    let (recent, estimate) = (view.recent, view.estimate);
    let reach = u.stiffness.abs() * powers.reach.stiffness + u.damping.abs() * powers.reach.damping;
    let (to_p, to_e) = (1.0 / reach, 1.0 / powers.largest);
    let (mut a, mut b3, mut c3, mut d1) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
    recent.for_each(|o| {
        let p = o.predicted_by(u) * to_p;
        let e = o.misfit(estimate) * to_e;
        let (pp, pe) = (p * p, p * e);
        a += pp * pp;
        b3 += pp * pe;
        c3 += pe * pe;
        d1 += pe * e * e;
    });
    if a.is_nan() || a <= FLAT {
        return None;
    }
    let centre = b3 / a;
    let (mut spread, mut skew) = (0.0_f32, 0.0_f32);
    recent.for_each(|o| {
        let p = o.predicted_by(u) * to_p;
        let e = o.misfit(estimate) * to_e - centre * p;
        let pe = p * e;
        spread += pe * pe;
        skew += pe * e * e;
    });
    let root = centre + depressed_root(spread / a, -skew / a)?;
    let length = root * (powers.largest / reach);
    length.is_finite().then_some(LineSearch { direction: u, a, b: -3.0 * b3, c: 3.0 * c3, d: -d1, length })
}

impl LeastMeanFourth {
    fn search(&self, view: &View<'_>, powers: &Powers) -> Option<LineSearch> {
        search_along(self.unit_direction(view, powers)?, view, powers)
    }

    /// Where B cannot be told, Newton's direction is that of K alone.
    fn unit_direction(&self, view: &View<'_>, powers: &Powers) -> Option<Impedance> {
        let descent = powers.descent;
        let newton = match self.direction {
            Direction::SteepestDescent => None,
            Direction::Newton if view.solution.flags.contains(Flags::DAMPING_HELD) => {
                Some(Impedance { damping: 0.0, ..descent })
            }
            Direction::Newton => powers.hessian.solve(descent, view.config.independence_floor),
        };
        let d = newton.filter(|d| d.is_finite()).unwrap_or(descent);
        let largest = larger(d.stiffness.abs(), d.damping.abs());
        if largest.is_nan() || largest <= 0.0 {
            return None;
        }
        let d = Impedance { stiffness: d.stiffness / largest, damping: d.damping / largest };
        let norm = sqrt(d.stiffness * d.stiffness + d.damping * d.damping);
        Some(Impedance { stiffness: d.stiffness / norm, damping: d.damping / norm })
    }
}

impl Criterion for LeastMeanFourth {
    fn advance(&self, view: &View<'_>) -> Move {
        let powers = Powers::of(view);
        let search = powers.and_then(|powers| self.search(view, &powers));
        Move {
            step: search.map_or(Impedance::ZERO, |s| Impedance::ZERO.moved(s.length, s.direction)),
            noise_variance: powers.map_or(0.0, |powers| powers.noise_variance(view.sums.samples)),
            flags: match self.direction {
                // It moves both along its gradient, whatever least squares could have solved for.
                Direction::SteepestDescent => view.solution.flags & Flags::HELD,
                Direction::Newton => view.solution.flags,
            },
        }
    }
}

impl Powers {
    /// `None` where every misfit is zero, or so small that its inverse is infinite.
    fn of(view: &View<'_>) -> Option<Self> {
        let largest = view.sums.largest_misfit;
        let scale = 1.0 / largest;
        if !scale.is_finite() || largest <= 0.0 {
            return None;
        }
        let mut s = Self { largest, ..Self::default() };
        view.recent.for_each(|o| {
            let (x, v, e) = (o.penetration, o.rate, o.misfit(view.estimate) * scale);
            let square = e * e;
            let cube = square * e;
            s.descent.stiffness += x * cube;
            s.descent.damping += v * cube;
            s.hessian = s.hessian.plus_outer(square, x, v);
            s.square += square;
            s.sixth += cube * cube;
            s.reach.stiffness = larger(x.abs(), s.reach.stiffness);
            s.reach.damping = larger(v.abs(), s.reach.damping);
        });
        Some(s)
    }

    /// `E e^6 / (9 (E e^2)^2)`, in squared internal units of force.
    fn noise_variance(&self, samples: f32) -> f32 {
        self.sixth * samples / (9.0 * self.square * self.square) * self.largest * self.largest
    }
}
