//! Symmetric 2x2 matrices kept as three numbers, with closed forms for what is asked of them.

use crate::contact::Impedance;

/// `[[xx, xv], [xv, vv]]`; rows and columns belong to penetration (stiffness) and rate (damping).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sym2 {
    /// Upper left.
    pub xx: f32,
    /// Off the diagonal, both times.
    pub xv: f32,
    /// Lower right.
    pub vv: f32,
}

impl Sym2 {
    /// All zero.
    pub const ZERO: Self = Self::diagonal(0.0, 0.0);

    /// Nothing is known: an infinite variance of both.
    pub const UNKNOWN: Self = Self::diagonal(f32::INFINITY, f32::INFINITY);

    /// `diag(xx, vv)`.
    pub const fn diagonal(xx: f32, vv: f32) -> Self {
        Self { xx, xv: 0.0, vv }
    }

    /// Adds `weight * [x, v] [x, v]'`.
    #[must_use]
    pub fn plus_outer(self, weight: f32, x: f32, v: f32) -> Self {
        let (wx, wv) = (weight * x, weight * v);
        Self { xx: self.xx + wx * x, xv: self.xv + wx * v, vv: self.vv + wv * v }
    }

    /// Every entry times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { xx: self.xx * factor, xv: self.xv * factor, vv: self.vv * factor }
    }

    /// `diag(x, v) * self * diag(x, v)`.
    #[must_use]
    pub fn stretched(self, x: f32, v: f32) -> Self {
        Self { xx: self.xx * x * x, xv: self.xv * x * v, vv: self.vv * v * v }
    }

    /// Determinant over the product of the diagonal, `1 - xv^2 / (xx vv)`: 1 for columns at right angles, 0 for columns
    /// along one line (or a column of zeros). Free of units. Formed from ratios, so nothing underflows.
    pub fn independence(self) -> f32 {
        if self.xx > 0.0 && self.vv > 0.0 {
            let rho = 1.0 - (self.xv / self.xx) * (self.xv / self.vv);
            if rho > 0.0 { rho } else { 0.0 }
        } else {
            0.0
        }
    }

    /// Solves `self * y = [a, b]` by the inverse, which eliminates the first column (Schur complement); `None` where
    /// [`Self::independence`] is at most `floor`. For a positive semidefinite matrix.
    pub fn solve(self, right: Impedance, floor: f32) -> Option<Impedance> {
        self.invert(floor).map(|inverse| inverse.times(right))
    }

    /// The inverse of a positive definite matrix; `None` where [`Self::independence`] is at most `floor`. It is infinite where
    /// the inverse of an entry is beyond the range.
    pub fn invert(self, floor: f32) -> Option<Self> {
        self.factored(floor).map(Factored::inverse)
    }

    /// A positive definite matrix, factored; `None` where [`Self::independence`] is at most `floor`.
    #[inline(always)]
    pub fn factored(self, floor: f32) -> Option<Factored> {
        if self.xx > 0.0 { self.factored_semidefinite(floor) } else { None }
    }

    /// The same of a matrix that is known to be positive semidefinite: where `xx` is zero, what is left is no number.
    #[inline(always)]
    pub fn factored_semidefinite(self, floor: f32) -> Option<Factored> {
        let ratio = self.xv / self.xx;
        let left = self.vv - ratio * self.xv;
        // The independence is `left / vv`.
        if left > floor * self.vv {
            Some(Factored { xv: self.xv, ratio, of_xx: 1.0 / self.xx, of_left: 1.0 / left })
        } else {
            None
        }
    }

    /// `self * right`.
    pub fn times(self, right: Impedance) -> Impedance {
        Impedance {
            stiffness: self.xx * right.stiffness + self.xv * right.damping,
            damping: self.xv * right.stiffness + self.vv * right.damping,
        }
    }

    /// `y' self y`.
    pub fn quadratic(self, y: Impedance) -> f32 {
        let image = self.times(y);
        image.stiffness * y.stiffness + image.damping * y.damping
    }

    /// Whether all three entries and their sum are finite: one test instead of three.
    pub fn is_finite(self) -> bool {
        (self.xx + self.xv + self.vv).is_finite()
    }
}

/// A matrix as `L diag(xx, left) L'` with `L = [[1, 0], [ratio, 1]]`, where `left` is the Schur complement of `xx`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factored {
    xv: f32,
    ratio: f32,
    /// Inverses of `xx` and `left`, which the solution and the inverse share.
    of_xx: f32,
    of_left: f32,
}

