//! Propagation of the uncertainty of a recursive law from update to update.

use crate::contact::{Impedance, Observation};
use crate::math::smaller;
use crate::math::sym2::Sym2;
use crate::quality::confidence::Confidence;
use crate::quality::flags::Flags;
use crate::quality::step::Step;

/// Forgetting factor for fill and excitation in a law that has none of its own: a transition of 300 samples.
pub(crate) const DEFAULT_FORGETTING: f32 = 1.0 - 1.0 / 300.0;

/// Propagates the uncertainty of any law of the form `theta += gain * innovation`.
///
/// The error of the estimate obeys `error = (I - gain phi') error + gain noise`, whatever the gain is. So what is left of
/// the error at the start is `M error(0)` with M the product of these maps, and its variance from noise (each sample's own,
/// so a stretch that fits badly is remembered for as long as the estimate rests on it) and its response to a constant
/// offset follow exactly: for least squares with and without forgetting, self-perturbation or resets, and for a
/// constant gain alike. M also gives the initial error from how far the estimate has moved:
/// `(I - M) error(0) = start - estimate`. No prior knowledge of the contact is needed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncertaintyPropagation {
    start: Impedance,
    /// M, by rows.
    transition: [Impedance; 2],
    noise: Sym2,
    noise_gain: Sym2,
    offset_gain: Impedance,
    regressors: Sym2,
    weight: f32,
}

impl UncertaintyPropagation {
    /// Before the first sample, with the estimate at `start`.
    pub const fn new(start: Impedance) -> Self {
        Self {
            start,
            transition: [Impedance { stiffness: 1.0, damping: 0.0 }, Impedance { stiffness: 0.0, damping: 1.0 }],
            noise: Sym2::ZERO,
            noise_gain: Sym2::ZERO,
            offset_gain: Impedance::ZERO,
            regressors: Sym2::ZERO,
            weight: 0.0,
        }
    }

    /// Takes the gain and innovation of one update. `forgetting`, below 1, sets over how many samples the excitation is
    /// measured and the samples are counted.
    #[inline(always)]
    pub fn advance(&mut self, o: &Observation, gain: Impedance, innovation: f32, forgetting: f32) {
        let (x, v) = (o.penetration, o.rate);
        let map = [
            Impedance { stiffness: 1.0 - gain.stiffness * x, damping: -gain.stiffness * v },
            Impedance { stiffness: -gain.damping * x, damping: 1.0 - gain.damping * v },
        ];
        let [to_stiffness, to_damping] = map;
        // Innovation times residual, the increment of the least-squares cost: between them lies the noise.
        let square = innovation * innovation * (1.0 - x * gain.stiffness - v * gain.damping).abs();
        let next = Self {
            start: self.start,
            transition: map.map(|row| combine(row, self.transition)),
            noise: congruence(map, self.noise).plus_outer(square, gain.stiffness, gain.damping),
            noise_gain: congruence(map, self.noise_gain).plus_outer(1.0, gain.stiffness, gain.damping),
            offset_gain: Impedance {
                stiffness: dot(to_stiffness, self.offset_gain) + gain.stiffness,
                damping: dot(to_damping, self.offset_gain) + gain.damping,
            },
            regressors: self.regressors.scaled(forgetting).plus_outer(1.0, x, v),
            weight: forgetting * self.weight + 1.0,
        };
        if next.is_finite() {
            *self = next;
        }
    }

    /// By their sum, which is finite only where each is; and a sum beyond the range is as good as a sign of that.
    fn is_finite(&self) -> bool {
        let [k, b] = self.transition;
        let pairs = k.moved(1.0, b).moved(1.0, self.offset_gain);
        let total = |m: Sym2| m.xx + m.xv + m.vv;
        let sums = total(self.noise) + total(self.noise_gain) + total(self.regressors);
        (pairs.stiffness + pairs.damping + sums).is_finite()
    }

    /// The confidence in `estimate`, which the updates have led to.
    #[inline(always)]
    pub fn confidence(&self, estimate: Impedance) -> Confidence {
        let [k, b] = self.transition;
        // The initial error is itself estimated from noisy data, divided by I - M: the bias that remains inherits that factor.
        let (k_told, b_told) = (1.0 / (1.0 - k.stiffness), 1.0 / (1.0 - b.damping));
        Confidence {
            noise: self.noise.stretched(k_told, b_told),
            noise_gain: self.noise_gain.stretched(k_told, b_told),
            startup_bias: self.startup_bias(estimate),
            offset_gain: self.offset_gain,
            samples: self.weight,
        }
    }

    /// `M (I - M)^-1 (start - estimate)`; infinite where the estimate has not begun to move.
    fn startup_bias(&self, estimate: Impedance) -> Impedance {
        let [k, b] = self.transition;
        let way = self.start.moved(-1.0, estimate);
        let (k_done, b_done) = (1.0 - k.stiffness, 1.0 - b.damping);
        let crossed = k.damping * b.stiffness;
        let independence = k_done * b_done - crossed;
        // Below this share of its terms the determinant is rounding.
        if independence.abs() > 1e-5 * (k_done * b_done).abs() {
            let at_start = Impedance {
                stiffness: (way.stiffness * b_done + k.damping * way.damping) / independence,
                damping: (way.damping * k_done + b.stiffness * way.stiffness) / independence,
            };
            return Impedance { stiffness: dot(k, at_start), damping: dot(b, at_start) };
        }
        // B has not been told from K yet, or nothing has been told.
        let alone = b.stiffness == 0.0 && k.damping == 0.0 && k_done != 0.0;
        let stiffness = if alone { k.stiffness * way.stiffness / k_done } else { f32::INFINITY };
        Impedance { stiffness, damping: f32::INFINITY }
    }

    /// The outcome of the update that has just advanced it and led to `estimate`.
    #[inline(always)]
    pub(crate) fn step(&self, estimate: Impedance, innovation: f32, forgetting: f32, flags: Flags) -> Step {
        Step {
            estimate,
            innovation,
            confidence: self.confidence(estimate),
            fill: smaller(self.weight * (1.0 - forgetting), 1.0),
            excitation: self.regressors.independence(),
            flags,
        }
    }
}

fn dot(row: Impedance, column: Impedance) -> f32 {
    row.stiffness * column.stiffness + row.damping * column.damping
}

/// `row * matrix`.
fn combine(row: Impedance, matrix: [Impedance; 2]) -> Impedance {
    let [upper, lower] = matrix;
    Impedance {
        stiffness: row.stiffness * upper.stiffness + row.damping * lower.stiffness,
        damping: row.stiffness * upper.damping + row.damping * lower.damping,
    }
}

/// `map * m * map'`.
fn congruence(map: [Impedance; 2], m: Sym2) -> Sym2 {
    let [k, b] = map;
    let (to_k, to_b) = (m.times(k), m.times(b));
    Sym2 { xx: dot(k, to_k), xv: dot(b, to_k), vv: dot(b, to_b) }
}
