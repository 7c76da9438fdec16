//! Sums of a window against sums that are made anew.

use super::*;
use crate::block::solution::Solution;
use crate::window::Window;

/// Uniform from -1 to 1, by a linear congruential generator.
struct Noise(u64);

impl Noise {
    fn draw(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
    }
}

/// Both runs summed anew over `recent`, about the centres and scales of `sums`.
fn anew(sums: &ExactSums, recent: Recent<'_>) -> [ExactRun; 2] {
    let [mut run, mut second] = [sums.run, sums.second];
    run.restart(run.centre, &sums.run.scale);
    second.restart(second.centre, &sums.second.scale);
    let nothing = Observation::default();
    let mut newer = recent.len();
    recent.for_each(|o| {
        let (in_run, in_second) = match sums.second_use {
            SecondUse::Unused => (true, false),
            SecondUse::Prepared(count) => (true, newer <= usize::from(count)),
            SecondUse::Older(count) => {
                (recent.len() - newer >= usize::from(count), recent.len() - newer < usize::from(count))
            }
        };
        if in_run {
            run.add(o, &nothing, sums.limit);
        }
        if in_second {
            second.add(o, &nothing, sums.limit);
        }
        newer -= 1;
    });
    [run, second]
}

/// Follows `count` samples and compares every `stride`-th update with the window summed anew, to the bit. Returns how many runs were
/// prepared, and how many began at a sample that did not fit.
fn holds_the_window(window: u16, count: u64, stride: u64, mut next: impl FnMut(u64) -> Observation) -> [u64; 2] {
    const RING: usize = 2048;
    let config = BlockConfig { window, minimum_fill: 2, ..BlockConfig::default() };
    let (mut ring, mut sums) = (Window::<RING>::new(), ExactSums::default());
    let (mut estimate, mut begun) = (Impedance::ZERO, [0; 2]);
    for k in 0..count {
        ring.push(next(k));
        let recent = ring.recent().last(window.into());
        let before = sums.second_use;
        sums.push(&config, &recent, estimate);
        begun[0] += u64::from(sums.second_use == SecondUse::Prepared(0));
        begun[1] += u64::from(matches!(
            (before, sums.second_use),
            (SecondUse::Unused | SecondUse::Prepared(_), SecondUse::Older(_))
        ));
        let CentredMoments { centre, moments } = sums.centred_moments(&recent, estimate);
        let solution = Solution::of(&moments, recent.len() as f32, &config, centre);
        estimate = centre.moved(1.0, solution.correction);
        if k % stride == 0 {
            let [run, second] = anew(&sums, recent);
            assert_eq!(sums.run, run, "window {window}, update {k}");
            assert!(
                sums.second_use == SecondUse::Unused || sums.second == second,
                "window {window}, update {k}, {:?}",
                sums.second_use
            );
        }
    }
    begun
}

/// A dithered contact whose K jumps every 1237 samples and whose scale goes from nanonewtons to meganewtons and back.
fn contact(scale: impl Fn(u64) -> f32) -> impl FnMut(u64) -> Observation {
    let (mut noise, mut stiffness) = (Noise(7), 300.0);
    move |k| {
        if k % 1237 == 0 {
            stiffness = 1000.0 + 900.0 * noise.draw();
        }
        let (x, v) = (0.01 + 0.004 * noise.draw(), 0.2 * noise.draw());
        let force = scale(k) * (stiffness * x + 5.0 * v + 0.1 * noise.draw());
        Observation { penetration: x, rate: v, force }
    }
}

#[test]
fn it_holds_the_window_to_the_bit_at_every_length() {
    for window in (16..=70).chain([128, 255, 256, 257, 300, 2048]) {
        holds_the_window(window, 6 * u64::from(window) + 100, 1, contact(|_| 1.0));
    }
}

fn nano_to_mega(k: u64) -> f32 {
    10_f32.powi([0, -9, -9, 6, 6, -3, 3, 0][(k / 700 % 8) as usize])
}

#[test]
fn it_holds_the_window_to_the_bit_from_nanonewtons_to_meganewtons() {
    for window in [20, 50, 300] {
        let [prepared, not_fitting] = holds_the_window(window, 20_000, 1, contact(nano_to_mega));
        assert!(prepared > 5 && not_fitting > 2, "window {window}: {prepared}, {not_fitting}");
    }
}

/// What is not a number counts as zero (a front end rejects it, and infinities); the others are the ends of a front end's range.
#[test]
fn it_holds_the_window_to_the_bit_through_the_ends_of_the_range_and_what_is_no_number() {
    let ends = [f32::NAN, 1e6, -1e6, 1e-30, f32::MIN_POSITIVE, 0.0];
    for window in [16, 50, 300] {
        let (mut noise, mut sound) = (Noise(3), contact(nano_to_mega));
        holds_the_window(window, 30_000, 1, |k| {
            let mut end = || ends[(2.99 * (noise.draw() + 1.0)) as usize];
            let wild = Observation { penetration: end(), rate: end(), force: end() };
            if k % 97 == 0 || k / 500 % 9 == 3 { wild } else { sound(k) }
        });
        holds_the_window(window, 2_000, 1, contact(|_| 1.0));
    }
}

#[test]
fn it_holds_the_window_to_the_bit_after_a_million_samples() {
    holds_the_window(300, 1_000_001, 10_000, contact(|_| 1.0));
    holds_the_window(300, 1_000_001, 10_000, contact(nano_to_mega));
}

/// `cargo test --release -p palpate --lib -- --ignored hundred_million`: twenty-eight hours at 1 kHz in half a minute.
#[test]
#[ignore = "1e8 samples take half a minute"]
fn it_holds_the_window_to_the_bit_after_a_hundred_million_samples() {
    holds_the_window(300, 100_000_001, 100_000, contact(|_| 1.0));
    holds_the_window(300, 100_000_001, 100_000, contact(nano_to_mega));
}
