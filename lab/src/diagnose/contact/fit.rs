//! Weighted least squares of a contact's law: Levenberg's and Marquardt's method with bounds and priors.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::colour::noise_power;
use super::criteria::NOTABLE_POWER;
use super::model::{ContactModel, Range};
use super::trial::ContactTrial;
use super::variance::{law_variance, noise_along, noise_scale};
use crate::diagnose::linalg::{dot, energy};

/// The trials that a model is fitted to, and what each row is worth.
#[derive(Debug, Clone)]
pub struct Data<'a> {
    /// Every trial.
    pub trials: &'a [ContactTrial],
    /// Variance that sensors and the motion's uncertainty give each row of each trial, N^2 or (N m)^2.
    pub noise: Vec<Vec<f64>>,
    /// One over the deviation that is expected of each row; zero where a row does not count.
    pub weights: Vec<Vec<f64>>,
    /// Whether the sensors' noise is as their figures say; else it is what the law leaves that the rows were weighed by.
    pub noise_is_as_stated: bool,
}

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
    /// Enough to compare one start with another.
    pub const QUICK: Self = Self(4);
    /// To the end.
    pub const FULL: Self = Self(30);
}

/// Part of the residual's energy below which a step no longer counts.
const NEGLIGIBLE_PART: f64 = 1e-4;

/// Step of a finite difference, in sizes of the value.
const DIFFERENCE: f64 = 1e-4;

/// Tries of a damping before the search ends, and the factors between them.
const DAMPING_TRIES: usize = 6;
const DAMPING_RAISED: f64 = 6.0;
const DAMPING_LOWERED: f64 = 0.25;

/// Longest step of a value that moves by factors, and of another, in sizes.
const LONGEST_FACTOR: f64 = 1.0;
const LONGEST_STEP: f64 = 30.0;

impl<'a> Data<'a> {
    /// `trials` whose rows are worth what the force sensor alone leaves of them.
    #[must_use]
    pub fn new(trials: &'a [ContactTrial]) -> Self {
        let noise: Vec<Vec<f64>> = trials.iter().map(|trial| vec![trial.force_variance; trial.len()]).collect();
        let weights = trials.iter().zip(&noise).map(|(trial, noise)| {
            let rows = trial.counts.iter().zip(noise);
            rows.map(|(counts, variance)| if *counts { variance.sqrt().recip() } else { 0.0 }).collect()
        });
        Self { trials, weights: weights.collect(), noise, noise_is_as_stated: true }
    }

