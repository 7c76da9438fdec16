//! Sums of fourth order over a window: value, gradient and curvature of `sum e^4` at any estimate.

use crate::block::second_order::{Moments, SecondOrderSums, kahan_add};
use crate::contact::{Impedance, Observation};
use crate::math::sym2::Sym2;

/// The fifteen sums of `x^i v^j e^k`, `i + j + k = 4`: `sum (e - phi'd)^4` is a polynomial in d with these coefficients, so its value,
/// gradient and curvature anywhere need no look at the window.
///
/// In the order xxxx, xxxv, xxvv, xvvv, vvvv, xxxe, xxve, xvve, vvve, xxee, xvee, vvee, xeee, veee, eeee.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuarticSums([f32; 15]);

/// [`QuarticSums`] beside the sums of second order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FourthOrderSums {
    second: SecondOrderSums,
    quartic: QuarticSums,
}

impl Moments for FourthOrderSums {
    #[inline(always)]
    fn of(o: &Observation, e: f32) -> Self {
        let second = SecondOrderSums::of(o, e);
        let Sym2 { xx, xv, vv } = second.regressors;
        let Impedance { stiffness: xe, damping: ve } = second.residual;
        let ee = second.residual_energy;
        let regressors = [xx * xx, xx * xv, xx * vv, xv * vv, vv * vv];
        let [xxxx, xxxv, xxvv, xvvv, vvvv] = regressors;
        let sums = [
            xxxx,
            xxxv,
            xxvv,
            xvvv,
            vvvv,
            xx * xe,
            xx * ve,
            vv * xe,
            vv * ve,
            xx * ee,
            xv * ee,
            vv * ee,
            xe * ee,
            ve * ee,
            ee * ee,
        ];
        Self { second, quartic: QuarticSums(sums) }
    }

    #[inline(always)]
    fn with(&self, other: &Self) -> Self {
        Self { second: self.second.with(&other.second), quartic: self.quartic.with(&other.quartic) }
    }

    #[inline(always)]
    fn kahan_add(&mut self, lost: &mut Self, terms: &Self, sign: f32) {
        self.second.kahan_add(&mut lost.second, &terms.second, sign);
        for ((sum, lost), term) in self.quartic.0.iter_mut().zip(&mut lost.quartic.0).zip(&terms.quartic.0) {
            kahan_add(sum, lost, sign * term);
        }
    }

    #[inline(always)]
    fn shifted(&self, shift: Impedance) -> Self {
        Self { second: self.second.shifted(shift), quartic: self.quartic.shifted(shift) }
    }

    fn second(&self) -> &SecondOrderSums {
        &self.second
    }
}

impl FourthOrderSums {
    /// The sums of fourth order.
    pub fn quartic(&self) -> &QuarticSums {
        &self.quartic
    }
}

impl QuarticSums {
    /// The samples of both, which are summed about the same estimate.
    #[must_use]
    #[inline(always)]
    pub fn with(&self, other: &Self) -> Self {
        let mut sums = self.0;
        for (sum, more) in sums.iter_mut().zip(&other.0) {
            *sum += more;
        }
        Self(sums)
    }

    /// The same samples about an estimate that is `shift` further.
    ///
    /// The residual there is the old one less a x + b v, so each power of it follows from the one below.
    #[must_use]
    #[inline(always)]
    pub fn shifted(&self, shift: Impedance) -> Self {
        let Impedance { stiffness: a, damping: b } = shift;
        let [xxxx, xxxv, xxvv, xvvv, vvvv, xxxe, xxve, xvve, vvve, xxee, xvee, vvee, xeee, veee, eeee] = self.0;
        let less = |e: f32, x: f32, v: f32| e - (a * x + b * v);
        // One e made the new one, m; then two, three and four of them.
        let (xxxm, xxvm) = (less(xxxe, xxxx, xxxv), less(xxve, xxxv, xxvv));
        let (xvvm, vvvm) = (less(xvve, xxvv, xvvv), less(vvve, xvvv, vvvv));
        let (xxem, xvem, vvem) = (less(xxee, xxxe, xxve), less(xvee, xxve, xvve), less(vvee, xvve, vvve));
        let (xeem, veem, eeem) = (less(xeee, xxee, xvee), less(veee, xvee, vvee), less(eeee, xeee, veee));
        let (xxmm, xvmm, vvmm) = (less(xxem, xxxm, xxvm), less(xvem, xxvm, xvvm), less(vvem, xvvm, vvvm));
        let (xemm, vemm, eemm) = (less(xeem, xxem, xvem), less(veem, xvem, vvem), less(eeem, xeem, veem));
        let (xmmm, vmmm, emmm) = (less(xemm, xxmm, xvmm), less(vemm, xvmm, vvmm), less(eemm, xemm, vemm));
        let mmmm = less(emmm, xmmm, vmmm);
        Self([xxxx, xxxv, xxvv, xvvv, vvvv, xxxm, xxvm, xvvm, vvvm, xxmm, xvmm, vvmm, xmmm, vmmm, mmmm])
    }

    /// `sum phi e^3`: downhill.
    pub fn descent(&self) -> Impedance {
        let [.., stiffness, damping, _] = self.0;
        Impedance { stiffness, damping }
    }

    /// `sum phi phi' e^2`.
    pub fn hessian(&self) -> Sym2 {
        let [.., xx, xv, vv, _, _, _] = self.0;
        Sym2 { xx, xv, vv }
    }

    /// `sum e^4`.
    pub fn cost(&self) -> f32 {
        let [.., cost] = self.0;
        cost
    }

    /// `sum p^4` with `p = phi'u`.
    pub fn quartic(&self, u: Impedance) -> f32 {
        let [xxxx, xxxv, xxvv, xvvv, vvvv, ..] = self.0;
        let Impedance { stiffness: s, damping: d } = u;
        let (ss, sd, dd) = (s * s, s * d, d * d);
        ss * (ss * xxxx + 4.0 * (sd * xxxv)) + 6.0 * (sd * sd * xxvv) + dd * (4.0 * (sd * xvvv) + dd * vvvv)
    }

    /// `sum p^3 e`.
    pub fn cubic(&self, u: Impedance) -> f32 {
        let [_, _, _, _, _, xxx, xxv, xvv, vvv, ..] = self.0;
        let Impedance { stiffness: s, damping: d } = u;
        s * s * (s * xxx + 3.0 * (d * xxv)) + d * d * (3.0 * (s * xvv) + d * vvv)
    }

    /// `sum p^2 e^2`.
    pub fn square(&self, u: Impedance) -> f32 {
        self.hessian().quadratic(u)
    }

    /// `sum p e^3`.
    pub fn slope(&self, u: Impedance) -> f32 {
        let descent = self.descent();
        u.stiffness * descent.stiffness + u.damping * descent.damping
    }
}
