//! Random numbers that a seed fixes for good.

use rand::{RngExt, SeedableRng};

/// The generator of every draw.
pub type Chance = rand_chacha::ChaCha8Rng;

/// What is drawn from one case's seed: each its own stream, so that a choice in one leaves the others alone.
#[derive(Debug, Clone, Copy)]
pub enum Stream {
    /// What the case is about.
    Plan,
    /// The rig's values.
    Rig,
    /// The trajectories.
    Reference,
    /// The effects' shapes.
    Shape,
    /// The sensors' noise.
    Noise,
}

/// The generator of `stream` in case `index` of `seed`.
#[must_use]
pub fn stream(seed: u64, index: u64, stream: Stream) -> Chance {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&index.to_le_bytes());
    let mut chance = Chance::from_seed(key);
    chance.set_stream(stream as u64);
    chance
}

/// Between `low` and `high`, each decade as likely as any other.
pub fn log_uniform(chance: &mut Chance, low: f64, high: f64) -> f64 {
    chance.random_range(low.ln()..=high.ln()).exp()
}

/// One of `all`, which must hold something.
pub fn pick<T: Copy>(chance: &mut Chance, all: &[T]) -> T {
    all[chance.random_range(0..all.len())]
}

/// Plus or minus one.
pub fn sign(chance: &mut Chance) -> f64 {
    if chance.random_bool(0.5) { 1.0 } else { -1.0 }
}
