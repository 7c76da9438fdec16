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
        if let Some(next) = self.after(o, gain, innovation, forgetting) {
            *self = next;
        }
    }

    /// As [`Self::advance`] leaves it; `None` where that is beyond the range of single precision and is not taken.
    #[inline(always)]
    fn after(&self, o: &Observation, gain: Impedance, innovation: f32, forgetting: f32) -> Option<Self> {
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
        next.is_finite().then_some(next)
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
        // B has not been separated from K yet, or nothing has been observed.
        let alone = b.stiffness == 0.0 && k.damping == 0.0 && k_done != 0.0;
        let stiffness = if alone { k.stiffness * way.stiffness / k_done } else { f32::INFINITY };
        Impedance { stiffness, damping: f32::INFINITY }
    }

    /// Takes the update that has led from `o` to `estimate`, and tells its outcome.
    #[inline(always)]
    pub(crate) fn advance_to(
        &mut self,
        estimate: Impedance,
        o: &Observation,
        gain: Impedance,
        innovation: f32,
        forgetting: f32,
        flags: Flags,
    ) -> Step {
        match self.after(o, gain, innovation, forgetting) {
            Some(next) => {
                *self = next;
                // Of what is at hand, and not of what was stored.
                next.step(estimate, innovation, forgetting, flags)
            }
            None => self.step_unmoved(estimate, innovation, forgetting, flags),
        }
    }

    /// [`Self::step`], apart: as one of two ways to the same numbers it would cost the other a move of each.
    #[cold]
    #[inline(never)]
    fn step_unmoved(&self, estimate: Impedance, innovation: f32, forgetting: f32, flags: Flags) -> Step {
        self.step(estimate, innovation, forgetting, flags)
    }

    /// Share of the memory of `forgetting` that is filled.
    #[inline(always)]
    pub(crate) fn fill(&self, forgetting: f32) -> f32 {
        smaller(self.weight * (1.0 - forgetting), 1.0)
    }

    /// The outcome of the update that has just advanced it and led to `estimate`.
    #[inline(always)]
    pub(crate) fn step(&self, estimate: Impedance, innovation: f32, forgetting: f32, flags: Flags) -> Step {
        Step {
            estimate,
            innovation,
            confidence: self.confidence(estimate),
            fill: self.fill(forgetting),
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

#[cfg(test)]
mod tests {
    use super::*;

    type Matrix = [[f64; 2]; 2];

    fn pair(stiffness: f32, damping: f32) -> Impedance {
        Impedance { stiffness, damping }
    }

    fn product(a: Matrix, b: Matrix) -> Matrix {
        core::array::from_fn(|i| core::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
    }

    fn transposed(m: Matrix) -> Matrix {
        [[m[0][0], m[1][0]], [m[0][1], m[1][1]]]
    }

    fn sum(a: Matrix, b: Matrix, factor: f64) -> Matrix {
        core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + factor * b[i][j]))
    }

    fn outer(a: [f64; 2]) -> Matrix {
        a.map(|row| a.map(|column| row * column))
    }

    fn full(m: Sym2) -> Matrix {
        [[m.xx, m.xv], [m.xv, m.vv]].map(|row| row.map(f64::from))
    }

    fn rows(m: [Impedance; 2]) -> Matrix {
        m.map(|row| [row.stiffness, row.damping].map(f64::from))
    }

    /// In the middle of a run, every number different and a short sum of powers of two, so that single precision is exact.
    fn midway() -> UncertaintyPropagation {
        UncertaintyPropagation {
            start: pair(3.0, -1.5),
            transition: [pair(0.5, 0.25), pair(-0.125, 0.75)],
            noise: Sym2 { xx: 2.0, xv: -0.5, vv: 1.25 },
            noise_gain: Sym2 { xx: 4.0, xv: 0.75, vv: 1.5 },
            offset_gain: pair(-0.25, 2.0),
            regressors: Sym2 { xx: 8.0, xv: -1.0, vv: 2.5 },
            weight: 20.0,
        }
    }

    /// `M <- A M`, `N <- A N A' + e g g'`, `o <- A o + g`, `R <- lambda R + phi phi'` in double precision and as matrices,
    /// with `A = I - g phi'` and e the innovation times the residual.
    #[test]
    fn an_update_is_the_recursion_of_its_matrices() {
        for (gain, square) in [([0.5, 0.75], 9.0 * 0.9375), ([3.0, -2.0], 9.0 * 1.0)] {
            let (phi, innovation, forgetting) = ([0.5, -0.25], -3.0, 0.75);
            let map = sum([[1.0, 0.0], [0.0, 1.0]], gain.map(|g| phi.map(|p| g * p)), -1.0);
            let before = midway();
            let mut after = before;
            let row = Observation { penetration: 0.5, rate: -0.25, force: 0.0 };
            after.advance(&row, pair(gain[0] as f32, gain[1] as f32), innovation, forgetting);
            let propagated = |m: Sym2| product(product(map, full(m)), transposed(map));
            assert_eq!(rows(after.transition), product(map, rows(before.transition)));
            assert_eq!(full(after.noise), sum(propagated(before.noise), outer(gain), square));
            assert_eq!(full(after.noise_gain), sum(propagated(before.noise_gain), outer(gain), 1.0));
            let offset = [f64::from(before.offset_gain.stiffness), f64::from(before.offset_gain.damping)];
            let moved: [f64; 2] = core::array::from_fn(|i| map[i][0] * offset[0] + map[i][1] * offset[1] + gain[i]);
            assert_eq!([after.offset_gain.stiffness, after.offset_gain.damping].map(f64::from), moved);
            assert_eq!(full(after.regressors), sum(outer(phi), full(before.regressors), 0.75));
            assert_eq!((after.weight, after.start), (16.0, before.start));
        }
    }

    #[test]
    fn an_update_that_leaves_the_range_is_not_taken() {
        let row = Observation { penetration: 0.5, rate: -0.25, force: 0.0 };
        for (gain, innovation) in [
            (pair(f32::INFINITY, 0.5), 1.0),
            (pair(0.5, f32::NAN), 1.0),
            (pair(0.5, 0.5), f32::INFINITY),
            (pair(0.5, 0.5), f32::MAX),
        ] {
            let mut state = midway();
            state.advance(&row, gain, innovation, 0.75);
            assert_eq!(state, midway(), "{gain:?}, {innovation}");
        }
    }

    /// The state all of whose numbers are zero but those at `places`, which are `value`.
    fn with(places: &[usize], value: f32) -> UncertaintyPropagation {
        let at = |place: usize| if places.contains(&place) { value } else { 0.0 };
        let sym = |place: usize| Sym2 { xx: at(place), xv: at(place + 1), vv: at(place + 2) };
        UncertaintyPropagation {
            start: Impedance::ZERO,
            transition: [pair(at(0), at(1)), pair(at(2), at(3))],
            offset_gain: pair(at(4), at(5)),
            noise: sym(6),
            noise_gain: sym(9),
            regressors: sym(12),
            weight: 0.0,
        }
    }

    #[test]
    fn a_state_is_finite_where_the_sum_of_its_numbers_is() {
        let all: [usize; 15] = core::array::from_fn(|place| place);
        assert!(with(&all, 1e30).is_finite());
        for one in all {
            assert!(with(&[one], 3e38).is_finite(), "{one}");
            assert!(!with(&[one], f32::INFINITY).is_finite() && !with(&[one], f32::NAN).is_finite(), "{one}");
            for other in all.into_iter().filter(|other| *other != one) {
                assert!(!with(&[one, other], 3e38).is_finite(), "{one} and {other}");
            }
        }
    }

    #[test]
    fn the_confidence_is_widened_by_what_has_not_been_told_of_the_start() {
        let state = UncertaintyPropagation { transition: [pair(0.5, 0.0), pair(0.0, 0.75)], ..midway() };
        let found = state.confidence(pair(1.0, 2.5));
        // Factors 1 / (1 - 0.5) and 1 / (1 - 0.75), for each side of the matrix.
        assert_eq!(found.noise, Sym2 { xx: 8.0, xv: -4.0, vv: 20.0 });
        assert_eq!(found.noise_gain, Sym2 { xx: 16.0, xv: 6.0, vv: 24.0 });
        assert_eq!((found.offset_gain, found.samples), (state.offset_gain, 20.0));
        // M (I - M)^-1 (start - estimate), of (2, -4).
        assert_eq!(found.startup_bias, pair(2.0, -12.0));
    }

    /// `M (I - M)^-1 d` by Cramer's rule in double precision.
    fn bias(m: Matrix, d: [f64; 2]) -> [f64; 2] {
        let left = sum([[1.0, 0.0], [0.0, 1.0]], m, -1.0);
        let determinant = left[0][0] * left[1][1] - left[0][1] * left[1][0];
        let at_start = [
            (left[1][1] * d[0] - left[0][1] * d[1]) / determinant,
            (left[0][0] * d[1] - left[1][0] * d[0]) / determinant,
        ];
        core::array::from_fn(|i| m[i][0] * at_start[0] + m[i][1] * at_start[1])
    }

    #[test]
    fn the_bias_of_the_start_follows_from_how_far_the_estimate_has_moved() {
        let found = midway().startup_bias(pair(1.0, 2.5));
        let expected = bias(rows(midway().transition), [2.0, -4.0]);
        for (found, expected) in [(found.stiffness, expected[0]), (found.damping, expected[1])] {
            assert!((f64::from(found) / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn where_the_parameters_are_not_told_apart_the_bias_is_not_known() {
        let of = |transition| UncertaintyPropagation { transition, ..midway() }.startup_bias(pair(1.0, 2.5));
        let unknown = pair(f32::INFINITY, f32::INFINITY);
        assert_eq!(of([pair(1.0, 0.0), pair(0.0, 1.0)]), unknown, "nothing has been observed");
        // Of K alone: 0.5 / (1 - 0.5) of (3 - 1), and 0.75 / (1 - 0.75).
        assert_eq!(of([pair(0.5, 0.0), pair(0.0, 1.0)]), pair(2.0, f32::INFINITY));
        assert_eq!(of([pair(0.75, 0.0), pair(0.0, 1.0)]), pair(6.0, f32::INFINITY));
        assert_eq!(of([pair(0.5, 0.25), pair(0.0, 1.0)]), unknown, "K rests on B");
        assert_eq!(of([pair(0.5, 0.0), pair(0.25, 1.0)]), unknown, "B rests on K");
        // The determinant of I - M as a share of its terms: 2^-17 is rounding, 2^-16 is not.
        let nearly = |share: f32| of([pair(0.0, 1.0 - share), pair(1.0, 0.0)]);
        assert_eq!(nearly(1.0 / 131_072.0), unknown);
        assert!(nearly(1.0 / 65_536.0).is_finite());
        let smaller_terms = |share: f32| of([pair(0.75, 0.25 * (1.0 - share)), pair(0.25, 0.75)]);
        assert_eq!(smaller_terms(1.0 / 131_072.0), unknown);
        assert!(smaller_terms(1.0 / 65_536.0).is_finite());
        let larger_terms = |share: f32| of([pair(-7.0, 8.0 * (1.0 - share)), pair(8.0, -7.0)]);
        assert_eq!(larger_terms(1.0 / 131_072.0), unknown);
        assert!(larger_terms(1.0 / 65_536.0).is_finite());
        // A determinant below zero is as good as one above.
        assert!(of([pair(0.0, 2.0), pair(1.0, 0.0)]).is_finite());
    }

    #[test]
    fn fill_and_excitation_are_those_of_the_weighted_samples() {
        for (weight, fill) in [(0.0, 0.0), (2.0, 0.5), (4.0, 1.0), (5.0, 1.0)] {
            let state = UncertaintyPropagation { weight, ..midway() };
            let step = state.step(pair(1.0, 2.5), -0.5, 0.75, Flags::RESET);
            assert_eq!((step.fill, step.innovation, step.flags), (fill, -0.5, Flags::RESET));
            assert_eq!((step.estimate, step.excitation), (pair(1.0, 2.5), 1.0 - 1.0 / 20.0));
        }
    }
}
