//! Nothing moves, for as long as one likes.

use super::{B, K, all_know_stiffness, all_readable, excitation};
use crate::rig;
use crate::simulator::Noise;
use palpate::{
    BlockConfig, BlockLeastSquares, EstimatorBank, Flags, FrontEndConfig, Identifier, Method, Sample, StreamConfig,
};

/// An hour at 1 kHz.
const HOUR: usize = 3_600_000;

/// A short window keeps the hour short; a held sample is the same to a long one.
fn bench(stream: StreamConfig) -> EstimatorBank {
    rig::bench_with(stream, BlockConfig::of(6))
}

fn feed(bench: &mut EstimatorBank, samples: impl Iterator<Item = Sample>) -> palpate::BankEstimates {
    let mut last = None;
    for sample in samples {
        let estimates = bench.update(sample).expect("a good sample");
        all_readable(&estimates);
        last = Some(estimates);
    }
    last.expect("at least one sample")
}

/// Stopped in mid-swing, with the force sensor's last count flickering.
fn held(count: usize) -> impl Iterator<Item = Sample> {
    let mut noise = Noise::new(9);
    (0..count).map(move |_| {
        let flicker = if noise.uniform() < 0.5 { 0.05 } else { 0.0 };
        Sample { position: 13.5e-3, force: (K * 13.5e-3 - 0.025 + flicker) as f32, elapsed: 1e-3 }
    })
}

#[test]
fn a_contact_that_is_held_for_an_hour() {
    let mut bench = bench(StreamConfig::BENCH);
    feed(&mut bench, excitation(1000));
    let after = feed(&mut bench, held(HOUR));
    for (method, e) in Method::ALL.iter().zip(&after) {
        assert!(e.flags.contains(Flags::LITTLE_MOVEMENT), "{}: {:?}", method.name(), e.flags);
        // Depth and force alone give K where B v is zero: to a count of force in four newtons.
        let error = (f64::from(e.impedance.stiffness) / K - 1.0).abs();
        let (b, width) = (e.impedance.damping, e.half_width.damping);
        println!("{:<12} held: K off by {error:.4}, B {b:.3e} +- {width:.3e}, {:?}", method.name(), e.flags);
        // Nothing says what B is, so an hour must either leave it or own up to not knowing it.
        let known = (f64::from(b) - B).abs() <= f64::from(width).max(0.05 * B);
        assert!(known || e.flags.contains(Flags::DAMPING_UNCERTAIN), "{}: {e:?}", method.name());
    }
    let ewrls = after[1];
    assert!(ewrls.flags.contains(Flags::LIMITED), "the covariance of B had an hour to grow: {ewrls:?}");
    all_know_stiffness(&after, 0.02, &[]);
    let moving = feed(&mut bench, excitation(3000));
    all_know_stiffness(&moving, 0.02, &[]);
    for (method, e) in Method::ALL.iter().zip(&moving) {
        assert!(!e.flags.contains(Flags::LITTLE_MOVEMENT), "{}: {:?}", method.name(), e.flags);
    }
}

#[test]
fn a_contact_that_is_held_for_an_hour_under_a_full_window() {
    let law = BlockLeastSquares::new(BlockConfig::default()).expect("sound settings");
    let mut identifier = Identifier::<_, 300>::new(StreamConfig::BENCH, law).expect("sound settings");
    let mut last = None;
    for sample in excitation(1000).chain(held(HOUR)) {
        last = Some(identifier.update(sample).expect("a good sample"));
    }
    let e = last.expect("samples");
    assert!(e.flags.contains(Flags::DAMPING_HELD | Flags::DAMPING_UNCERTAIN | Flags::LITTLE_MOVEMENT), "{e:?}");
    assert!((f64::from(e.impedance.stiffness) / K - 1.0).abs() < 0.02 && e.half_width.stiffness.is_finite(), "{e:?}");
    assert!(e.impedance.damping.abs() < 100.0, "B was held while it still meant something: {e:?}");
}

#[test]
fn a_million_zeros_in_free_space() {
    let mut bench = bench(StreamConfig::BENCH);
    let zero = Sample { position: 0.0, force: 0.0, elapsed: 1e-3 };
    for k in 0..1_000_000 {
        for e in bench.update(zero).expect("a good sample") {
            assert!(e.flags.contains(Flags::NO_CONTACT), "sample {k}: {e:?}");
            assert_eq!((e.impedance.stiffness, e.impedance.damping, e.innovation), (0.0, 0.0, 0.0), "sample {k}");
        }
    }
    all_know_stiffness(&feed(&mut bench, excitation(4000)), 0.02, &[Method::Rls]);
}

#[test]
fn a_million_zeros_of_a_clamped_tool() {
    let clamped = FrontEndConfig { bilateral: true, ..FrontEndConfig::BENCH };
    let mut bench = bench(StreamConfig { front_end: clamped, ..StreamConfig::BENCH });
    let zeros = std::iter::repeat_n(Sample { position: 0.0, force: 0.0, elapsed: 1e-3 }, 1_000_000);
    let after = feed(&mut bench, zeros);
    for (method, e) in Method::ALL.iter().zip(&after) {
        assert_eq!((e.impedance.stiffness, e.impedance.damping), (0.0, 0.0), "{}", method.name());
        let warned = Flags::STIFFNESS_UNCERTAIN | Flags::DAMPING_UNCERTAIN | Flags::LITTLE_MOVEMENT;
        assert!(e.flags.contains(warned), "{}: {:?}", method.name(), e.flags);
    }
    // The prior of plain RLS is as strong as a second of dither, so four leave a tenth of it.
    all_know_stiffness(&feed(&mut bench, excitation(4000)), 0.02, &[Method::Rls]);
}

#[test]
fn what_was_learnt_of_damping_outlives_a_minute_without_motion() {
    let mut bench = rig::bench(StreamConfig::BENCH);
    feed(&mut bench, excitation(1000));
    let mut worst = [0.0_f64; Method::ALL.len()];
    for sample in held(60_000) {
        let estimates = bench.update(sample).expect("a good sample");
        for (worst, e) in worst.iter_mut().zip(&estimates) {
            *worst = worst.max(f64::from(e.impedance.damping).abs());
        }
    }
    for (method, worst) in Method::ALL.iter().zip(worst) {
        println!("{:<12} a minute held: B at most {worst:.3e}", method.name());
    }
    for (method, worst) in Method::ALL.iter().zip(worst) {
        // The rate of a held tool dies away in the filter. What is left of it, far below the last digit of the
        // position, is no excitation: B may wander, but by orders of magnitude only if noise is divided by nothing.
        assert!(worst < 1e3 * B, "{}: B went to {worst:e} while nothing moved", method.name());
    }
}
