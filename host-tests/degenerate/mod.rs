//! Bad weather: nothing moves, nothing is touched, sensors fail, time jumps, numbers leave their range.

mod contact;
mod rejected;
mod still;
mod time;
mod window;

use palpate::{BankEstimates, Estimate, Flags, Method, Sample};
use std::f64::consts::TAU;

const K: f64 = 300.0;
const B: f64 = 5.0;

/// A dithered contact at time `t`: 10 to 17 mm deep, without noise.
fn dithered(t: f64, elapsed: f64) -> Sample {
    let (x, v) = (13.5e-3 + 3.3e-3 * (TAU * 10.0 * t).sin(), 3.3e-3 * TAU * 10.0 * (TAU * 10.0 * t).cos());
    Sample { position: x as f32, force: (K * x + B * v) as f32, elapsed: elapsed as f32 }
}

/// `count` samples of it at 1 kHz.
fn excitation(count: usize) -> impl Iterator<Item = Sample> {
    (0..count).map(|k| dithered(k as f64 * 1e-3, 1e-3))
}

/// Numbers that a user may read: no NaN anywhere, and K and B finite.
#[track_caller]
fn assert_readable(method: Method, e: &Estimate) {
    let w = e.half_width;
    let sound = e.impedance.is_finite() && e.innovation.is_finite() && w.stiffness >= 0.0 && w.damping >= 0.0;
    assert!(sound, "{}: {e:?}", method.name());
    let share = |x: f32| (0.0..=1.0).contains(&x);
    assert!(share(e.fill) && share(e.excitation), "{}: {e:?}", method.name());
    assert_eq!(e.flags, Flags::from_bits_truncate(e.flags.bits()));
}

#[track_caller]
fn all_readable(estimates: &BankEstimates) {
    for (method, estimate) in Method::ALL.iter().zip(estimates) {
        assert_readable(*method, estimate);
    }
}

/// Fails unless every method but those `excused` has K within `bound` of the truth.
#[track_caller]
fn all_know_stiffness(estimates: &BankEstimates, bound: f64, excused: &[Method]) {
    for (method, e) in Method::ALL.iter().zip(estimates).filter(|(method, _)| !excused.contains(method)) {
        let error = (f64::from(e.impedance.stiffness) / K - 1.0).abs();
        assert!(error <= bound, "{}: K off by {error:.3} ({e:?})", method.name());
    }
}