    /// Rows that count.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.weights.iter().flatten().filter(|weight| **weight > 0.0).count()
    }

    /// Weighted squares that the sensors alone leave.
    #[must_use]
    pub fn expected(&self) -> f64 {
        let rows = self.weights.iter().flatten().zip(self.noise.iter().flatten());
        rows.filter(|(weight, _)| **weight > 0.0).map(|(weight, variance)| weight * weight * variance).sum()
    }

    /// Root mean square of what the sensors alone leave, N or N m.
    #[must_use]
    pub fn expected_noise(&self) -> f64 {
        let rows = self.weights.iter().flatten().zip(self.noise.iter().flatten()).filter(|(weight, _)| **weight > 0.0);
        let (sum, count) = rows.fold((0.0, 0usize), |(sum, count), (_, variance)| (sum + variance, count + 1));
        (sum / count.max(1) as f64).sqrt()
    }

    /// Measured less predicted force of trial `trial`, N or N m.
    #[must_use]
    pub fn residual(&self, model: &ContactModel, values: &[f64], trial: usize) -> Vec<f64> {
        let predicted = model.predicted(values, &self.trials[trial], trial);
        self.trials[trial].force.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect()
    }

    fn weighted(&self, model: &ContactModel, values: &[f64], trial: usize) -> Vec<f64> {
        let mut residual = self.residual(model, values, trial);
        residual.iter_mut().zip(&self.weights[trial]).for_each(|(residual, weight)| {
            *residual = if *weight > 0.0 { *residual * weight } else { 0.0 };
        });
        residual
    }

    /// Weighted residuals of all trials, one after another.
    #[must_use]
    pub fn weighted_residual(&self, model: &ContactModel, values: &[f64]) -> Vec<f64> {
        let each: Vec<Vec<f64>> =
            (0..self.trials.len()).into_par_iter().map(|trial| self.weighted(model, values, trial)).collect();
        each.concat()
    }

    /// Columns of derivatives of the weighted residual by one step of each value in `free`.
    #[must_use]
    pub fn columns(
        &self,
        model: &ContactModel,
        values: &[f64],
        ranges: &[Range],
        free: &[usize],
        base: &[f64],
    ) -> Vec<Vec<f64>> {
        let starts = self.starts();
        let column = |&at: &usize| {
            let range = &ranges[at];
            let (mut moved, mut difference) = (values.to_vec(), DIFFERENCE);
            moved[at] = range.moved(values[at], difference);
            if moved[at] > range.high {
                difference = -difference;
                moved[at] = range.moved(values[at], difference);
            }
            let mut column = vec![0.0; base.len()];
            let trials = model.owner(at).map_or(0..self.trials.len(), |trial| trial..trial + 1);
            for trial in trials {
                let after = self.weighted(model, &moved, trial);
                for (row, after) in after.iter().enumerate() {
                    let row = starts[trial] + row;
                    column[row] = (after - base[row]) / difference;
                }
            }
            column
        };
        free.par_iter().map(column).collect()
    }

    /// Where each trial begins among all rows.
    #[must_use]
    pub fn starts(&self) -> Vec<usize> {
        let mut next = 0;
        let starts = self.trials.iter().map(|trial| {
            next += trial.len();
            next - trial.len()
        });
        starts.collect()
    }

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
                Normal::of(self.columns(model, &values, &ranges, &free, &base), &base, &ranges, &free, &values);
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

    /// `start` fitted.
    #[must_use]
    pub fn fit(&self, model: &ContactModel, start: &[f64], effort: Effort) -> Fit {
        self.fit_holding(model, start, effort, &|_| false)
    }

    /// The same with each row worth what is expected of it under `fit`: to the force's variance come those of position, velocity and
    /// acceleration, each by how much the force changes with it (effective variance: J. Orear, *Am. J. Phys.* 50, 1982), and one variance
    /// for what the law itself leaves. Where `fit` leaves less than the sensors are said to, they leave no more than that; where their noise
    /// remembers, they leave what that comes to.
    #[must_use]
    pub fn weighed(&self, fit: &Fit) -> Self {
        let noise: Vec<Vec<f64>> = self
            .trials
            .par_iter()
            .enumerate()
            .map(|(number, trial)| noise_along(&fit.model, &fit.values, trial, number))
            .collect();
        let residual: Vec<Vec<f64>> =
            (0..self.trials.len()).map(|trial| self.residual(&fit.model, &fit.values, trial)).collect();
        let rows = noise.iter().flatten().zip(residual.iter().flatten()).filter(|(variance, _)| variance.is_finite());
        let rows: Vec<(f64, f64)> = rows.map(|(variance, residual)| (*variance, residual * residual)).collect();
        let coloured = noise_power(self.trials, fit, &noise, &residual);
        let scale = if coloured > NOTABLE_POWER { coloured } else { noise_scale(&rows) };
        let noise: Vec<Vec<f64>> =
            noise.iter().map(|trial| trial.iter().map(|variance| scale * variance).collect()).collect();
        let rows: Vec<(f64, f64)> =
            rows.iter().map(|(variance, square)| (scale.max(1.0) * variance, *square)).collect();
        let misfit = law_variance(&rows);
        let weight = |variance: &f64| if variance.is_finite() { (variance + misfit).sqrt().recip() } else { 0.0 };
        let weights = noise.iter().map(|trial| trial.iter().map(weight).collect());
        Self { trials: self.trials, weights: weights.collect(), noise, noise_is_as_stated: scale == 1.0 }
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
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    fn of(columns: Vec<Vec<f64>>, residual: &[f64], ranges: &[Range], free: &[usize], values: &[f64]) -> Self {
        let count = columns.len();
        let mut matrix = DMatrix::zeros(count, count);
        for row in 0..count {
            for column in 0..=row {
                let product = dot(&columns[row], &columns[column]);
                (matrix[(row, column)], matrix[(column, row)]) = (product, product);
            }
        }
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
    fn step(&self, values: &[f64], ranges: &[Range], free: &[usize], damping: f64) -> Vec<f64> {
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

/// What a fit leaves, in deviations of the sensors, and how much of it belongs together.
#[derive(Debug, Clone)]
pub struct Rest {
    /// Weighted residual, trial after trial; zero where a row does not count.
    pub rows: Vec<f64>,
    /// Mean square of it, no less than what the sensors leave.
    pub power: f64,
    /// Its squares over those that the sensors leave, no less than one.
    pub over_sensors: f64,
    /// Rows that tell no more than one: the integrated autocorrelation time, or where that is more the rows that one error of the
    /// encoder's rounding is shared by; at least one.
    pub correlated_rows: f64,
}

impl Rest {
    /// What `fit` leaves of `data`.
    #[must_use]
    pub fn of(data: &Data<'_>, fit: &Fit) -> Self {
        let rows = data.weighted_residual(&fit.model, &fit.values);
        let (squares, expected) = (energy(&rows), data.expected().max(f64::MIN_POSITIVE));
        let starts = data.starts();
        let trials = starts.iter().zip(data.trials).map(|(start, trial)| &rows[*start..start + trial.len()]);
        let in_time = integrated_autocorrelation(&trials.collect::<Vec<_>>());
        let correlated_rows = in_time.max(rows_that_share_rounding(data.trials, &rows));
        let power = squares.max(expected) / data.rows().max(1) as f64;
        Self { power, over_sensors: (squares / expected).max(1.0), correlated_rows, rows }
    }
}

/// 1 + 2 sum of the autocorrelations up to a lag of six times itself (A. Sokal's window), in rows.
fn integrated_autocorrelation(trials: &[&[f64]]) -> f64 {
    let total: f64 = trials.iter().map(|rows| energy(rows)).sum();
    let longest = trials.iter().map(|rows| rows.len()).max().unwrap_or(0) / 4;
    let mut time = 1.0;
    for lag in 1..longest {
        let product: f64 = trials
            .iter()
            .filter(|rows| rows.len() > lag)
            .map(|rows| dot(&rows[lag..], &rows[..rows.len() - lag]))
            .sum();
        time += 2.0 * product / total.max(f64::MIN_POSITIVE);
        if lag as f64 >= 6.0 * time {
            break;
        }
    }
    time.max(1.0)
}

/// Rows of the weighted residual `rows` that share one error because they were read in one step of the encoder: what sums over steps vary
/// by, over what they would if all rows were independent; one where they are, or where the encoder has no steps.
///
/// Rounding is a function of the place (B. Widrow, I. Kollár, *Quantization Noise*, 2008, ch. 5): where a motion turns in one step over
/// and over, all its rows are wrong by the same part of it, in whatever trial and however long after another, which no autocorrelation
/// over a few rows sees. It is the factor by which clusters widen a variance (B. R. Moulton, *Rev. Econ. Stat.* 72, 1990).
fn rows_that_share_rounding(trials: &[ContactTrial], rows: &[f64]) -> f64 {
    let mut sums: BTreeMap<i64, f64> = BTreeMap::new();
    let mut squares = 0.0;
    let mut first = 0;
    for trial in trials {
        for (step, row) in trial.encoder_steps.iter().zip(&rows[first..first + trial.len()]) {
            *sums.entry(*step).or_default() += row;
            squares += row * row;
        }
        first += trial.len();
    }
    if squares > 0.0 { (sums.values().map(|sum| sum * sum).sum::<f64>() / squares).max(1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tool that comes back to each of twenty steps of its encoder over and over: what rounding leaves in one is the same each time, which
    /// is not seen over a few rows; a sensor's noise is another one each time.
    #[test]
    fn rows_of_one_step_of_the_encoder_share_its_rounding() {
        use super::super::testing::TestContact;
        let mut trial = TestContact::PLAIN.trial(1);
        let rows = trial.len();
        let step_of = |row: usize| (row * 7) % 20;
        trial.encoder_steps = (0..rows).map(|row| step_of(row) as i64).collect();
        let mut state = 5u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt()
        };
        let noise: Vec<f64> = (0..rows).map(|_| uniform()).collect();
        let errors: Vec<f64> = (0..20).map(|_| uniform()).collect();
        let rounding: Vec<f64> = (0..rows).map(|row| errors[step_of(row)]).collect();
        let trials = [trial];
        // Twenty squares of sums: their mean scatters by sqrt(2 / 20).
        let alone = rows_that_share_rounding(&trials, &noise);
        assert!((1.0..2.0).contains(&alone), "{alone}");
        // A twentieth of all rows each.
        let shared = rows_that_share_rounding(&trials, &rounding);
        assert!((shared / (rows as f64 / 20.0) - 1.0).abs() < 1e-3, "{shared}");
        let mut continuous = trials;
        continuous[0].encoder_steps.clear();
        assert_eq!(rows_that_share_rounding(&continuous, &rounding), 1.0);
    }

    #[test]
    fn rows_that_repeat_one_error_count_once() {
        let mut state = 11u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt()
        };
        let white: Vec<f64> = (0..20_000).map(|_| uniform()).collect();
        // The estimate's deviation is sqrt(2 (2 window + 1) / rows) of it: 4 % at a window of six rows.
        let alone = integrated_autocorrelation(&[&white]);
        assert!((1.0..1.15).contains(&alone), "{alone}");
        // Held for ten rows: ten rows tell no more than one; a triangle of autocorrelations sums to ten, its estimate to a fifth.
        let held: Vec<f64> = white[..2000].iter().flat_map(|value| [*value; 10]).collect();
        let together = integrated_autocorrelation(&[&held]);
        assert!((8.0..12.5).contains(&together), "{together}");
        // Parted into trials it is the same.
        let (first, second) = held.split_at(10_000);
        let parted = integrated_autocorrelation(&[first, second]);
        assert!((parted / together - 1.0).abs() < 0.05, "{parted} {together}");
    }
}
