//! The covariance of recursive least squares, factored so that it stays positive definite.

use crate::contact::{Impedance, Observation};
use crate::math::smaller;
use crate::math::sym2::Sym2;

/// `P = U diag(d1, d2) U'` with `U = [[1, u], [0, 1]]` (Bierman, Factorization Methods for Discrete Sequential
/// Estimation, 1977).
///
/// Every update multiplies d1 and d2 by positive numbers, so P stays symmetric and positive definite in single precision
/// for any initial size, where the plain form `P - L phi' P` cancels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance {
    d1: f32,
    d2: f32,
    u: f32,
}

impl Covariance {
    /// A multiple of the identity.
    pub const fn identity(size: f32) -> Self {
        Self { d1: size, d2: size, u: 0.0 }
    }

    /// `diag(stiffness, damping)`.
    pub const fn diagonal(stiffness: f32, damping: f32) -> Self {
        Self { d1: stiffness, d2: damping, u: 0.0 }
    }

    /// One observation of weight one, then division by the forgetting factor. Returns the gain `P phi / s` with
    /// `s = forgetting + phi' P phi` of the covariance before.
    pub fn observe(&mut self, o: &Observation, forgetting: f32) -> Impedance {
        self.observe_with(o, forgetting, 1.0 / forgetting)
    }

    /// The same with `growth`, the inverse of the forgetting factor, at hand.
    #[inline(always)]
    pub(crate) fn observe_with(&mut self, o: &Observation, forgetting: f32, growth: f32) -> Impedance {
        let f1 = o.penetration;
        let f2 = o.rate + self.u * f1;
        let (g1, g2) = (self.d1 * f1, self.d2 * f2);
        let a1 = forgetting + f1 * g1;
        let a2 = a1 + f2 * g2;
        let (inverse1, inverse2) = (1.0 / a1, 1.0 / a2);
        let gain = Impedance { stiffness: (g1 + self.u * g2) * inverse2, damping: g2 * inverse2 };
        self.u -= g1 * f2 * inverse1;
        self.d1 *= inverse1;
        self.d2 *= a1 * inverse2 * growth;
        gain
    }

    /// Adds `perturbation` times the identity; it must not be negative.
    pub fn inflate(&mut self, perturbation: f32) {
        let d2 = self.d2 + perturbation;
        let share = self.d2 / d2;
        self.d1 += perturbation + self.u * self.u * perturbation * share;
        self.u *= share;
        self.d2 = d2;
    }

    /// Keeps both factors at or below `limit`; whether one was reduced.
    pub fn limit(&mut self, limit: f32) -> bool {
        self.limit_each(Impedance { stiffness: limit, damping: limit })
    }

    /// As [`Self::limit`], with a limit of its own for the factor of each parameter.
    pub fn limit_each(&mut self, limits: Impedance) -> bool {
        let cut = self.d1 > limits.stiffness || self.d2 > limits.damping;
        self.d1 = smaller(self.d1, limits.stiffness);
        self.d2 = smaller(self.d2, limits.damping);
        cut
    }

    /// P itself.
    pub fn matrix(&self) -> Sym2 {
        let xv = self.u * self.d2;
        Sym2 { xx: self.d1 + self.u * xv, xv, vv: self.d2 }
    }

    /// Whether it is a covariance: finite, as their sum tells, and positive on both factors.
    pub fn is_sound(&self) -> bool {
        self.total().is_finite() && self.d1 > 0.0 && self.d2 > 0.0
    }

    /// A number that is finite only where all are.
    #[inline(always)]
    fn total(&self) -> f32 {
        self.d1 + self.d2 + self.u
    }

    /// The factor above the diagonal.
    #[inline(always)]
    pub(crate) fn off_diagonal(&self) -> f32 {
        self.u
    }

    /// A sufficient test, cheaper than [`Self::is_sound`] and [`Self::limit`], that a covariance whose off-diagonal factor is finite is
    /// positive definite and within `limit`: the sum of the other factors, of which an update makes none negative, is at most `limit`,
    /// and their product is positive.
    #[inline(always)]
    pub(crate) fn is_plain(&self, limit: f32) -> bool {
        self.d1 + self.d2 <= limit && self.d1 * self.d2 > 0.0
    }

