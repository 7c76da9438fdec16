//! Second-order sums over samples, and the least-squares solution that follows from them.

use crate::contact::{Impedance, Observation};
use crate::math::sym2::Sym2;
use crate::window::Recent;

/// Sums of regressors and of the misfit `e = F - phi' c` of an estimate c. Taken about an estimate that is near, they
/// lose less to rounding than sums of raw force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    /// `sum phi phi'`.
    pub regressors: Sym2,
    /// `sum phi`.
    pub regressor: Impedance,
    /// `sum phi e`.
    pub misfit: Impedance,
    /// `sum e^2`.
    pub misfit_energy: f32,
}

impl Sums {
    /// Over all of `recent`, about `centre`.
    pub fn over(recent: Recent<'_>, centre: Impedance) -> Self {
        let mut s = Self::default();
        recent.for_each(|o| s = s.with(&Self::of(o, o.misfit(centre))));
        s
    }
}

impl Moments for Sums {
    #[inline(always)]
    fn of(o: &Observation, e: f32) -> Self {
        let (x, v) = (o.penetration, o.rate);
        Self {
            regressors: Sym2 { xx: x * x, xv: x * v, vv: v * v },
            regressor: Impedance { stiffness: x, damping: v },
            misfit: Impedance { stiffness: x * e, damping: v * e },
            misfit_energy: e * e,
        }
    }

    #[inline(always)]
    fn with(&self, other: &Self) -> Self {
        let (r, s) = (&self.regressors, &other.regressors);
        Self {
            regressors: Sym2 { xx: r.xx + s.xx, xv: r.xv + s.xv, vv: r.vv + s.vv },
            regressor: plus(self.regressor, other.regressor),
            misfit: plus(self.misfit, other.misfit),
            misfit_energy: self.misfit_energy + other.misfit_energy,
        }
    }

    #[inline(always)]
    fn gather(&mut self, lost: &mut Self, terms: &Self, sign: f32) {
        let (r, l, t) = (&mut self.regressors, &mut lost.regressors, &terms.regressors);
        gather(&mut r.xx, &mut l.xx, sign * t.xx);
        gather(&mut r.xv, &mut l.xv, sign * t.xv);
        gather(&mut r.vv, &mut l.vv, sign * t.vv);
        for (sum, lost, terms) in [
            (&mut self.regressor, &mut lost.regressor, &terms.regressor),
            (&mut self.misfit, &mut lost.misfit, &terms.misfit),
        ] {
            gather(&mut sum.stiffness, &mut lost.stiffness, sign * terms.stiffness);
            gather(&mut sum.damping, &mut lost.damping, sign * terms.damping);
        }
        gather(&mut self.misfit_energy, &mut lost.misfit_energy, sign * terms.misfit_energy);
    }

    /// `sum phi e' = sum phi e - R d`, `sum e'^2 = sum e^2 - d'(sum phi e + sum phi e')`.
    #[inline(always)]
    fn shifted(&self, shift: Impedance) -> Self {
        let moved = self.regressors.times(shift);
        let misfit = Impedance {
            stiffness: self.misfit.stiffness - moved.stiffness,
            damping: self.misfit.damping - moved.damping,
        };
        let energy = self.misfit_energy
            - (shift.stiffness * (self.misfit.stiffness + misfit.stiffness)
                + shift.damping * (self.misfit.damping + misfit.damping));
        Self { misfit, misfit_energy: if energy < 0.0 { 0.0 } else { energy }, ..*self }
    }

    fn second(&self) -> &Sums {
        self
    }
}

fn plus(a: Impedance, b: Impedance) -> Impedance {
    Impedance { stiffness: a.stiffness + b.stiffness, damping: a.damping + b.damping }
}

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

/// One term of Kahan's summation.
#[inline(always)]
pub fn gather(sum: &mut f32, lost: &mut f32, term: f32) {
    let term = term - *lost;
    let next = *sum + term;
    *lost = (next - *sum) - term;
    *sum = next;
}
