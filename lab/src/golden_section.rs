//! The golden section: the least value of a function with one valley, each step at the cost of one evaluation.

/// Part of an interval that a step leaves out: `(3 - sqrt 5) / 2`.
pub const LEFT_OUT: f64 = 0.381_966;

/// Where `cost` is least between `low` and `high`, to `precision` (J. Kiefer, Proc. Amer. Math. Soc. 4 (1953) 502). The middle where
/// the two are nearer than that; with several valleys, one of them.
pub fn least_between([mut low, mut high]: [f64; 2], precision: f64, cost: impl Fn(f64) -> f64) -> f64 {
    let (mut left, mut right) = (low + LEFT_OUT * (high - low), high - LEFT_OUT * (high - low));
    let (mut at_left, mut at_right) = (cost(left), cost(right));
    while high - low > precision {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = low + LEFT_OUT * (high - low);
            at_left = cost(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = high - LEFT_OUT * (high - low);
            at_right = cost(right);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Against the closed form: ln x - x / 3 is greatest at 3. Within a precision of 1e-6 rounding moves nothing: the cost's own digits
    /// end at sqrt(1e-16) of the scale, 5e-8.
    #[test]
    fn the_least_value_is_found_to_the_precision_with_one_evaluation_a_step() {
        let calls = Cell::new(0);
        let cost = |x: f64| {
            calls.set(calls.get() + 1);
            x / 3.0 - x.ln()
        };
        let at = least_between([0.5, 10.0], 1e-6, cost);
        assert!((at - 3.0).abs() < 1e-6, "{at}");
        // 9.5 shrinks by 0.618 a step to 1e-6: 34 steps, and two evaluations to begin with.
        assert_eq!(calls.get(), 36);
    }

    /// Falls toward an end: the least value is there.
    #[test]
    fn the_end_of_the_range_is_found() {
        for (cost, end) in [(1.0, 2.0), (-1.0, 5.0)] {
            let at = least_between([2.0, 5.0], 1e-3, |x| cost * x);
            assert!((at - end).abs() < 1e-3, "{at}");
        }
    }
}
