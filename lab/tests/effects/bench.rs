//! Rigs with ideal sensors, small enough to run often.

use palpate_lab::recording::Recording;
use palpate_lab::rig::{Reference, Rig};
use palpate_lab::simulate::simulate;

pub const STIFFNESS: f64 = 300.0;
pub const DAMPING: f64 = 5.0;
pub const MASS: f64 = 0.8;
pub const RATE: f64 = 1000.0;

/// To and fro through the surface every two seconds, 4 Hz on top.
pub const REFERENCE: Reference = Reference {
    free_depth: -8e-3,
    contact_depth: 10e-3,
    period_s: 2.0,
    contact_s: 1.2,
    smoothing_s: 0.03,
    sine_amplitude: 2e-3,
    sine_frequency_hz: 4.0,
};

/// A rig that is led along its reference, or driven.
pub fn rig(reference: Reference, driven: bool) -> Rig {
    let drive = if driven { "[drive]\nmass_kg = 0.8\nviscous_n_s_m = 4.0\n" } else { "" };
    let text = format!(
        "[rig]\nname = \"bench\"\n{drive}[contact]\nsurface_m = 0.0\nstiffness_n_m = 300.0\ndamping_n_s_m = 5.0\n\
         [sensors]\nposition_resolution_m = 0.0\nforce_resolution_n = 0.0\nforce_noise_n = 0.0\n\
         [simulation]\nduration_s = 4.0\n"
    );
    Rig { reference: Some(reference), ..Rig::parse(&text, "rig.toml").unwrap() }
}

/// `rig` with the effects of `tables`.
pub fn with(rig: &Rig, tables: &str) -> Rig {
    Rig::parse(&(rig.to_toml() + tables), "rig.toml").unwrap()
}

pub fn run(rig: &Rig) -> Recording {
    simulate(rig, 1, "rig.toml").unwrap().recording
}

pub fn force(recording: &Recording) -> &[f64] {
    recording.force.as_deref().unwrap()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

pub fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance, "{what}: {found} is {error:.2e} from {expected}, more than {tolerance:.1e}");
}

/// The largest difference between two columns, over the largest value.
pub fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest(one).max(f64::MIN_POSITIVE)
}
