//! Second-order sums over samples in fixed-point numbers: exact, so what is added and removed again leaves nothing behind.

use core::sync::atomic::{Ordering, compiler_fence};

use crate::block::fixed_point::FixedPoint;

/// The sums of [`SecondOrderSums`](crate::block::second_order::SecondOrderSums) in whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct IntegerSums {
    pub(super) xx: i64,
    pub(super) xv: i64,
    pub(super) vv: i64,
    pub(super) xe: i64,
    pub(super) ve: i64,
    pub(super) ee: i64,
    pub(super) x: i64,
    pub(super) v: i64,
}

impl IntegerSums {
    /// Adds `new` and removes `old`; `[xv, xe, ve]` are those of the sums as they stand.
    ///
    /// Squares by `a^2 - b^2 = (a - b) (a + b)`, products by `a c - b d = (a - b) c + b (c - d)`. Each sum is stored before the next is
    /// formed: eight sums of 64 bits are more than the registers of the core, and where the compiler kept them there it moved them to the
    /// stack and back. Of the orders that were tried this one takes the fewest instructions.
    #[inline(always)]
    pub(super) fn replace(&mut self, [xv, xe, ve]: [i64; 3], new: FixedPoint, old: FixedPoint) {
        let FixedPoint { penetration: x, rate: v, residual: e } = new;
        let FixedPoint { penetration: old_x, rate: old_v, residual: old_e } = old;
        let change = [x.wrapping_sub(old_x), v.wrapping_sub(old_v), e.wrapping_sub(old_e)];
        self.xe = with_product(with_product(xe, change[0], e), old_x, change[2]);
        in_turn(&mut self.xv, |_| with_product(with_product(xv, change[0], v), old_x, change[1]));
        in_turn(&mut self.ve, |_| with_product(with_product(ve, change[1], e), old_v, change[2]));
        for (sum, change, both) in [
            (&mut self.ee, change[2], e.wrapping_add(old_e)),
            (&mut self.vv, change[1], v.wrapping_add(old_v)),
            (&mut self.v, change[1], 1),
            (&mut self.xx, change[0], x.wrapping_add(old_x)),
            (&mut self.x, change[0], 1),
        ] {
            in_turn(sum, |sum| with_product(sum, change, both));
        }
    }

    /// Adds `a` and `b`, or removes both where `sign` is -1.
    #[inline(always)]
    pub(super) fn add_both(&mut self, a: FixedPoint, b: FixedPoint, sign: i32) {
        let FixedPoint { penetration: x, rate: v, residual: e } = a;
        let FixedPoint { penetration: other_x, rate: other_v, residual: other_e } = b;
        let signed = |value: i32| value.wrapping_mul(sign);
        let [with_x, with_v, with_e] = [x, v, e].map(signed);
        let [with_other_x, with_other_v, with_other_e] = [other_x, other_v, other_e].map(signed);
        add_products(&mut self.xx, [with_x, x], [with_other_x, other_x]);
        add_products(&mut self.xv, [with_x, v], [with_other_x, other_v]);
        add_products(&mut self.xe, [with_x, e], [with_other_x, other_e]);
        self.x = with_product(self.x, with_x.wrapping_add(with_other_x), 1);
        add_products(&mut self.vv, [with_v, v], [with_other_v, other_v]);
        add_products(&mut self.ve, [with_v, e], [with_other_v, other_e]);
        self.v = with_product(self.v, with_v.wrapping_add(with_other_v), 1);
        add_products(&mut self.ee, [with_e, e], [with_other_e, other_e]);
    }
}

/// Takes `value` once all sums before it are stored.
#[inline(always)]
fn in_turn(sum: &mut i64, value: impl FnOnce(i64) -> i64) {
    compiler_fence(Ordering::SeqCst);
    *sum = value(*sum);
}

/// `sum + a b`.
#[inline(always)]
fn with_product(sum: i64, a: i32, b: i32) -> i64 {
    sum.wrapping_add(i64::from(a) * i64::from(b))
}

#[inline(always)]
fn add_products(sum: &mut i64, [a, b]: [i32; 2], [c, d]: [i32; 2]) {
    let product = |a: i32, b: i32| i64::from(a) * i64::from(b);
    *sum = sum.wrapping_add(product(a, b)).wrapping_add(product(c, d));
    compiler_fence(Ordering::SeqCst);
}
