//! Second-order sums over samples, and the least-squares solution that follows from them.

use crate::block::BlockConfig;
use crate::contact::{Impedance, Observation};
use crate::flags::Flags;
use crate::math::larger;
use crate::memory::{Moments, gather};
use crate::sym2::Sym2;
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
    ///
    /// A prior of `config` pulls towards zero; `centre` is the estimate that the sums of so many `samples` were taken about.
    #[inline(always)]
    pub fn of(sums: &Sums, samples: f32, config: &BlockConfig, centre: Impedance) -> Self {
        match config.prior {
            None => Self::plain(sums, samples, config),
            Some(prior) => {
                let (ridge, mut sums) = (prior.ridge(), *sums);
                sums.regressors.xx += ridge.stiffness;
                sums.regressors.vv += ridge.damping;
                sums.misfit.stiffness -= ridge.stiffness * centre.stiffness;
                sums.misfit.damping -= ridge.damping * centre.damping;
                Self::plain(&sums, samples, config)
            }
        }
    }

    fn plain(sums: &Sums, samples: f32, config: &BlockConfig) -> Self {
        let moving = sums.regressors.vv > samples * (config.rate_floor * config.rate_floor);
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
    pub fn residual_variance(&self, sums: &Sums, samples: f32) -> f32 {
        let explained =
            self.correction.stiffness * sums.misfit.stiffness + self.correction.damping * sums.misfit.damping;
        let left = sums.misfit_energy - explained;
        if left > 0.0 { left / larger(samples - 2.0, 1.0) } else { 0.0 }
    }
}