impl Factored {
    /// Solves `matrix * y = right` by elimination of the first unknown: no more rounding than by the inverse, and fewer instructions.
    #[inline(always)]
    pub fn solve(self, right: Impedance) -> Impedance {
        let damping = (right.damping - self.ratio * right.stiffness) * self.of_left;
        Impedance { stiffness: (right.stiffness - self.xv * damping) * self.of_xx, damping }
    }

    /// The inverse; infinite where the inverse of an entry is beyond the range.
    #[inline(always)]
    pub fn inverse(self) -> Sym2 {
        let xv = -self.ratio * self.of_left;
        Sym2 { xx: self.of_xx - self.ratio * xv, xv, vv: self.of_left }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_times_the_matrix_is_one_at_any_scale() {
        for scale in [1e-18_f32, 1e-6, 1.0, 1e6, 1e15] {
            let m = Sym2 { xx: 4.0, xv: -1.5, vv: 2.0 }.scaled(scale);
            let inverse = m.invert(1e-4).expect("well conditioned");
            let column = m.times(Impedance { stiffness: inverse.xx, damping: inverse.xv });
            // Three roundings on terms of at most twice the result.
            assert!((column.stiffness - 1.0).abs() <= 4.0 * f32::EPSILON, "{scale}: {column:?}");
            assert!(column.damping.abs() <= 4.0 * f32::EPSILON, "{scale}: {column:?}");
        }
    }

    #[test]
    fn columns_on_one_line_are_refused() {
        assert_eq!(Sym2::ZERO.plus_outer(3.0, 2.0, -1.0).invert(1e-6), None);
        assert_eq!(Sym2::ZERO.invert(0.0), None);
        assert_eq!(Sym2 { xx: f32::NAN, xv: 0.0, vv: 1.0 }.invert(0.0), None);
    }

    #[test]
    fn every_operation_is_that_of_its_matrix() {
        let m = Sym2 { xx: 4.0, xv: -1.5, vv: 2.0 };
        assert_eq!(m.plus_outer(0.5, 2.0, -3.0), Sym2 { xx: 6.0, xv: -4.5, vv: 6.5 });
        assert_eq!(m.scaled(0.5), Sym2 { xx: 2.0, xv: -0.75, vv: 1.0 });
        assert_eq!(m.stretched(2.0, 3.0), Sym2 { xx: 16.0, xv: -9.0, vv: 18.0 });
        let y = Impedance { stiffness: 2.0, damping: -3.0 };
        assert_eq!(m.times(y), Impedance { stiffness: 12.5, damping: -9.0 });
        assert_eq!(m.quadratic(y), 52.0);
        // 1 - 2.25 / 8.
        assert_eq!(m.independence(), 0.71875);
        for singular in [Sym2 { xx: 0.0, ..m }, Sym2 { vv: 0.0, ..m }, Sym2 { xx: -4.0, ..m }, Sym2 { xv: 4.0, ..m }] {
            assert_eq!(singular.independence(), 0.0, "{singular:?}");
        }
        let solved = m.solve(m.times(y), 0.0).expect("independent");
        assert!((solved.stiffness - 2.0).abs() < 1e-5 && (solved.damping + 3.0).abs() < 1e-5, "{solved:?}");
    }

    #[test]
    fn a_matrix_is_inverted_above_its_floor_and_not_at_it() {
        // Independence 0.75, exactly.
        let m = Sym2 { xx: 4.0, xv: 2.0, vv: 4.0 };
        assert_eq!(m.invert(0.75), None);
        assert_eq!(m.invert(0.7), Some(Sym2 { xx: 1.0 / 3.0, xv: -1.0 / 6.0, vv: 1.0 / 3.0 }));
        assert_eq!(Sym2 { xx: 0.0, xv: 0.0, vv: 4.0 }.invert(0.0), None);
        assert_eq!(Sym2 { xx: -4.0, xv: 0.0, vv: 4.0 }.invert(0.0), None);
    }

    #[test]
    fn a_matrix_is_finite_where_its_sum_is() {
        let finite = |xx, xv, vv| Sym2 { xx, xv, vv }.is_finite();
        assert!(finite(1e30, 1e30, 1e30) && finite(3e38, -3e38, 3e38));
        assert!(!finite(3e38, 3e38, 0.0) && !finite(3e38, 0.0, 3e38) && !finite(0.0, f32::NAN, 0.0));
    }
}
