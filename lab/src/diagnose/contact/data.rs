//! The trials that a contact's law is held against: residuals, what each row is worth, and derivatives.

use std::collections::BTreeMap;

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

/// 95 % point of the normal distribution.
const NORMAL_95: f64 = 1.645;

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

    /// Power of the sensors' noise over that of their noise from row to row, at least one: more where it remembers.
    #[must_use]
    pub const fn noise_memory(&self) -> f64 {
        self.noise_factor.max(1.0)
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

    /// What the sensors alone leave at most, N or N m in root mean square: once in twenty times more. Within one step of the encoder a tool that rests has one error,
    /// even over the step, whose square scatters about a twelfth of the step's by the root of 4/5 of that. Of a power that steps make up by
    /// parts `w` that is `sqrt(4/5 sum w^2)`: many of them leave what is expected, and few can leave more.
    #[must_use]
    pub fn most_noise(&self) -> f64 {
        let mut of_steps: BTreeMap<i64, f64> = BTreeMap::new();
        for ((trial, noise), weights) in self.trials.iter().zip(&self.noise).zip(&self.weights) {
            let rows = trial.encoder_steps.iter().zip(noise).zip(weights).filter(|(_, weight)| **weight > 0.0);
            for ((step, variance), _) in rows {
                *of_steps.entry(*step).or_default() += (variance - trial.force_variance).max(0.0);
            }
        }
        let squares: f64 = of_steps.values().map(|power| power * power).sum();
        let beyond = NORMAL_95 * (0.8 * squares).sqrt() / self.rows().max(1) as f64;
        self.expected_noise().hypot(beyond.sqrt())
    }

    /// Weighted squares that the errors of the motion are expected to leave, beside the force sensor's noise: behind an encoder these repeat with the place.
    #[must_use]
    pub fn expected_of_motion(&self) -> f64 {
        let each = self.trials.iter().zip(&self.noise).zip(&self.weights);
        let of_trial = |((trial, noise), weights): ((&ContactTrial, &Vec<f64>), &Vec<f64>)| {
            // Noise that is louder than the sensor's figures say is so in either.
            let sensor = self.noise_factor * trial.force_variance;
            let rows = noise.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
            rows.map(|(variance, weight)| (variance - sensor).max(0.0) * weight * weight).sum::<f64>()
        };
        each.map(of_trial).sum()
    }

    /// Whether the errors of the position are worth more force in the contact than the force sensor's noise is: by the sensors' figures where
    /// noise that remembers is louder than these.
    #[must_use]
    pub fn is_limited_by_rounding(&self) -> bool {
        let force_noise = self.trials.iter().map(|trial| trial.force_variance.sqrt()).fold(0.0, f64::max);
        self.expected_noise() > ROUNDING_LIMITS * self.noise_memory().sqrt() * force_noise
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

#[cfg(test)]
mod tests {
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    /// A tool that rests in one step of its encoder, or as long in each of ten, whose rounding is worth ten times the force sensor's noise. By hand:
    /// the power is known to 1.645 sqrt(4/5), of ten steps to that over the root of ten.
    #[test]
    fn the_rounding_of_few_steps_of_an_encoder_can_leave_more_than_is_expected() {
        let mut trials = [TestContact::PLAIN.trial(1)];
        let rows = trials[0].len() / 10 * 10;
        let beyond = |trials: &[ContactTrial]| -> f64 {
            let noise = vec![vec![101.0 * FORCE_NOISE.powi(2); rows]];
            let data = Data { noise, weights: vec![vec![1.0; rows]], ..Data::new(trials) };
            (data.most_noise().powi(2) - data.expected_noise().powi(2)) / (10.0 * FORCE_NOISE).powi(2)
        };
        assert!(beyond(&trials).abs() < 1e-12);
        trials[0].encoder_steps = vec![7; rows];
        assert!((beyond(&trials) - 1.645 * 0.8f64.sqrt()).abs() < 1e-3, "{}", beyond(&trials));
        trials[0].encoder_steps = (0..rows).map(|row| row as i64 % 10).collect();
        assert!((beyond(&trials) - 1.645 * 0.08f64.sqrt()).abs() < 1e-3, "{}", beyond(&trials));
    }
}
