//! Weighted least squares of a contact's law: Levenberg's and Marquardt's method with bounds and priors.

use nalgebra::{DMatrix, DVector};

use super::data::Data;
use super::model::ContactModel;
use super::range::Range;
use crate::diagnose::linalg::{dot, energy, gram};

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What was fitted.
    pub model: ContactModel,
    /// Its values.
    pub values: Vec<f64>,
    /// Squares of the weighted residual, and of the values' distance from their priors.
    pub energy: f64,
}

/// How long a search may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort(pub usize);

impl Effort {
    /// None: the values stay.
    pub const NONE: Self = Self(0);
    /// Enough to compare one start with another.
    pub const QUICK: Self = Self(4);
    /// To the end.
    pub const FULL: Self = Self(30);
}

/// Part of the residual's energy below which a step no longer counts.
const NEGLIGIBLE_PART: f64 = 1e-4;

/// Tries of a damping before the search ends, and the factors between them.
const DAMPING_TRIES: usize = 6;
const DAMPING_RAISED: f64 = 6.0;
const DAMPING_LOWERED: f64 = 0.25;

/// Longest step of a value that moves by factors, and of another, in sizes.
const LONGEST_FACTOR: f64 = 1.0;
const LONGEST_STEP: f64 = 30.0;

impl Data<'_> {
    /// `start` fitted; values that `held` names stay.
    #[must_use]
    pub fn fit_holding(
        &self,
        model: &ContactModel,
        start: &[f64],
        effort: Effort,
        held: &dyn Fn(usize) -> bool,
    ) -> Fit {
        let mut values = start.to_vec();
        for (value, range) in values.iter_mut().zip(model.ranges(start)) {
            *value = value.max(range.low).min(range.high);
        }
        let mut base = self.weighted_residual(model, &values);
        let mut cost = energy(&base) + prior_energy(&model.ranges(&values), &values);
        let mut damping = 1e-3;
        for _ in 0..effort.0 {
            let ranges = model.ranges(&values);
            let free: Vec<usize> = (0..values.len()).filter(|at| ranges[*at].free && !held(*at)).collect();
            let normal =
                Normal::of(&self.columns(model, &values, &ranges, &free, &base), &base, &ranges, &free, &values);
            let mut gained = 0.0;
            for _ in 0..DAMPING_TRIES {
                let moved = normal.step(&values, &ranges, &free, damping);
                let after = self.weighted_residual(model, &moved);
                let there = energy(&after) + prior_energy(&ranges, &moved);
                if there < cost {
                    gained = cost - there;
                    (values, base, cost) = (moved, after, there);
                    damping = (damping * DAMPING_LOWERED).max(1e-9);
                    break;
                }
                damping *= DAMPING_RAISED;
            }
            if gained <= NEGLIGIBLE_PART * cost {
                break;
            }
        }
        let cost = if cost.is_finite() { cost } else { f64::INFINITY };
        Fit { model: model.clone(), values, energy: cost }
    }

    /// `start` fitted, an instant or a height at which the law jumps wherever it leaves least.
    #[must_use]
    pub fn fit(&self, model: &ContactModel, start: &[f64], effort: Effort) -> Fit {
        self.with_jumps(self.fit_holding(model, start, effort, &|_| false), effort)
    }

    /// `fit` under these weights, its search continued from where it ended.
    #[must_use]
    pub fn again(&self, fit: &Fit) -> Fit {
        self.fit(&fit.model, &fit.values, Effort::FULL)
    }
}

fn prior_energy(ranges: &[Range], values: &[f64]) -> f64 {
    let each = ranges.iter().zip(values).filter_map(|(range, value)| {
        let (mean, deviation) = range.prior.filter(|_| range.free)?;
        Some(((value - mean) / deviation).powi(2))
    });
    each.sum()
}

/// Normal equations of a linearised fit.
pub(super) struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    /// Those of `residual` with its derivatives `columns` by one step of each value in `free`.
    pub(super) fn of(columns: &[Vec<f64>], residual: &[f64], ranges: &[Range], free: &[usize], values: &[f64]) -> Self {
        let count = columns.len();
        let mut matrix = gram(columns);
        let mut right = DVector::from_fn(count, |row, _| -dot(&columns[row], residual));
        for (row, &at) in free.iter().enumerate() {
            if let Some((mean, deviation)) = ranges[at].prior {
                let step = ranges[at].size / deviation;
                matrix[(row, row)] += step * step;
                right[row] -= step * (values[at] - mean) / deviation;
            }
        }
        Self { matrix, right }
    }

    /// `values` after a damped step; a value at an end of its range that would leave it is held.
    pub(super) fn step(&self, values: &[f64], ranges: &[Range], free: &[usize], damping: f64) -> Vec<f64> {
        let mut held = vec![false; free.len()];
        for _ in 0..=free.len() {
            let open: Vec<usize> = (0..free.len()).filter(|nth| !held[*nth]).collect();
            let least = 1e-12 * self.matrix.diagonal().max();
            let damped = |row: usize, column: usize| {
                let extra = if row == column { damping * self.matrix[(row, row)] + least } else { 0.0 };
                self.matrix[(row, column)] + extra
            };
            let matrix = DMatrix::from_fn(open.len(), open.len(), |row, column| damped(open[row], open[column]));
            let right = DVector::from_fn(open.len(), |row, _| self.right[open[row]]);
            let Some(factors) = matrix.cholesky() else { return values.to_vec() };
            let steps = factors.solve(&right);
            let mut moved = values.to_vec();
            for (&nth, step) in open.iter().zip(&steps) {
                let (at, range) = (free[nth], &ranges[free[nth]]);
                let longest = if range.by_factors { LONGEST_FACTOR } else { LONGEST_STEP };
                let to = range.moved(values[at], step.max(-longest).min(longest));
                held[nth] =
                    (values[at] <= range.low && to < values[at]) || (values[at] >= range.high && to > values[at]);
                moved[at] = to.max(range.low).min(range.high);
            }
            if open.iter().all(|nth| !held[*nth]) {
                return moved;
            }
        }
        values.to_vec()
    }
}
