//! A contact for as long as one likes.

use crate::simulator::Noise;
use palpate::Observation;

/// The dithered contact of the bench, on a material whose K jumps.
pub struct Contact {
    noise: Noise,
    stiffness: f64,
    every: usize,
    taken: usize,
}

impl Contact {
    /// K jumps every `every` samples.
    pub fn new(seed: u64, every: usize) -> Self {
        Self { noise: Noise::new(seed), stiffness: 300.0, every, taken: 0 }
    }
}

impl Iterator for Contact {
    type Item = Observation;

    fn next(&mut self) -> Option<Observation> {
        self.taken += 1;
        if self.taken.is_multiple_of(self.every) {
            self.stiffness = [250.0, 900.0, 300.0, 1800.0][(self.noise.bits() % 4) as usize];
        }
        let phase = 62.831_853e-3 * self.taken as f64;
        let (x, v) = (0.010 + 0.0033 * phase.sin(), 0.2073 * phase.cos());
        let force = self.stiffness * x + 5.0 * v + 0.09 * self.noise.normal();
        Some(Observation { penetration: x as f32, rate: v as f32, force: force as f32 })
    }
}
