//! Second-order sums over samples, and the least-squares solution that follows from them.

use crate::contact::{Impedance, Observation};
use crate::math::sym2::Sym2;
use crate::window::Recent;

/// Sums of regressors and of the residual `e = F - phi' c` of an estimate c. Taken about an estimate that is near, they
/// lose less to rounding than sums of raw force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SecondOrderSums {
    /// `sum phi phi'`.
    pub regressors: Sym2,
    /// `sum phi`.
    pub regressor: Impedance,
    /// `sum phi e`.
    pub residual: Impedance,
    /// `sum e^2`.
    pub residual_energy: f32,
}

impl SecondOrderSums {
    /// Over all of `recent`, about `centre`.
    pub fn over(recent: &Recent<'_>, centre: Impedance) -> Self {
        let mut s = Self::default();
        recent.for_each(|o| s = s.with(&Self::of(o, o.residual(centre))));
        s
    }
}

impl Moments for SecondOrderSums {
    #[inline(always)]
    fn of(o: &Observation, e: f32) -> Self {
        let (x, v) = (o.penetration, o.rate);
        Self {
            regressors: Sym2 { xx: x * x, xv: x * v, vv: v * v },
            regressor: Impedance { stiffness: x, damping: v },
            residual: Impedance { stiffness: x * e, damping: v * e },
            residual_energy: e * e,
        }
    }

    #[inline(always)]
    fn with(&self, other: &Self) -> Self {
        let (r, s) = (&self.regressors, &other.regressors);
        Self {
            regressors: Sym2 { xx: r.xx + s.xx, xv: r.xv + s.xv, vv: r.vv + s.vv },
            regressor: plus(self.regressor, other.regressor),
            residual: plus(self.residual, other.residual),
            residual_energy: self.residual_energy + other.residual_energy,
        }
    }

    #[inline(always)]
    fn kahan_add(&mut self, lost: &mut Self, terms: &Self, sign: f32) {
        let (r, l, t) = (&mut self.regressors, &mut lost.regressors, &terms.regressors);
        kahan_add(&mut r.xx, &mut l.xx, sign * t.xx);
        kahan_add(&mut r.xv, &mut l.xv, sign * t.xv);
        kahan_add(&mut r.vv, &mut l.vv, sign * t.vv);
        for (sum, lost, terms) in [
            (&mut self.regressor, &mut lost.regressor, &terms.regressor),
            (&mut self.residual, &mut lost.residual, &terms.residual),
        ] {
            kahan_add(&mut sum.stiffness, &mut lost.stiffness, sign * terms.stiffness);
            kahan_add(&mut sum.damping, &mut lost.damping, sign * terms.damping);
        }
        kahan_add(&mut self.residual_energy, &mut lost.residual_energy, sign * terms.residual_energy);
    }

    /// `sum phi e' = sum phi e - R d`, `sum e'^2 = sum e^2 - d'(sum phi e + sum phi e')`.
    #[inline(always)]
    fn shifted(&self, shift: Impedance) -> Self {
        let moved = self.regressors.times(shift);
        let residual = Impedance {
            stiffness: self.residual.stiffness - moved.stiffness,
            damping: self.residual.damping - moved.damping,
        };
        let energy = self.residual_energy
            - (shift.stiffness * (self.residual.stiffness + residual.stiffness)
                + shift.damping * (self.residual.damping + residual.damping));
        Self { residual, residual_energy: if energy < 0.0 { 0.0 } else { energy }, ..*self }
    }

    fn second(&self) -> &SecondOrderSums {
        self
    }
}

fn plus(a: Impedance, b: Impedance) -> Impedance {
    Impedance { stiffness: a.stiffness + b.stiffness, damping: a.damping + b.damping }
}

/// SecondOrderSums over samples that can be added, subtracted, and shifted to residuals about another estimate.
pub trait Moments: Copy + Default + core::fmt::Debug {
    /// Of one sample with residual `e`.
    fn of(o: &Observation, e: f32) -> Self;
    /// The samples of both, which are summed about the same estimate.
    #[must_use]
    fn with(&self, other: &Self) -> Self;
    /// Adds `sign` times `terms` by Kahan's summation; `lost` is its running compensation.
    fn kahan_add(&mut self, lost: &mut Self, terms: &Self, sign: f32);
    /// The same samples about an estimate that is `shift` further.
    #[must_use]
    fn shifted(&self, shift: Impedance) -> Self;
    /// The sums of second order.
    fn second(&self) -> &SecondOrderSums;
}

/// One term of Kahan's summation.
#[inline(always)]
pub fn kahan_add(sum: &mut f32, lost: &mut f32, term: f32) {
    let term = term - *lost;
    let next = *sum + term;
    *lost = (next - *sum) - term;
    *sum = next;
}
