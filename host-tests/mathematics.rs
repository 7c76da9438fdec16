//! Roots, tangent and powers of two against double precision, and against what `micromath` would have given.

use crate::simulator::Noise;
use micromath::F32;
use palpate::math;

const COUNT: usize = 400_000;

/// Positive numbers spread evenly over their exponents, from the least subnormal to `top`.
fn spread(top: f32) -> impl Iterator<Item = f32> {
    let mut noise = Noise::new(7);
    let ends = [0.0, f32::from_bits(1), f32::MIN_POSITIVE, 1.0, 8.0, 27.0, top];
    ends.into_iter().chain((0..COUNT).map(move |_| f32::from_bits((noise.uniform() * f64::from(top.to_bits())) as u32)))
}

/// Distance in units of the last place of `want`.
fn ulps(got: f32, want: f64) -> f64 {
    let rounded = want as f32;
    let step = f64::from(f32::from_bits(rounded.to_bits() + 1)) - f64::from(rounded);
    (f64::from(got) - want).abs() / step
}

fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |worst, error| if error.is_nan() { f64::INFINITY } else { worst.max(error) })
}

#[test]
fn the_square_root_is_correctly_rounded() {
    for x in spread(f32::MAX) {
        // The double root rounded to single is the correctly rounded single root: 53 >= 2 * 24 + 2 digits.
        let want = f64::from(x).sqrt() as f32;
        assert_eq!(math::sqrt(x).to_bits(), want.to_bits(), "sqrt({x:e})");
    }
    assert!(math::sqrt(-1.0).is_nan() && math::sqrt(f32::NAN).is_nan());
}

#[test]
fn the_near_square_root_is_near() {
    let normal = || spread(1e38).filter(|x| *x >= 1e-37);
    let error = worst(normal().map(|x| (f64::from(math::near_sqrt(x)) / f64::from(x).sqrt() - 1.0).abs()));
    println!("near_sqrt: worst relative error {error:.2e}");
    // Half a unit in the last place is 6e-8 of the smallest mantissa.
    assert!((5e-8..=1.2e-7).contains(&error), "{error:e}");
    assert_eq!(math::near_sqrt(0.0), 0.0);
    assert!(math::near_sqrt(f32::INFINITY).is_nan() && math::near_sqrt(f32::NAN).is_nan());
    // What is less than the range is not told larger than its root by more than rounding.
    for x in spread(1e-37).filter(|x| *x > 0.0) {
        assert!(f64::from(math::near_sqrt(x)) <= f64::from(x).sqrt() * 1.001, "{x:e}");
    }
}

#[test]
fn the_cube_root_is_within_one_unit_in_the_last_place() {
    let error = worst(spread(1e38).map(|x| ulps(math::cbrt(x), f64::from(x).cbrt())));
    println!("cbrt: worst error {error:.3} ulp");
    // Half a unit is the rounding of the answer itself: less would mean that nothing was measured.
    assert!((0.5..=1.0).contains(&error), "{error}");
    assert!(math::cbrt(f32::NAN).is_nan());
}

#[test]
fn the_tangent_is_good_to_a_few_millionths() {
    let relative = |x: f32| (f64::from(math::tan(x)) / f64::from(x).tan() - 1.0).abs();
    let range = |from: f32, to: f32| (0..COUNT).map(move |k| from + (to - from) * (k as f32 + 1.0) / COUNT as f32);
    let (low, high) = (worst(range(0.0, 0.5).map(relative)), worst(range(0.5, 1.26).map(relative)));
    let tiny = worst(range(0.0, 1e-5).map(relative));
    println!("tan: worst relative error {low:.2e} up to 0.5, {high:.2e} up to 1.26, {tiny:.2e} up to 1e-5");
    // Up to 0.5 there is only rounding left, of some five operations.
    assert!((2e-8..=2.5e-7).contains(&low.max(tiny)), "{low} {tiny}");
    assert!((1e-6..=1e-5).contains(&high), "{high}");
}

#[test]
fn the_nearest_power_of_two_is_nearest_on_a_logarithmic_scale() {
    for x in spread(f32::MAX / 2.0).filter(|x| x.is_normal()) {
        let got = math::nearest_power_of_two(x);
        assert_eq!(got.to_bits() & 0x007f_ffff, 0, "{x:e} gave {got:e}, which is no power of two");
        let octaves = (f64::from(x) / f64::from(got)).log2().abs();
        // The threshold is the root of two as a single, so the tie is off by less than its last digit.
        assert!(octaves <= 0.5 + 1e-7, "{x:e} gave {got:e}, {octaves} octaves away");
        assert_eq!(x / got * got, x, "scaling by it is exact");
    }
}

#[test]
fn micromath_is_thousands_of_times_farther_off() {
    let normal = || spread(1e38).filter(|x| x.is_normal());
    let relative = |got: f32, want: f64| (f64::from(got) / want - 1.0).abs();
    let root = worst(normal().map(|x| relative(F32(x).sqrt().0, f64::from(x).sqrt())));
    // It has no cube root; a power is what one would write in its place, over the range that a line search needs.
    let cube = |x: f32| relative(F32(x).powf(F32(1.0 / 3.0)).0, f64::from(x).cbrt());
    let cube = worst(normal().filter(|x| (1e-6..1e6).contains(x)).map(cube));
    let tangents = (1..=1000).map(|k| 1.26e-3 * k as f32);
    let tangent = worst(tangents.map(|x| relative(F32(x).tan().0, f64::from(x).tan())));
    let own = worst(normal().map(|x| relative(math::sqrt(x), f64::from(x).sqrt())));
    println!(
        "micromath, worst relative error: sqrt {root:.4} (1 in {:.1}), powf(1/3) {cube:.2e}, tan {tangent:.2e}; our sqrt {own:.2e}",
        1.0 / root
    );
    assert!(root > 1e4 * own && own > 1e-8, "micromath {root}, ours {own}");
    assert!(cube > 1e-4 && tangent > 2e-4, "{cube} {tangent}");
}
