//! Block least mean fourth as it is printed: the window summed twice for each line search.

use crate::block::config::BlockConfig;
use crate::block::law::{BlockLaw, Criterion, CriterionStep, WindowView};
use crate::block::least_mean_fourth::{Direction, search_direction};
use crate::block::window_sums::{DirectSums, WindowSums};
use crate::contact::Impedance;
use crate::error::ConfigError;
use crate::math::cubic::depressed_root;
use crate::math::sym2::Sym2;
use crate::math::{larger, sqrt};
use crate::window::Recent;

/// [`crate::BlockLeastMeanFourth`] with its window summed anew at every sample, residuals and regressors scaled by their
/// largest, so that fourth powers neither underflow nor overflow at any scale of force and length.
///
/// The variance of its interval is `E e^6 / (9 (E e^2)^2)`, that of least mean fourth at its minimum.
pub type BlockLeastMeanFourth = BlockLaw<LeastMeanFourth>;

/// `sum (F - phi' theta)^4`, descended by one exact line search a sample.
#[derive(Debug, Clone, Copy)]
pub struct LeastMeanFourth {
    direction: Direction,
}

/// The coefficients of one line search, for residuals over their largest and p over its bound on the window.
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

/// Sums of the third power of the residual with its weights, residuals scaled by the largest.
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
        let mut local = DirectSums.centred_moments(&recent, estimate);
        let view = WindowView::of(&self.config, &DirectSums, &recent, estimate, &mut local);
        search(self.criterion.direction, &view, &Powers::of(&view)?)
    }
}

/// Scaled `sum p^4` below which the direction is not excited.
const MIN_QUARTIC: f32 = 1e-22;

/// The exact line search along the unit vector `u`; `None` where nothing is excited along it.
fn search_along(u: Impedance, view: &WindowView<'_, DirectSums>, powers: &Powers) -> Option<LineSearch> {
    let (recent, estimate) = (view.recent, view.estimate);
    let reach = u.stiffness.abs() * powers.reach.stiffness + u.damping.abs() * powers.reach.damping;
    let (to_p, to_e) = (1.0 / reach, 1.0 / powers.largest);
    let (mut a, mut b3, mut c3, mut d1) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
    recent.for_each(|o| {
        let p = o.predicted_by(u) * to_p;
        let e = o.residual(estimate) * to_e;
        let (pp, pe) = (p * p, p * e);
        a += pp * pp;
        b3 += pp * pe;
        c3 += pe * pe;
        d1 += pe * e * e;
    });
    if a.is_nan() || a <= MIN_QUARTIC {
        return None;
    }
    let centre = b3 / a;
    let (mut spread, mut skew) = (0.0_f32, 0.0_f32);
    recent.for_each(|o| {
        let p = o.predicted_by(u) * to_p;
        let e = o.residual(estimate) * to_e - centre * p;
        let pe = p * e;
        spread += pe * pe;
        skew += pe * e * e;
    });
    let root = centre + depressed_root(spread / a, -skew / a)?;
    let length = root * (powers.largest / reach);
    length.is_finite().then_some(LineSearch { direction: u, a, b: -3.0 * b3, c: 3.0 * c3, d: -d1, length })
}

fn search(direction: Direction, view: &WindowView<'_, DirectSums>, powers: &Powers) -> Option<LineSearch> {
    let d = search_direction(direction, view, powers.descent, powers.hessian)?;
    let norm = sqrt(d.stiffness * d.stiffness + d.damping * d.damping);
    search_along(Impedance { stiffness: d.stiffness / norm, damping: d.damping / norm }, view, powers)
}

impl Criterion for LeastMeanFourth {
    type WindowSums = DirectSums;

    fn advance(&self, view: &WindowView<'_, DirectSums>) -> CriterionStep {
        let powers = Powers::of(view);
        let search = powers.and_then(|powers| search(self.direction, view, &powers));
        CriterionStep {
            to: search.map_or(view.estimate, |s| view.estimate.moved(s.length, s.direction)),
            noise_variance: powers.map_or(0.0, |powers| powers.noise_variance(view.samples)),
            flags: self.direction.flags(&view.solution),
        }
    }
}

impl Powers {
    /// `None` where every residual is zero, or so small that its inverse is infinite.
    fn of(view: &WindowView<'_, DirectSums>) -> Option<Self> {
        let mut largest = 0.0;
        view.recent.for_each(|o| largest = larger(o.residual(view.estimate).abs(), largest));
        let scale = 1.0 / largest;
        if !scale.is_finite() || largest <= 0.0 {
            return None;
        }
        let mut s = Self { largest, ..Self::default() };
        view.recent.for_each(|o| {
            let (x, v, e) = (o.penetration, o.rate, o.residual(view.estimate) * scale);
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