    /// The same with a limit of its own, which is finite, for the factor of each parameter, as [`Self::limit_each`] has.
    #[inline(always)]
    pub(crate) fn is_plain_each(&self, limits: Impedance) -> bool {
        self.d1 <= limits.stiffness && self.d2 <= limits.damping && self.d1 * self.d2 > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_factor_has_a_limit_of_its_own() {
        for (limits, want, cut) in [
            ((8.0, 9.0), (5.0, 7.0), false),
            ((5.0, 7.0), (5.0, 7.0), false),
            ((4.0, 9.0), (4.0, 7.0), true),
            ((8.0, 6.0), (5.0, 6.0), true),
            ((4.0, 6.0), (4.0, 6.0), true),
        ] {
            let mut covariance = Covariance::diagonal(5.0, 7.0);
            let limited = covariance.limit_each(Impedance { stiffness: limits.0, damping: limits.1 });
            assert_eq!(limited, cut, "{limits:?}");
            assert_eq!(covariance.matrix(), Sym2::diagonal(want.0, want.1), "{limits:?}");
        }
        let mut covariance = Covariance::diagonal(5.0, 7.0);
        assert!(covariance.limit(6.0));
        assert_eq!(covariance.matrix(), Sym2::diagonal(5.0, 6.0));
    }

    #[test]
    fn a_factor_that_is_not_positive_or_not_finite_is_unsound() {
        assert!(Covariance::diagonal(1.0, 2.0).is_sound());
        for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(!Covariance::diagonal(wrong, 2.0).is_sound(), "{wrong}");
            assert!(!Covariance::diagonal(1.0, wrong).is_sound(), "{wrong}");
        }
        assert!(!Covariance { d1: 1.0, d2: 1.0, u: f32::NAN }.is_sound());
    }

    /// `P <- (P - P phi phi' P / s) / lambda` with `s = lambda + phi' P phi`, as matrices in double precision.
    #[test]
    fn an_observation_is_the_plain_form_of_the_recursion() {
        let mut covariance = Covariance { d1: 2.0, d2: 0.5, u: -0.75 };
        for (penetration, rate, forgetting) in [(0.5, -1.5, 0.75), (2.0, 0.25, 1.0), (-1.0, 3.0, 0.9)] {
            let before = covariance.matrix();
            let [xx, xv, vv] = [before.xx, before.xv, before.vv].map(f64::from);
            let (x, v, lambda) = (f64::from(penetration), f64::from(rate), f64::from(forgetting));
            let image = [xx * x + xv * v, xv * x + vv * v];
            let s = lambda + image[0] * x + image[1] * v;
            let gain = covariance.observe(&Observation { penetration, rate, force: 0.0 }, forgetting);
            let after = covariance.matrix();
            for (found, expected) in [
                (gain.stiffness, image[0] / s),
                (gain.damping, image[1] / s),
                (after.xx, (xx - image[0] * image[0] / s) / lambda),
                (after.xv, (xv - image[0] * image[1] / s) / lambda),
                (after.vv, (vv - image[1] * image[1] / s) / lambda),
            ] {
                assert!((f64::from(found) - expected).abs() <= 1e-5 * expected.abs(), "{found} {expected}");
            }
        }
    }

    #[test]
    fn inflation_adds_to_the_diagonal_and_to_nothing_else() {
        let mut covariance = Covariance { d1: 2.0, d2: 0.5, u: -0.75 };
        let before = covariance.matrix();
        covariance.inflate(1.5);
        let after = covariance.matrix();
        for (found, expected) in [(after.xx, before.xx + 1.5), (after.xv, before.xv), (after.vv, before.vv + 1.5)] {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn a_covariance_is_plain_where_no_limit_can_be_reached() {
        for (d1, d2, plain) in [(3.0, 5.0, true), (3.0, 5.5, false), (-1.0, 5.0, false), (1.0, -5.0, false)] {
            assert_eq!(Covariance { d1, d2, u: 0.5 }.is_plain(8.0), plain, "{d1} {d2}");
        }
        assert!(!Covariance { d1: 0.0, d2: 5.0, u: 0.0 }.is_plain(8.0));
        assert!(!Covariance { d1: 5.0, d2: 0.0, u: 0.0 }.is_plain(8.0));
        for wrong in [f32::NAN, f32::INFINITY] {
            assert!(!Covariance::diagonal(wrong, 5.0).is_plain(8.0) && !Covariance::diagonal(5.0, wrong).is_plain(8.0));
        }
        let covariance = Covariance { d1: 3.0, d2: 5.0, u: 0.5 };
        assert_eq!((covariance.total(), covariance.off_diagonal()), (8.5, 0.5));
    }
}
