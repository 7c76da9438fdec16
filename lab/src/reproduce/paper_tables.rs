//! Tables I to III, under one reading of what the paper leaves open.

use anyhow::Result;
use palpate::Estimate;
use rayon::prelude::*;

use super::estimator::{Estimator, PAPER_COVARIANCE, PAPER_GAMMA, as_the_paper};
use super::measure::{MeanAndDeviation, contact, median, rmse_percent, settling, stiffness};
use super::paper::WINDOWS;
use super::paper_contact::{PaperContact, PaperTrial};

/// How many trials a table averages.
pub const TRIALS: u64 = 5;

/// What the paper leaves open, decided in one way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperVariant {
    /// For the reader.
    pub name: &'static str,
    /// Every how many rows of the 1 kHz recording the estimators are fed.
    pub every: usize,
    /// P(0) of EWRLS.
    pub covariance: f32,
    /// P(0) of SPRLS.
    pub sprls_covariance: f32,
    /// Sensitivity of SPRLS.
    pub gamma: f32,
}

impl PaperVariant {
    /// Samples at 1 kHz, settings as printed.
    pub const FULL: Self = Self {
        name: "1 kHz",
        every: 1,
        covariance: PAPER_COVARIANCE,
        sprls_covariance: PAPER_COVARIANCE,
        gamma: PAPER_GAMMA,
    };
    /// Every tenth sample.
    pub const TENTH: Self = Self { name: "down-sampled by 10", every: 10, ..Self::FULL };
    /// The settings that come nearest to the paper's figures.
    pub const NEAREST: Self =
        Self { name: "1 kHz, P(0) 30, gamma 0.05", covariance: 30.0, sprls_covariance: 1.0, gamma: 0.05, ..Self::FULL };
    /// All of them.
    pub const ALL: [Self; 3] = [Self::FULL, Self::TENTH, Self::NEAREST];

    /// The paper's four on a window, with the settings of this reading.
    pub fn estimators(&self, window: u16) -> [Estimator; 4] {
        [
            Estimator::Ewrls { window, covariance: self.covariance },
            Estimator::Sprls { gamma: self.gamma, covariance: self.sprls_covariance },
            Estimator::Bls(window),
            Estimator::Blmf(window),
        ]
    }
}

/// One method on one contact: five trials.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// RMSE% over all of the contact.
    pub rmse: MeanAndDeviation,
    /// The same without its first 0.3 s.
    pub rmse_later: MeanAndDeviation,
    /// Standard deviation of K, N/m, from 1 s after the touch on.
    pub deviation: MeanAndDeviation,
    /// Seconds from the touch until K stays, for the first 2 s, within 10 % of its median over the third.
    pub converged: MeanAndDeviation,
}

/// All that one reading gives.
#[derive(Debug, Clone)]
pub struct Study {
    /// Which one.
    pub reading: PaperVariant,
    /// By method and contact, window 300.
    pub by_contact: [[Cell; 3]; 4],
    /// By method and window, on the soft contact.
    pub by_window: Vec<[Cell; 4]>,
}

/// The trials of the paper's three contacts.
pub type Trials = [Vec<PaperTrial>; 3];

/// Simulates them.
///
/// # Errors
/// None for the rig files of this repository.
pub fn trials() -> Result<Trials> {
    let [soft, varying, medium] =
        PaperContact::PAPER.map(|contact| PaperTrial::several(&contact.rig()?, TRIALS, false));
    Ok([soft?, varying?, medium?])
}

impl Study {
    /// Runs the paper's methods on `trials`.
    ///
    /// # Errors
    /// None for the settings of a reading.
    pub fn of(reading: PaperVariant, trials: &Trials, done: &(dyn Fn() + Sync)) -> Result<Self> {
        let cells = |trials: &[PaperTrial], window: u16| -> Result<[Cell; 4]> {
            let cells = reading.estimators(window).map(|estimator| cell(reading, estimator, trials));
            done();
            let [a, b, c, d] = cells;
            Ok([a?, b?, c?, d?])
        };
        let columns: Vec<[Cell; 4]> = trials.par_iter().map(|trials| cells(trials, 300)).collect::<Result<Vec<_>>>()?;
        let by_contact = std::array::from_fn(|method| std::array::from_fn(|contact| columns[contact][method]));
        let by_window = WINDOWS.par_iter().map(|window| cells(&trials[0], *window)).collect::<Result<Vec<_>>>()?;
        Ok(Self { reading, by_contact, by_window })
    }
}

fn cell(reading: PaperVariant, estimator: Estimator, trials: &[PaperTrial]) -> Result<Cell> {
    let rate = 1000.0 / reading.every as f64;
    let config = as_the_paper(1e-3 * reading.every as f32);
    let rows = |seconds: f64| (seconds * rate).round() as usize;
    let mut found: [Vec<f64>; 4] = Default::default();
    for trial in trials {
        let samples = trial.samples(reading.every);
        let estimates = estimator.run(config, &samples)?;
        let touched = &estimates[contact(&estimates)];
        let later = &touched[rows(1.0).min(touched.len())..touched.len().saturating_sub(rows(0.5))];
        let values = [
            rmse_percent(&estimates, &samples, 0),
            rmse_percent(&estimates, &samples, rows(0.3)),
            MeanAndDeviation::of(stiffness(later)).deviation,
            convergence(touched, rate),
        ];
        found.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    let [rmse, rmse_later, deviation, converged] = found.map(MeanAndDeviation::of);
    Ok(Cell { rmse, rmse_later, deviation, converged })
}

/// Seconds until K stays, for as long as the next 2 s, within 10 % of where it is then: the contact itself may drift after that.
pub fn convergence(touched: &[Estimate], rate: f64) -> f64 {
    let (two, three) = ((2.0 * rate) as usize, (3.0 * rate) as usize);
    let early = &touched[..touched.len().min(two)];
    let aim = median(stiffness(&touched[two.min(touched.len())..three.min(touched.len())]));
    settling(early, aim, 0.1) as f64 / rate
}
