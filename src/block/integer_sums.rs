//! Second-order sums over samples in fixed-point numbers: exact, so what is added and removed again leaves nothing behind.

use core::sync::atomic::{Ordering, compiler_fence};

use crate::block::second_order::SecondOrderSums;
use crate::contact::{Impedance, Observation};
use crate::front_end::Units;
use crate::math::sym2::Sym2;
use crate::math::{larger, near_sqrt, power_of_two_below, smaller};

/// The largest numbers of the initial scale, internal units: the bench's range of penetration twice, that of rate and force 16 times.
/// [`Units::for_range`] leaves a factor of 16; a rig that goes deeper takes a coarser scale at its first contact. Penetration is small at a
/// contact's begin and needs its digits there; a rate has its peak there.
const INITIAL_RANGE: Observation = Observation {
    penetration: power_of_two_below(4.0 * Units::BENCH_RANGE.penetration),
    rate: power_of_two_below(32.0 * Units::BENCH_RANGE.rate),
    force: power_of_two_below(16.0 * Units::BENCH_RANGE.force),
};

/// Bits below the largest number under which the root mean square of penetration is too coarse: it would have 12 bits at a window of
/// 300.
const MIN_PENETRATION_BITS: u32 = 15;

/// The same of the force, whose residual is a small part of it: 17 bits at a window of 300.
const MIN_FORCE_BITS: u32 = 10;

/// Bits below the largest number that another scale brings a sample, or the root mean square of the samples, to: room for 128 times as
/// much.
const ROOM_BITS: u32 = 7;

/// A sample and its residual in fixed-point numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FixedPoint {
    penetration: i32,
    rate: i32,
    residual: i32,
}

impl FixedPoint {
    /// Whether each is smaller in magnitude than `limit`, a power of two.
    #[inline(always)]
    fn is_below(self, limit: i32) -> bool {
        // The magnitude, or one less.
        let magnitude = |value: i32| value ^ (value >> 31);
        (magnitude(self.penetration) | magnitude(self.rate) | magnitude(self.residual)) < limit
    }
}

/// Powers of two that turn internal units into whole numbers, and back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// Whole numbers in an internal unit of penetration, rate and force.
    penetration: f32,
    rate: f32,
    force: f32,
    /// Internal units in a whole number.
    penetration_unit: f32,
    rate_unit: f32,
    force_unit: f32,
}

/// Exponents of a scale are kept within these, so that neither it nor its inverse leaves the normal numbers.
const MAX_SCALE: f32 = 1.0e36;
const MIN_SCALE: f32 = 1.0e-36;

impl Scale {
    fn of(penetration: f32, rate: f32, force: f32) -> Self {
        let [penetration, rate, force] =
            [penetration, rate, force].map(|s| s.clamp(MIN_SCALE, MAX_SCALE)).map(power_of_two_below);
        Self {
            penetration,
            rate,
            force,
            penetration_unit: 1.0 / penetration,
            rate_unit: 1.0 / rate,
            force_unit: 1.0 / force,
        }
    }

    /// The initial scale, which [`INITIAL_RANGE`] fits.
    pub fn initial(bits: u32) -> Self {
        let Observation { penetration, rate, force } = INITIAL_RANGE;
        let (most, least) = (magnitude(bits), 1.0 / magnitude(bits));
        Self {
            penetration: most * (1.0 / penetration),
            rate: most * (1.0 / rate),
            force: most * (1.0 / force),
            penetration_unit: penetration * least,
            rate_unit: rate * least,
            force_unit: force * least,
        }
    }

    /// Coarser where `o` or its `residual` does not fit `bits` bits: it then takes a 128th of the numbers.
    pub fn coarser(&self, o: &Observation, residual: f32, bits: u32) -> Self {
        let (limit, target) = (magnitude(bits), magnitude(bits - ROOM_BITS));
        let coarser = |scale: f32, value: f32| if value.abs() * scale >= limit { target / value.abs() } else { scale };
        Self::of(
            coarser(self.penetration, o.penetration),
            coarser(self.rate, o.rate),
            coarser(self.force, larger(residual.abs(), o.force.abs())),
        )
    }

    /// Finer where the root mean square of penetration or force is left with too few of `bits` bits. The rate has no rule of its own: it
    /// dies away by decades where a tool is held, and would be too large for its scale at the next move. Its scale follows that of
    /// penetration.
    pub fn finer(&self, mean_square: &Observation, bits: u32) -> Option<Self> {
        let target = magnitude(bits - ROOM_BITS);
        let is_small = |square: f32, bits_left: u32| {
            let least = magnitude(bits - bits_left);
            square > 0.0 && square < least * least
        };
        let small_penetration = is_small(mean_square.penetration, MIN_PENETRATION_BITS);
        let small_force = is_small(mean_square.force, MIN_FORCE_BITS);
        if !small_penetration && !small_force {
            return None;
        }
        let room = |square: f32| target / near_sqrt(square);
        let mut finer = [self.penetration, self.rate, self.force];
        if small_penetration {
            let factor = room(mean_square.penetration);
            finer[0] *= factor;
            finer[1] *= larger(smaller(factor, room(mean_square.rate)), 1.0);
        }
        if small_force {
            finer[2] *= room(mean_square.force);
        }
        let [penetration, rate, force] = finer;
        Some(Self::of(penetration, rate, force))
    }

    /// `o` with its `residual`; what does not fit saturates. The residual is rounded, for it may be of one sign for long; what cutting off
    /// takes from the regressor is no error of the model, only of the weight of a sample.
    #[inline(always)]
    fn quantize(&self, o: &Observation, residual: f32) -> FixedPoint {
        /// Beyond this a single has no digit after the point.
        const ROUNDER: f32 = 1.5 * 8_388_608.0;
        FixedPoint {
            penetration: (o.penetration * self.penetration) as i32,
            rate: (o.rate * self.rate) as i32,
            residual: (residual * self.force + ROUNDER - ROUNDER) as i32,
        }
    }
}

/// `2^bits`, for at most 30 bits.
fn magnitude(bits: u32) -> f32 {
    (1_i32 << bits) as f32
}

/// Bits of a number, so that the squares of `window` of them add up to less than `2^63`, and two of them to less than `2^31`.
pub fn bits_for(window: u16) -> u32 {
    let doublings = u32::from(window).next_power_of_two().trailing_zeros();
    ((63 - doublings) / 2).min(29)
}

/// The sums of [`SecondOrderSums`] in whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct IntegerSums {
    xx: i64,
    xv: i64,
    vv: i64,
    xe: i64,
    ve: i64,
    ee: i64,
    x: i64,
    v: i64,
}

impl IntegerSums {
    /// Adds `new` and removes `old`; `[xv, xe, ve]` are those of the sums as they stand.
    ///
    /// Squares by `a^2 - b^2 = (a - b) (a + b)`, products by `a c - b d = (a - b) c + b (c - d)`. Each sum is stored before the next is
    /// formed: eight sums of 64 bits are more than the registers of the core, and where the compiler kept them there it moved them to the
    /// stack and back. Of the orders that were tried this one takes the fewest instructions.
    #[inline(always)]
    fn replace(&mut self, [xv, xe, ve]: [i64; 3], new: FixedPoint, old: FixedPoint) {
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
}

impl IntegerSums {
    /// Adds `a` and `b`, or removes both where `sign` is -1.
    #[inline(always)]
    fn add_both(&mut self, a: FixedPoint, b: FixedPoint, sign: i32) {
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
