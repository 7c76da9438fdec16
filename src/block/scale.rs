//! The scale at which samples are whole numbers.

use crate::block::fixed_point::FixedPoint;
use crate::contact::Observation;
use crate::front_end::Units;
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

/// Powers of two that turn internal units into whole numbers, and back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// Whole numbers in an internal unit of penetration, rate and force.
    pub(super) penetration: f32,
    pub(super) rate: f32,
    pub(super) force: f32,
    /// Internal units in a whole number.
    pub(super) penetration_unit: f32,
    pub(super) rate_unit: f32,
    pub(super) force_unit: f32,
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
    pub(super) fn quantize(&self, o: &Observation, residual: f32) -> FixedPoint {
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
