//! How sure an estimate is, and how that is carried along by a recursive law.

use crate::contact::{Impedance, Observation};
use crate::math::smaller;
use crate::sym2::Sym2;

/// The parts of the uncertainty of one estimate, in internal units.
///
/// The variance of the estimate is `noise_variance * c * noise_gain + transient`, c being the number of samples that one
/// independent value of the noise is worth; beside it stand two errors that averaging does not reduce, `remainder` and
/// `offset_gain` times the force that a misplaced surface makes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confidence {
    /// Mean square of the residual.
    pub noise_variance: f32,
    /// Variance of the estimate for white noise of variance one.
    pub noise_gain: Sym2,
    /// Variance that is left of the ignorance at the start.
    pub transient: Sym2,
    /// How far, at most, an iterative law still is from what it moves towards.
    pub remainder: Impedance,
    /// Change of the estimate for a constant force of one unit.
    pub offset_gain: Impedance,
    /// Samples that the estimate rests on, by weight.
    pub samples: f32,
}

impl Confidence {
    /// Nothing is known.
    pub const NONE: Self = Self {
        noise_variance: 0.0,
        noise_gain: Sym2::UNKNOWN,
        transient: Sym2::ZERO,
        remainder: Impedance::ZERO,
        offset_gain: Impedance::ZERO,
        samples: 0.0,
    };
}

/// How wrong the estimate may be before the first sample: one standard deviation of K and B about zero.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ignorance {
    /// Of K, internal units (the bench: 1000 N/m).
    pub stiffness: f32,
    /// Of B, internal units (the bench: 30 N s/m).
    pub damping: f32,
}

impl Default for Ignorance {
    fn default() -> Self {
        Self { stiffness: 1000.0, damping: 30.0 }
    }
}

/// Propagates the uncertainty of any law of the form `theta += gain * innovation`.
///
/// The error of the estimate obeys `error = (I - gain phi') error - gain noise`, whatever the gain is; so its variance
/// from noise, its memory of the start and its response to a constant offset all follow exactly, for least squares with
/// and without forgetting, self-perturbation or resets, and for a constant gain alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propagation {
    transient: Sym2,
    noise_gain: Sym2,
    offset_gain: Impedance,
    regressors: Sym2,
    residual_energy: f32,
    weight: f32,
}

impl Propagation {
    /// Before the first sample.
    pub const fn new(ignorance: Ignorance) -> Self {
        Self {
            transient: Sym2::diagonal(ignorance.stiffness * ignorance.stiffness, ignorance.damping * ignorance.damping),
            noise_gain: Sym2::ZERO,
            offset_gain: Impedance::ZERO,
            regressors: Sym2::ZERO,
            residual_energy: 0.0,
            weight: 0.0,
        }
    }

    /// Takes the gain and innovation of one update. `forgetting`, below 1, sets over how many samples the noise is
    /// measured.
    pub fn advance(&mut self, o: &Observation, gain: Impedance, innovation: f32, forgetting: f32) {
        let (x, v) = (o.penetration, o.rate);
        let map = [[1.0 - gain.stiffness * x, -gain.stiffness * v], [-gain.damping * x, 1.0 - gain.damping * v]];
        let noise = congruence(map, self.noise_gain).plus_outer(1.0, gain.stiffness, gain.damping);
        let offset = self.offset_gain;
        let next = Self {
            transient: congruence(map, self.transient),
            noise_gain: noise,
            offset_gain: Impedance {
                stiffness: map[0][0] * offset.stiffness + map[0][1] * offset.damping + gain.stiffness,
                damping: map[1][0] * offset.stiffness + map[1][1] * offset.damping + gain.damping,
            },
            regressors: self.regressors.scaled(forgetting).plus_outer(1.0, x, v),
            // Innovation times residual is the increment of the least-squares cost.
            residual_energy: forgetting * self.residual_energy
                + (innovation * innovation * (1.0 - x * gain.stiffness - v * gain.damping)).abs(),
            weight: forgetting * self.weight + 1.0,
        };
        if next.is_finite() {
            *self = next;
        }
    }

    fn is_finite(&self) -> bool {
        self.transient.is_finite()
            && self.noise_gain.is_finite()
            && self.offset_gain.is_finite()
            && self.regressors.is_finite()
            && self.residual_energy.is_finite()
    }

    /// The confidence now.
    pub fn confidence(&self) -> Confidence {
        Confidence {
            noise_variance: if self.weight > 0.0 { self.residual_energy / self.weight } else { 0.0 },
            noise_gain: self.noise_gain,
            transient: self.transient,
            remainder: Impedance::ZERO,
            offset_gain: self.offset_gain,
            samples: self.weight,
        }
    }

    /// Independence of penetration and rate over the memory.
    pub fn excitation(&self) -> f32 {
        self.regressors.independence()
    }

    /// Share of the memory that is filled.
    pub fn fill(&self, forgetting: f32) -> f32 {
        smaller(self.weight * (1.0 - forgetting), 1.0)
    }
}

/// `map * m * map'`, a sum of squares on its diagonal, so positive entries stay positive.
fn congruence(map: [[f32; 2]; 2], m: Sym2) -> Sym2 {
    let [[a, b], [c, d]] = map;
    let (ax, av) = (a * m.xx + b * m.xv, a * m.xv + b * m.vv);
    let (cx, cv) = (c * m.xx + d * m.xv, c * m.xv + d * m.vv);
    Sym2 { xx: ax * a + av * b, xv: ax * c + av * d, vv: cx * c + cv * d }
}
