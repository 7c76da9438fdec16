//! The likeliest values of a model whose noise is held: damped steps of Gauss and Newton along the innovations (Levenberg-Marquardt).

use nalgebra::{DMatrix, DVector};

use super::likelihood::Data;
use super::linearisation::Linearisation;
use super::model::Model;
use super::noise::Noise;
use super::range::{Range, Step};
use crate::diagnose::linalg::{dot, energy, gram};

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// No further step gains anything that counts.
    Converged,
    /// The steps that it was given were used up.
    OutOfSteps,
}

/// Gain of log likelihood below which a step no longer counts, nats.
const NEGLIGIBLE_GAIN: f64 = 0.05;

/// Tries of a damping before a step is given up, and the factors between them.
const DAMPING_TRIES: usize = 6;
const DAMPING_RAISED: f64 = 6.0;
const DAMPING_LOWERED: f64 = 0.3;

/// Longest step of a value, in steps of its range: a factor of e^1.5, or twenty sizes.
const LONGEST_RELATIVE: f64 = 1.5;
const LONGEST_ABSOLUTE: f64 = 20.0;

/// Levenberg-Marquardt over all values within their ranges, the noise held.
pub fn search_values(data: &Data<'_>, model: &Model, values: &mut Vec<f64>, noise: &Noise, steps: usize) -> Ended {
    let ranges = model.ranges();
    values.iter_mut().zip(&ranges).for_each(|(value, range)| *value = value.clamp(range.low, range.high));
    let all: Vec<usize> = (0..values.len()).collect();
    let mut damping = 1e-3;
    // Innovations at the values, of two bodies those of the step before; of one body they are taken with gains, which each step computes anew.
    let mut known = None;
    for _ in 0..steps {
        let here = Linearisation::with_base(data, model, values, noise, known.take());
        let before = data.profiled(&here.base, noise).0 + model.ln_prior(values);
        let columns = here.columns(values, &all);
        let normal = Normal::of(&columns, &here.innovations).with_priors(values, &ranges);
        let mut gained = None;
        for _ in 0..DAMPING_TRIES {
            let moved = normal.step(values, &ranges, damping);
            let passes = here.passes(&moved);
            let after = data.profiled(&passes, noise).0 + model.ln_prior(&moved);
            if after > before {
                *values = moved;
                known = model.has_link().then_some(passes);
                damping = (damping * DAMPING_LOWERED).max(1e-9);
                gained = Some(after - before);
                break;
            }
            damping *= DAMPING_RAISED;
        }
        if gained.is_none_or(|gain| gain < NEGLIGIBLE_GAIN) {
            return Ended::Converged;
        }
    }
    Ended::OutOfSteps
}

/// Normal equations of a linearised fit.
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    energy: f64,
}

impl Normal {
    fn of(columns: &[Vec<f64>], residual: &[f64]) -> Self {
        let count = columns.len();
        let right = DVector::from_fn(count, |row, _| -dot(&columns[row], residual));
        Self { matrix: gram(columns), right, energy: energy(residual) }
    }

    /// The same with what is known of `values` beforehand, each prior being one row more.
    fn with_priors(mut self, values: &[f64], ranges: &[Range]) -> Self {
        for (at, range) in ranges.iter().enumerate() {
            if let Some(prior) = range.prior {
                let slope = range.slope(values[at]) / prior.deviation;
                self.matrix[(at, at)] += slope * slope;
                self.right[at] -= slope * (values[at] - prior.mean) / prior.deviation;
            }
        }
        self
    }

    /// `values` after a damped step; a value at an end of its range that would leave it is held.
    fn step(&self, values: &[f64], ranges: &[Range], damping: f64) -> Vec<f64> {
        let mut held = vec![false; values.len()];
        for _ in 0..=values.len() {
            let free: Vec<usize> = (0..values.len()).filter(|at| !held[*at]).collect();
            let damped = |row: usize, column: usize| {
                let extra = if row == column { damping * self.matrix[(row, row)].max(1e-9 * self.energy) } else { 0.0 };
                self.matrix[(row, column)] + extra
            };
            let matrix = DMatrix::from_fn(free.len(), free.len(), |row, column| damped(free[row], free[column]));
            let right = DVector::from_fn(free.len(), |row, _| self.right[free[row]]);
            let Some(factors) = matrix.cholesky() else { return values.to_vec() };
            let steps = factors.solve(&right);
            let mut moved = values.to_vec();
            for (&at, step) in free.iter().zip(&steps) {
                let range = &ranges[at];
                let longest = if range.step == Step::Relative { LONGEST_RELATIVE } else { LONGEST_ABSOLUTE };
                let to = range.moved(values[at], step.clamp(-longest, longest));
                let leaves =
                    (values[at] <= range.low && to < values[at]) || (values[at] >= range.high && to > values[at]);
                held[at] = leaves;
                moved[at] = to.clamp(range.low, range.high);
            }
            if free.iter().all(|at| !held[*at]) {
                return moved;
            }
        }
        values.to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::range::Prior;

    #[test]
    fn a_prior_is_one_row_more() {
        let range = Range::absolute(0.0, 2.0, 0.005).known(Prior { mean: 1.0, deviation: 0.05 });
        let step = |normal: Normal| normal.step(&[1.1], &[range], 0.0)[0];
        let of_rows = || Normal::of(&[vec![2.0]], &[1.0]);
        assert!((step(of_rows()) - (1.1 - 0.5 * 0.005)).abs() < 1e-12);
        // A second row: a tenth of a deviation a step, two deviations off.
        let both = Normal::of(&[vec![2.0, 0.1]], &[1.0, 2.0]);
        assert!((step(of_rows().with_priors(&[1.1], &[range])) - step(both)).abs() < 1e-12);
        assert!((range.ln_prior(1.1) + 2.0).abs() < 1e-12);
    }
}
