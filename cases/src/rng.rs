//! Random numbers, each stream fixed by seed and case index.

use rand::{RngExt, SeedableRng};

/// The generator of every draw.
pub type CaseRng = rand_chacha::ChaCha8Rng;

/// What is drawn from one case's seed: each its own stream, so that a choice in one leaves the others alone.
#[derive(Debug, Clone, Copy)]
pub enum Stream {
    /// What the case is about.
    Spec,
    /// The rig's values.
    Rig,
    /// The trajectories.
    Excitation,
    /// The effects' shapes.
    Effect,
    /// The sensors' noise.
    Noise,
}

/// The generator of `stream` in case `index` of `seed`.
#[must_use]
pub fn stream(seed: u64, index: u64, stream: Stream) -> CaseRng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&index.to_le_bytes());
    let mut rng = CaseRng::from_seed(key);
    rng.set_stream(stream as u64);
    rng
}

/// Between `low` and `high`, each decade as likely as any other.
pub fn log_uniform(rng: &mut CaseRng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..=high.ln()).exp()
}

/// One of `all`, which must hold something.
pub fn pick<T: Copy>(rng: &mut CaseRng, all: &[T]) -> T {
    all[rng.random_range(0..all.len())]
}

/// Plus or minus one.
pub fn sign(rng: &mut CaseRng) -> f64 {
    if rng.random_bool(0.5) { 1.0 } else { -1.0 }
}
