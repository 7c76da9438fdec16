//! What a law leaves, and how many rows of it tell more than one.

use std::collections::BTreeMap;

use super::data::Data;
use super::fit::Fit;
use super::trial::ContactTrial;
use crate::diagnose::linalg::{dot, energy};

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
#[must_use]
pub fn integrated_autocorrelation(trials: &[&[f64]]) -> f64 {
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
