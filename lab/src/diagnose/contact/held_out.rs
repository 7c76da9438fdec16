//! What a law leaves of rows that its values were not fitted to.

use super::fit::{Data, Effort, Fit};
use super::model::{ContactModel, index};

/// Two halves of the rows: every other trial, or every other block of a single one. Each is fitted once and judged once.
pub struct Folds {
    /// For each half, whether each row of each trial belongs to it.
    halves: [Vec<Vec<bool>>; 2],
}

/// Residuals under the values of the other half, and the values that each half gave.
pub struct HeldOut {
    /// Measured less predicted, N or N m, a column a trial.
    pub residual: Vec<Vec<f64>>,
    /// Squares of it, weighted.
    pub energy: f64,
    /// Fitted to the first half, and to the second.
    pub values: [Vec<f64>; 2],
}

/// Blocks of a single trial.
const BLOCKS: usize = 40;

/// Steps of the search on a half, from the values of the whole.
const STEPS: Effort = Effort(6);

impl Folds {
    /// The halves of the rows of `data`.
    #[must_use]
    pub fn of(data: &Data<'_>) -> Self {
        Self::with_blocks(data, BLOCKS)
    }

    /// The same with `blocks` of a single trial.
    #[must_use]
    pub fn with_blocks(data: &Data<'_>, blocks: usize) -> Self {
        let single = data.trials.len() == 1;
        let half = |wanted: usize| {
            let trials = data.trials.iter().enumerate().map(|(number, trial)| {
                let block = trial.len().div_ceil(blocks).max(1);
                (0..trial.len()).map(|row| (if single { row / block } else { number }) % 2 == wanted).collect()
            });
            trials.collect()
        };
        Self { halves: [half(0), half(1)] }
    }

    fn masked<'a>(&self, data: &Data<'a>, half: usize) -> Data<'a> {
        let weights = data.weights.iter().zip(&self.halves[half]).map(|(weights, own)| {
            weights.iter().zip(own).map(|(weight, own)| if *own { *weight } else { 0.0 }).collect()
        });
        Data { noise: data.noise.clone(), weights: weights.collect(), ..*data }
    }

    /// Fits `fit` on each half and takes what is left on the other. What belongs to an unseen trial alone, where the law says so, is
    /// fitted to that trial; nothing else is.
    #[must_use]
    pub fn held_out(&self, data: &Data<'_>, fit: &Fit) -> HeldOut {
        let taught = [0, 1].map(|half| self.masked(data, half).fit(&fit.model, &fit.values, STEPS).values);
        self.judged(data, &fit.model, taught)
    }

    /// Whether each row, trial after trial, belongs to the first half.
    #[must_use]
    pub fn is_first(&self) -> Vec<bool> {
        self.halves[0].concat()
    }

    /// What `model` leaves of each half with the values that the other half gave, `taught`.
    #[must_use]
    pub fn judged(&self, data: &Data<'_>, model: &ContactModel, taught: [Vec<f64>; 2]) -> HeldOut {
        let mut residual: Vec<Vec<f64>> = data.trials.iter().map(|trial| vec![0.0; trial.len()]).collect();
        let mut energy = 0.0;
        let has_own = (0..taught[0].len()).any(|at| model.owner(at).is_some());
        let values = [0, 1].map(|half| {
            let taught = taught[half].clone();
            let unseen = self.masked(data, 1 - half);
            let placed = if has_own && data.trials.len() > 1 {
                let is_shared = |at: usize| model.owner(at).is_none() && !(model.own.surface && at == index::SURFACE);
                unseen.fit_holding(model, &taught, STEPS, &is_shared).values
            } else {
                taught.clone()
            };
            for (number, weights) in unseen.weights.iter().enumerate() {
                let own = data.residual(model, &placed, number);
                for (row, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                    residual[number][row] = own[row];
                    energy += (own[row] * weight).powi(2);
                }
            }
            taught
        });
        HeldOut { residual, energy, values }
    }
}

/// Root mean square over the rows that count.
#[must_use]
pub fn rms(data: &Data<'_>, columns: &[Vec<f64>]) -> f64 {
    let rows = columns.iter().zip(&data.weights).flat_map(|(column, weights)| column.iter().zip(weights));
    let (sum, count) = rows
        .filter(|(_, weight)| **weight > 0.0)
        .fold((0.0, 0usize), |(sum, count), (value, _)| (sum + value * value, count + 1));
    (sum / count.max(1) as f64).sqrt()
}
