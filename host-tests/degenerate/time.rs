//! Time that jumps, and time that trembles.

use super::{B, all_know_stiffness, all_readable, dithered, excitation};
use crate::rig;
use crate::simulator::Noise;
use palpate::{Flags, Method, StreamConfig};

#[test]
fn a_gap_holds_the_estimate_for_one_sample() {
    let mut bench = rig::bench(StreamConfig::BENCH);
    let before = rig::run(&mut bench, &excitation(2000).collect::<Vec<_>>());
    let mut before = before.last().expect("samples").expect("a good sample");
    for gap in [0.021, 0.5, 3600.0, 1e9] {
        let mut sample = dithered(0.0, gap);
        let at = bench.update(sample).expect("a good sample");
        for (method, (e, old)) in Method::ALL.iter().zip(at.iter().zip(&before)) {
            assert!(e.flags.contains(Flags::RESTARTED | Flags::HELD), "{}, {gap} s: {:?}", method.name(), e.flags);
            let change = (f64::from(e.impedance.stiffness) / f64::from(old.impedance.stiffness) - 1.0).abs();
            assert!(change < 0.02, "{}, {gap} s: {e:?} after {old:?}", method.name());
        }
        for k in 1..600 {
            sample = dithered(k as f64 * 1e-3, 1e-3);
            let estimates = bench.update(sample).expect("a good sample");
            all_readable(&estimates);
            // The tool moves at full speed, B v being 1 N of 4 N, and yet the filters begin without a transient.
            all_know_stiffness(&estimates, 0.02, &[Method::Rls, Method::ResetRls]);
            before = estimates;
        }
    }
}

#[test]
fn steps_of_half_to_one_and_a_half_milliseconds() {
    let mut noise = Noise::new(41);
    let mut bench = rig::bench(StreamConfig::BENCH);
    let (mut t, mut last) = (0.0, None);
    for _ in 0..6000 {
        let elapsed = 1e-3 * (0.5 + noise.uniform());
        t += elapsed;
        let estimates = bench.update(dithered(t, elapsed)).expect("a good sample");
        all_readable(&estimates);
        last = Some(estimates);
    }
    let last = last.expect("samples");
    all_know_stiffness(&last, 0.02, &[Method::Rls]);
    for (method, e) in Method::ALL.iter().zip(&last) {
        let error = (f64::from(e.impedance.damping) / B - 1.0).abs();
        println!("{:<12} jitter: B off by {error:.4}", method.name());
        // A difference over an uneven step belongs to its middle, as the two-sample means do.
        assert!(error < 0.1, "{}: {e:?}", method.name());
    }
}
