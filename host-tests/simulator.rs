//! Contacts with a known answer: a tool that is driven into a surface, seen through coarse sensors.

use palpate::Sample;
use std::f64::consts::TAU;

/// A generator of our own, so that a seed means the same numbers for ever (splitmix64).
#[derive(Debug, Clone)]
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of mean zero and variance one.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

/// The material: K and B as functions of the time since the contact began.
pub type Material = fn(f64) -> (f64, f64);

/// One simulated trial; the defaults are the paper's bench.
#[derive(Debug, Clone)]
pub struct Trial {
    pub name: &'static str,
    pub material: Material,
    pub seconds: f64,
    /// Contact from here on, of every `cycle` seconds.
    pub free: f64,
    pub cycle: f64,
    pub depth: f64,
    pub dither: f64,
    pub dither_hz: f64,
    pub force_noise: f64,
    pub position_count: f64,
    pub force_count: f64,
    /// Where the surface really is; the estimator believes it at zero.
    pub surface: f64,
}

impl Trial {
    pub fn bench(name: &'static str, material: Material) -> Self {
        Self {
            name,
            material,
            seconds: 6.0,
            free: 0.5,
            cycle: 3.0,
            depth: 13.5e-3,
            dither: 3.3e-3,
            dither_hz: 10.0,
            force_noise: 0.09,
            position_count: 1e-4,
            force_count: 0.05,
            surface: 0.0,
        }
    }

    /// The five environments of the parity tests.
    pub fn environments() -> [Self; 5] {
        let ideal = Self::bench("K 300, B 5", |_| (300.0, 5.0));
        [
            Self { position_count: 0.0, force_count: 0.0, ..ideal },
            Self::bench("K 300, B 5, coarse", |_| (300.0, 5.0)),
            Self::bench("K 250, 900, 250", |t| (if (0.8..1.6).contains(&t) { 900.0 } else { 250.0 }, 5.0)),
            Self { depth: 3e-3, dither: 1e-3, ..Self::bench("K 3000, B 6", |_| (3000.0, 6.0)) },
            Self::bench("bubble wrap", |t| (225.0 * (1.0 + (-t).exp()), 2.0 * (1.0 + (-t).exp()))),
        ]
    }

    /// The samples of `seed` at 1 kHz.
    pub fn samples(&self, seed: u64) -> Vec<Sample> {
        let mut noise = Noise::new(seed);
        let mut since_onset = 0.0;
        let path = self.path();
        // Half a step before and after: the velocity is that of the sample's own instant.
        path.windows(3)
            .step_by(2)
            .map(|around| {
                let (x, v) = (around[1] - self.surface, (around[2] - around[0]) / 1e-3);
                since_onset = if x < -2e-3 { 0.0 } else { since_onset + 1e-3 };
                let (k, b) = (self.material)(since_onset);
                let force = if x >= 0.0 { k * x + b * v } else { 0.0 };
                Sample {
                    position: rounded(around[1], self.position_count) as f32,
                    force: rounded(force + self.force_noise * noise.normal(), self.force_count) as f32,
                    elapsed: 1e-3,
                }
            })
            .collect()
    }

    /// Positions every half millisecond.
    fn path(&self) -> Vec<f64> {
        let (mut stage, mut push) = (-15e-3_f64, -15e-3_f64);
        let count = (self.seconds * 2e3) as usize;
        (0..=count)
            .map(|k| {
                let t = k as f64 * 5e-4;
                let target = if t % self.cycle < self.free { -15e-3 } else { self.depth };
                // Two first-order lags of 0.1 s make of the square wave what a drive can follow.
                stage += 0.005 * (target - stage);
                push += 0.005 * (stage - push);
                push + self.dither * (TAU * self.dither_hz * t).sin()
            })
            .collect()
    }
}

fn rounded(value: f64, count: f64) -> f64 {
    if count > 0.0 { (value / count).round() * count } else { value }
}
