//! A number that a threshold is part of, and what is compared with it.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::threshold::Threshold;
use crate::threshold_margin::{note_comparison, note_use};

/// `rest + part`, with a threshold in `part` as a factor. What is compared with it says how far the threshold could be moved.
#[derive(Debug, Clone, Copy)]
pub struct Bound {
    name: &'static str,
    /// The part that grows with the threshold, with the nominal one.
    nominal: f64,
    /// That part with the threshold as it is varied.
    varied: f64,
    rest: f64,
}

impl Bound {
    /// The threshold alone.
    #[must_use]
    pub fn of(threshold: Threshold) -> Self {
        Self { name: threshold.name, nominal: threshold.nominal, varied: threshold.varied(), rest: 0.0 }
    }

    /// The number, to be reckoned with.
    #[must_use]
    pub fn value(self) -> f64 {
        if self.nominal != 0.0 {
            note_use(self.name);
        }
        self.rest + self.varied
    }

    /// The number, to be shown: nothing is decided by it.
    #[must_use]
    pub fn shown(self) -> f64 {
        self.rest + self.varied
    }

    /// The greater of this and `number`.
    #[must_use]
    pub fn max(self, number: f64) -> Self {
        if number > self { Self { nominal: 0.0, varied: 0.0, rest: number, ..self } } else { self }
    }

    /// The lesser of this and `number`.
    #[must_use]
    pub fn min(self, number: f64) -> Self {
        -(-self).max(-number)
    }

    fn cmp_with(self, number: f64) -> Option<Ordering> {
        note_comparison(self.name, (number - self.rest) / self.nominal);
        number.partial_cmp(&(self.rest + self.varied))
    }
}

impl PartialEq<Bound> for f64 {
    fn eq(&self, other: &Bound) -> bool {
        other.cmp_with(*self) == Some(Ordering::Equal)
    }
}

impl PartialOrd<Bound> for f64 {
    fn partial_cmp(&self, other: &Bound) -> Option<Ordering> {
        other.cmp_with(*self)
    }
}

impl PartialEq<f64> for Bound {
    fn eq(&self, other: &f64) -> bool {
        self.cmp_with(*other) == Some(Ordering::Equal)
    }
}

impl PartialOrd<f64> for Bound {
    fn partial_cmp(&self, other: &f64) -> Option<Ordering> {
        self.cmp_with(*other).map(Ordering::reverse)
    }
}

impl Neg for Bound {
    type Output = Self;
    fn neg(self) -> Self {
        Self { nominal: -self.nominal, varied: -self.varied, rest: -self.rest, ..self }
    }
}

impl Mul<f64> for Bound {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self { nominal: by * self.nominal, varied: by * self.varied, rest: by * self.rest, ..self }
    }
}

impl Div<f64> for Bound {
    type Output = Self;
    fn div(self, by: f64) -> Self {
        Self { nominal: self.nominal / by, varied: self.varied / by, rest: self.rest / by, ..self }
    }
}

impl Add<f64> for Bound {
    type Output = Self;
    fn add(self, more: f64) -> Self {
        Self { rest: self.rest + more, ..self }
    }
}

impl Sub<f64> for Bound {
    type Output = Self;
    fn sub(self, less: f64) -> Self {
        self + -less
    }
}

impl Mul<Bound> for f64 {
    type Output = Bound;
    fn mul(self, bound: Bound) -> Bound {
        bound * self
    }
}

impl Add<Bound> for f64 {
    type Output = Bound;
    fn add(self, bound: Bound) -> Bound {
        bound + self
    }
}

impl Sub<Bound> for f64 {
    type Output = Bound;
    fn sub(self, bound: Bound) -> Bound {
        -bound + self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::threshold::Origin;
    use crate::threshold_margin::{ThresholdMargin, note_margins, noted_margins};

    fn threshold(name: &'static str) -> Threshold {
        Threshold { name, nominal: 2.0, unit: "1", meaning: " A ratio.", origin: Origin::Chosen }
    }

    /// Margin of a threshold of its own after `used`.
    fn margin_after(name: &'static str, used: impl Fn(Threshold)) -> ThresholdMargin {
        note_margins();
        used(threshold(name));
        noted_margins().get(name).copied().unwrap_or(ThresholdMargin::UNUSED)
    }

    #[test]
    fn what_is_compared_with_a_bound_says_at_which_factor_it_comes_out_otherwise() {
        // 2 f 3 + 1 = 10 at f = 1.5, and = 4 at f = 0.5; -2 f = -1 at f = 0.5, too.
        let above = ThresholdMargin { below: 0.0, above: Some(1.5) };
        assert_eq!(margin_after("test.ABOVE", |two| assert!(10.0 > two * 3.0 + 1.0)), above);
        let below = ThresholdMargin { below: 0.5, above: None };
        assert_eq!(margin_after("test.BELOW", |two| assert!(4.0 < 1.0 + 3.0 * two)), below);
        assert_eq!(margin_after("test.NEGATIVE", |two| assert!(-two < -1.0)), below);
        // No positive factor makes 2 f + 1 less than a half, and nothing at all changes 0 times 2 f.
        assert_eq!(
            margin_after("test.NEVER", |two| assert!(two + 1.0 > 0.5 && two * 0.0 < 1.0)),
            ThresholdMargin::UNUSED
        );
    }

    #[test]
    fn the_greater_of_a_bound_and_a_number_depends_on_the_threshold_only_where_it_is_the_bound() {
        let three = ThresholdMargin { below: 0.0, above: Some(1.5) };
        assert_eq!(margin_after("test.OTHER", |two| assert_eq!((two * 1.0).max(3.0).value(), 3.0)), three);
        assert_eq!(margin_after("test.LESSER", |two| assert_eq!((two * 1.0).min(3.0).shown(), 2.0)), three);
        assert!(!margin_after("test.OWN", |two| assert_eq!((two * 1.0).max(1.0).value(), 2.0)).holds(1.01));
    }
}
