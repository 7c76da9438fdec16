//! Exact sums over a run of samples, and what they say of K and B.

use core::sync::atomic::{Ordering, compiler_fence};

use crate::block::fixed_point::FixedPoint;
use crate::block::integer_sums::IntegerSums;
use crate::block::scale::Scale;
use crate::block::second_order::SecondOrderSums;
use crate::contact::{Impedance, Observation};
use crate::math::larger;
use crate::math::sym2::Sym2;

/// Exact sums over some samples, of regressors and of residuals about `centre`.
///
/// A sample is rounded to whole numbers of a scale once, in the same way when it is added and when it is removed; products and sums of
/// whole numbers are exact. So the sums are those of the samples that are in, to the bit, whatever came and went before.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExactRun {
    pub centre: Impedance,
    pub scale: Scale,
    sums: IntegerSums,
}

impl ExactRun {
    /// Forgets all samples, and takes another centre and scale: in place, for a copy would cost more than what it is for.
    pub fn restart(&mut self, centre: Impedance, scale: &Scale) {
        self.centre = centre;
        self.scale = *scale;
        self.sums = IntegerSums::default();
    }

    /// The square of `rate` in whole numbers.
    pub fn rate_energy(&self, rate: f32) -> f32 {
        let rate = rate * self.scale.rate;
        rate * rate
    }

    /// `o` in whole numbers of the scale. The residual is formed with one operation less than [`Observation::residual`] has.
    #[inline(always)]
    pub fn quantize(&self, o: &Observation) -> FixedPoint {
        let Impedance { stiffness, damping } = self.centre;
        self.scale.quantize(o, o.force - stiffness * o.penetration - damping * o.rate)
    }

    /// The same where they are below `limit`.
    #[inline(always)]
    pub fn fitting(&self, o: &Observation, limit: i32) -> Option<FixedPoint> {
        let fixed = self.quantize(o);
        fixed.is_below(limit).then_some(fixed)
    }

    /// Adds `new` and removes `old`, which is in, or is the default sample, which is nothing. `next` takes the place of `old`.
    #[inline(always)]
    pub fn replace(&mut self, new: FixedPoint, old: &mut Observation, next: &Observation) {
        // Looked up before `old`: of several numbers the compiler adds those first that are known first, and a product that is added to
        // its sum is one multiplication with accumulation.
        let products = [self.sums.xv, self.sums.xe, self.sums.ve];
        let leaving = self.quantize(old);
        self.sums.replace(products, new, leaving);
        *old = *next;
    }

    /// Adds `a` and `b`; whether both are below `limit` in whole numbers, without which the sums are of no use.
    #[inline(never)]
    pub fn add(&mut self, a: &Observation, b: &Observation, limit: i32) -> bool {
        let (a, b) = (self.quantize(a), self.quantize(b));
        self.sums.add_both(a, b, 1);
        a.is_below(limit) && b.is_below(limit)
    }

    /// Removes `a` and `b`, which are in, or are the default sample.
    #[inline(never)]
    pub fn remove(&mut self, a: &Observation, b: &Observation) {
        self.sums.add_both(self.quantize(a), self.quantize(b), -1);
    }

    /// The sums in internal units.
    #[inline(always)]
    pub fn moments(&self) -> SecondOrderSums {
        let Scale { penetration_unit: x, rate_unit: v, force_unit: e, .. } = self.scale;
        let s = &self.sums;
        SecondOrderSums {
            regressors: Sym2 { xx: single(s.xx) * x * x, xv: single(s.xv) * x * v, vv: single(s.vv) * v * v },
            regressor: Impedance { stiffness: single(s.x) * x, damping: single(s.v) * v },
            residual: Impedance { stiffness: single(s.xe) * x * e, damping: single(s.ve) * v * e },
            residual_energy: single(s.ee) * e * e,
        }
    }

    /// The least-squares solution, in internal units, without a prior; `None` where it cannot tell B, or is not finite. B is told where the
    /// sum of the squares of rates, in whole numbers, is above `least_rate_energy`.
    ///
    /// It is solved in whole numbers of the scale, as [`Factored::solve`] does it. Their units are powers of two, so each
    /// step rounds as that of [`Solution`] does, which solves in internal units.
    ///
    /// [`Factored::solve`]: crate::math::sym2::Factored::solve
    /// [`Solution`]: crate::block::solution::Solution
    #[inline(always)]
    pub fn plain_least_squares(&self, independence_floor: f32, least_rate_energy: f32) -> Option<Impedance> {
        let (s, scale) = (&self.sums, &self.scale);
        let vv = single(s.vv);
        if vv <= least_rate_energy {
            return None;
        }
        // A branch of its own: as one with the next, each of its instructions became a conditional one.
        compiler_fence(Ordering::SeqCst);
        let [xx, xv] = [s.xx, s.xv].map(single);
        let regressors = Sym2 { xx, xv, vv }.factored_semidefinite(independence_floor)?;
        let correction = regressors.solve(Impedance { stiffness: single(s.xe), damping: single(s.ve) });
        let solution = Impedance {
            stiffness: self.centre.stiffness + correction.stiffness * scale.penetration * scale.force_unit,
            damping: self.centre.damping + correction.damping * scale.rate * scale.force_unit,
        };
        solution.is_finite().then_some(solution)
    }

    /// The mean squares over `samples` samples in whole numbers of the scale, the newest of which is `newest`: never less than half its
    /// own square.
    pub fn mean_squares(&self, newest: &Observation, samples: f32) -> Observation {
        let s = &self.sums;
        let at = |value: f32, scale: f32| 0.5 * (value * scale) * (value * scale);
        // F = e + phi'c, in units in which a square does not underflow.
        let k = self.centre.stiffness * self.scale.penetration_unit * self.scale.force;
        let b = self.centre.damping * self.scale.rate_unit * self.scale.force;
        let force = single(s.ee)
            + 2.0 * (k * single(s.xe) + b * single(s.ve))
            + (k * k * single(s.xx) + 2.0 * k * b * single(s.xv) + b * b * single(s.vv));
        Observation {
            penetration: larger(single(s.xx) / samples, at(newest.penetration, self.scale.penetration)),
            rate: larger(single(s.vv) / samples, at(newest.rate, self.scale.rate)),
            force: larger(force / samples, at(newest.force, self.scale.force)),
        }
    }
}

/// The nearest single but for a last digit. The runtime library's own conversion is three times as long.
#[inline(always)]
fn single(sum: i64) -> f32 {
    const HIGH: f32 = 4_294_967_296.0;
    (sum >> 32) as i32 as f32 * HIGH + sum as u32 as f32
}
