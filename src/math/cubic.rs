//! The cubic of the least-mean-fourth line search, in a form that keeps single precision.

use crate::math::{cbrt, near_sqrt};

/// The one real root of `t^3 + 3 p t + q = 0` for `p >= 0` (Cardano's formula with a discriminant above zero).
///
/// ```text
/// S = cbrt(|q|/2 + sqrt(q^2/4 + p^3)),   T = p / S,   t = -q / (S^2 + p + T^2)
/// ```
/// Only positive terms are added, so nothing cancels: the error is at most 2.5 units of 2^-23 over 24 decades of p and 36 of q, where the
/// naive `t = cbrt(..) + cbrt(..)` loses every digit in one case of a hundred (`host-tests/invariants/cubic.rs`).
///
/// Degenerate cases: `q = 0` gives 0; `p = 0` gives `-cbrt(q)`, the triple root where q is zero too. `None` where an
/// intermediate leaves the range of a single (|q| above 1e19 or p above 1e12), or an argument is NaN or `p` negative. Where
/// |q| is below 1e-19 and p below 1e-13 the squares underflow and the root is up to 60 % off.
pub fn depressed_root(p: f32, q: f32) -> Option<f32> {
    if q == 0.0 && p >= 0.0 {
        return Some(0.0);
    }
    let half = 0.5 * q.abs();
    let s = cbrt(half + near_sqrt(half * half + p * p * p));
    let t = p / s;
    let root = -q / (s * s + p + t * t);
    (p >= 0.0 && s > 0.0 && root.is_finite()).then_some(root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_named_cases() {
        assert_eq!(depressed_root(0.0, 0.0), Some(0.0));
        assert_eq!(depressed_root(2.0, 0.0), Some(0.0));
        let triple_like = depressed_root(0.0, -27.0).expect("a root");
        assert!((triple_like - 3.0).abs() <= 3.0 * f32::EPSILON * 3.0, "{triple_like}");
        let known = depressed_root(1.0, -4.0).expect("a root");
        assert!((known - 1.0).abs() <= 4.0 * f32::EPSILON, "1 + 3 - 4 = 0, got {known}");
        for (p, q) in [(f32::NAN, 1.0), (1.0, f32::NAN), (-1.0, 1.0), (f32::INFINITY, 1.0), (1.0, f32::INFINITY)] {
            assert_eq!(depressed_root(p, q), None, "p {p}, q {q}");
        }
    }

    /// A negative p has up to three real roots; the formula has a finite answer for some, which is none of this function's.
    #[test]
    fn a_negative_p_is_refused_also_where_the_formula_stays_finite() {
        for (p, q) in [(-0.1, 1.0), (-0.1, -1.0), (-1e-3, 1e3), (-1.0, 0.0), (-f32::MIN_POSITIVE, 1.0)] {
            assert_eq!(depressed_root(p, q), None, "p {p}, q {q}");
        }
    }
}
