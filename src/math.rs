//! The only home of roots and trigonometry, as free functions: in a test build the inherent methods of `std` would
//! otherwise be called in place of what ships.
//!
//! Everything here is plain IEEE 754 single precision without fused operations, so a host and a Cortex-M4F return the
//! same bits. Worst relative error (`host-tests/mathematics.rs`) and instructions on the Cortex-M4F, counted under QEMU by
//! SysTick with `-icount`, beyond those of an empty call:
//!
//! | function | here | `libm` | `micromath` |
//! |---|---|---|---|
//! | square root | `libm`'s | 6e-8, 48 | 6e-2, 10 |
//! | cube root | 1e-7, 27 | 6e-8, 1 560 to 1 610 (double precision in software) | 4e-2 by `powf`, 105 to 125 |
//! | tangent | 4e-6, 12 | 1 580 to 1 790 (double precision in software) | 1e-2 |
//!
//! So `libm` serves for the square root, neither for the others, and `micromath` nowhere: its errors are visible in the
//! estimate, where a cubic is to keep seven digits.

pub mod cubic;
pub mod sym2;

/// The larger of two; `b` where they do not compare. `f32::max` is a call into the runtime library on a Cortex-M4F, which
/// has no such instruction; this is a comparison and a select.
pub fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two; `b` where they do not compare.
pub fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Square root, correctly rounded; NaN below zero.
pub fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Square root of `x` for 1e-37 <= x <= 1e38 within 1.2e-7; zero for zero, not a number where `x` is infinite or none.
///
/// The inverse root from a guess by the exponent (3.5 % off) and two Newton steps, and a last step on the root itself.
pub fn near_sqrt(x: f32) -> f32 {
    let mut inverse = f32::from_bits(0x5f37_5a86_u32.wrapping_sub(x.to_bits() >> 1));
    let half = 0.5 * x;
    for _ in 0..2 {
        inverse *= 1.5 - half * inverse * inverse;
    }
    let root = x * inverse;
    root + 0.5 * inverse * (x - root * root)
}

/// Cube root of `x` for 0 <= x <= 1e38, within one unit in the last place.
///
/// A guess from the exponent (5 % off) and two Halley steps, each of which cubes the relative error.
pub fn cbrt(x: f32) -> f32 {
    /// 2^24 lifts a subnormal into the normal range, and is a perfect cube: its root is 2^8.
    const LIFT: f32 = 16_777_216.0;
    if x < f32::MIN_POSITIVE {
        return if x > 0.0 { cbrt_normal(x * LIFT) / 256.0 } else { x };
    }
    cbrt_normal(x)
}

fn cbrt_normal(x: f32) -> f32 {
    let mut y = f32::from_bits(x.to_bits() / 3 + 0x2a51_37a0);
    for _ in 0..2 {
        let cube = y * y * y;
        y += y * ((x - cube) / (cube + cube + x));
    }
    y
}

/// Tangent for 0 <= x <= 1.26 (0.4 pi), relative error below 5e-6 at the end and 2e-7 up to 0.5: the continued
/// fraction of Lambert cut after its fourth partial denominator.
pub fn tan(x: f32) -> f32 {
    let s = x * x;
    x * (945.0 + s * (s - 105.0)) / (945.0 + s * (15.0 * s - 420.0))
}

/// The power of two nearest to `x` on a logarithmic scale, for a normal `x` above zero.
///
/// Multiplying by it and by its inverse is exact, so units built from it cost no accuracy.
pub fn nearest_power_of_two(x: f32) -> f32 {
    let bits = x.to_bits();
    let above_root_two = (bits & 0x007f_ffff) >= 0x0035_04f3;
    let exponent = (bits >> 23) + u32::from(above_root_two);
    f32::from_bits(exponent.clamp(1, 254) << 23)
}

/// The largest power of two that is at most `x`, for a normal `x` above zero.
pub const fn power_of_two_below(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0x7f80_0000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_that_do_not_differ_or_do_not_compare_the_second_is_taken() {
        assert_eq!([larger(1.0, 2.0), larger(2.0, 1.0), smaller(1.0, 2.0), smaller(2.0, 1.0)], [2.0, 2.0, 1.0, 1.0]);
        for of in [larger, smaller] {
            assert!(of(0.0, -0.0).is_sign_negative() && of(-0.0, 0.0).is_sign_positive());
            assert_eq!(of(f32::NAN, 1.0), 1.0);
            assert!(of(1.0, f32::NAN).is_nan());
        }
    }

    #[test]
    fn powers_of_two_are_the_nearest_and_the_one_below() {
        for (x, nearest, below) in
            [(1.0, 1.0, 1.0), (1.41, 1.0, 1.0), (1.42, 2.0, 1.0), (0.3, 0.25, 0.25), (3.0, 4.0, 2.0)]
        {
            assert_eq!((nearest_power_of_two(x), power_of_two_below(x)), (nearest, below), "{x}");
        }
        assert_eq!(nearest_power_of_two(f32::MAX), 2.0_f32.powi(127));
        assert_eq!(nearest_power_of_two(f32::MIN_POSITIVE), f32::MIN_POSITIVE);
    }

    #[test]
    fn a_cube_root_is_exact_to_a_unit_from_subnormal_numbers_to_the_end_of_the_range() {
        for (x, root) in [
            (2.0_f32.powi(-147), 2.0_f32.powi(-49)),
            (2.0_f32.powi(-144), 2.0_f32.powi(-48)),
            (27.0, 3.0),
            (1e38, 4.641_589e12),
        ] {
            assert!((cbrt(x) / root - 1.0).abs() < 3e-7, "{x:e}: {:e}", cbrt(x));
        }
        assert_eq!((cbrt(0.0), cbrt(-2.0)), (0.0, -2.0), "nothing below zero has one here");
    }
}
