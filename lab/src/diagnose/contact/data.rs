//! The trials that a contact's law is held against: residuals, what each row is worth, and derivatives.

use rayon::prelude::*;

use super::criteria::ROUNDING_LIMITS;
use super::model::ContactModel;
use super::range::Range;
use super::trial::ContactTrial;

/// The trials that a model is fitted to, and what each row is worth.
#[derive(Debug, Clone)]
pub struct Data<'a> {
    /// Every trial.
    pub trials: &'a [ContactTrial],
    /// Variance that sensors and the motion's uncertainty give each row of each trial, N^2 or (N m)^2.
    pub noise: Vec<Vec<f64>>,
    /// One over the deviation that is expected of each row; zero where a row does not count.
    pub weights: Vec<Vec<f64>>,
    /// Power of the sensors' noise over what their figures say: one, or by what the law leaves that the rows were weighed by.
    pub noise_factor: f64,
}

/// Step of a finite difference, in sizes of the value.
const DIFFERENCE: f64 = 1e-4;

impl<'a> Data<'a> {
    /// `trials` whose rows are worth what the force sensor alone leaves of them.
    #[must_use]
    pub fn new(trials: &'a [ContactTrial]) -> Self {
        let noise: Vec<Vec<f64>> = trials.iter().map(|trial| vec![trial.force_variance; trial.len()]).collect();
        let weights = trials.iter().zip(&noise).map(|(trial, noise)| {
            let rows = trial.counts.iter().zip(noise);
            rows.map(|(counts, variance)| if *counts { variance.sqrt().recip() } else { 0.0 }).collect()
        });
        Self { trials, weights: weights.collect(), noise, noise_factor: 1.0 }
    }

    /// The same weights and noise for `trials`, which have the same rows.
    #[must_use]
    pub fn of<'b>(&self, trials: &'b [ContactTrial]) -> Data<'b> {
        Data { trials, noise: self.noise.clone(), weights: self.weights.clone(), noise_factor: self.noise_factor }
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

    /// Whether the errors of the position are worth more force in the contact than the force sensor's noise is: by the sensors' figures where
    /// noise that remembers is louder than these.
    #[must_use]
    pub fn is_limited_by_rounding(&self) -> bool {
        let force_noise = self.trials.iter().map(|trial| trial.force_variance.sqrt()).fold(0.0, f64::max);
        self.expected_noise() > ROUNDING_LIMITS * self.noise_factor.max(1.0).sqrt() * force_noise
    }

    /// Measured less predicted force of trial `trial`, N or N m.
    #[must_use]
    pub fn residual(&self, model: &ContactModel, values: &[f64], trial: usize) -> Vec<f64> {
        let predicted = model.predicted(values, &self.trials[trial], trial);
        self.trials[trial].force.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect()
    }

    /// The same of every trial, a column each.
    #[must_use]
    pub fn residuals(&self, model: &ContactModel, values: &[f64]) -> Vec<Vec<f64>> {
        (0..self.trials.len()).map(|trial| self.residual(model, values, trial)).collect()
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
}
