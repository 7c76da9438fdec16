//! What does better, where the truth is known: a linear contact of 250, 900 and 250 N/m.

use anyhow::Result;
use palpate::{Estimate, Flags, StreamConfig};
use rayon::prelude::*;

use super::estimator::{Estimator, PAPER_COVARIANCE, PAPER_GAMMA, as_the_paper, matched};
use super::measure::{MeanAndDeviation, contact, coverage, damping, rmse_percent, settling, stiffness};
use super::paper_contact::{PaperContact, PaperTrial};

/// Trials, each with a noise and a surface of its own.
pub const SEEDS: u64 = 20;

/// K before, between and after the jumps; B; rows of the jumps.
pub const STIFFNESS: [f64; 3] = [250.0, 900.0, 250.0];
/// B throughout.
pub const DAMPING: f64 = 5.0;
/// Rows at which K jumps.
pub const JUMPS: [usize; 2] = [6_000, 11_000];

/// Rows behind an onset or a jump that count as its transient.
const TRANSIENT_ROWS: usize = 100;

/// One method under all measures, mean and spread over the seeds.
#[derive(Debug, Clone)]
pub struct ComparisonRow {
    /// Which.
    pub estimator: Estimator,
    /// Behind a matched filter of 40 Hz, or the paper's velocity.
    pub matched: bool,
    /// Milliseconds from the touch until K stays within 10 %.
    pub onset: MeanAndDeviation,
    /// The same from the jump up.
    pub up: MeanAndDeviation,
    /// The same from the jump down.
    pub down: MeanAndDeviation,
    /// Standard deviation of K at 900 N/m, %.
    pub deviation: MeanAndDeviation,
    /// Bias of K there, %.
    pub bias_stiffness: MeanAndDeviation,
    /// Bias of B there, %.
    pub bias_damping: MeanAndDeviation,
    /// RMSE% over the contact.
    pub rmse: MeanAndDeviation,
    /// Share of rows, in %, whose 95 % interval of K holds it, 0.1 s after each event.
    pub covered_stiffness: MeanAndDeviation,
    /// The same of B.
    pub covered_damping: MeanAndDeviation,
    /// Changes found where there was none, in all trials together.
    pub false_alarms: usize,
}

impl ComparisonRow {
    /// The estimator, and what it is fed with.
    pub fn name(&self) -> String {
        let front_end = if self.matched { "matched, " } else { "" };
        let window = match self.estimator {
            Estimator::Bls(w) | Estimator::Blmf(w) | Estimator::NewtonBlmf(w) | Estimator::RidgeBls(w) => {
                format!(" {w}")
            }
            _ => String::new(),
        };
        format!("{front_end}{}{window}", self.estimator.name())
    }
}

/// The paper's four as printed, then the improvements one after the other.
pub fn compared() -> Vec<(Estimator, bool)> {
    let paper = [
        Estimator::Ewrls { window: 300, covariance: PAPER_COVARIANCE },
        Estimator::Sprls { gamma: PAPER_GAMMA, covariance: PAPER_COVARIANCE },
        Estimator::Bls(300),
        Estimator::Blmf(300),
    ];
    let better = [
        Estimator::Ewrls { window: 300, covariance: PAPER_COVARIANCE },
        Estimator::UnbiasedEwrls,
        Estimator::Bls(300),
        Estimator::RidgeBls(300),
        Estimator::Blmf(300),
        Estimator::NewtonBlmf(300),
        Estimator::Directional,
        Estimator::Adaptive,
        Estimator::Cusum,
    ];
    paper.map(|e| (e, false)).into_iter().chain(better.map(|e| (e, true))).collect()
}

/// The trials of the steps, the surface anywhere within a count.
///
/// # Errors
/// None for the rig file of this repository.
pub fn trials() -> Result<Vec<PaperTrial>> {
    PaperTrial::several(&PaperContact::Steps.rig()?, SEEDS, true)
}

/// The front end of a row.
pub fn front_end(is_matched: bool) -> StreamConfig {
    if is_matched { matched() } else { as_the_paper(1e-3) }
}

/// All methods over all trials.
///
/// # Errors
/// None for these settings.
pub fn study(trials: &[PaperTrial], done: &(dyn Fn() + Sync)) -> Result<Vec<ComparisonRow>> {
    compared()
        .into_par_iter()
        .map(|(estimator, is_matched)| {
            let row = row(estimator, is_matched, trials);
            done();
            row
        })
        .collect()
}

fn row(estimator: Estimator, is_matched: bool, trials: &[PaperTrial]) -> Result<ComparisonRow> {
    let mut columns: [Vec<f64>; 9] = Default::default();
    let mut false_alarms = 0;
    for trial in trials {
        let samples = trial.samples(1);
        let estimates = estimator.run(front_end(is_matched), &samples)?;
        let touched = contact(&estimates);
        let [up, down] = JUMPS;
        let parts = [touched.start..up, up..down, down..touched.end];
        let milliseconds = |part: usize| settling(&estimates[parts[part].clone()], STIFFNESS[part], 0.1) as f64;
        let steady = &estimates[up + 2000..down];
        let k = MeanAndDeviation::of(stiffness(steady));
        let b = MeanAndDeviation::of(damping(steady));
        let covered = parts.clone().map(|part| inside(&estimates[part.start + TRANSIENT_ROWS..part.end], part.start));
        let rows = covered.iter().map(|(rows, _)| *rows as f64).sum::<f64>();
        let share = |at: usize| 100.0 * covered.iter().map(|(n, c)| *n as f64 * c[at]).sum::<f64>() / rows;
        let values = [
            milliseconds(0),
            milliseconds(1),
            milliseconds(2),
            100.0 * k.deviation / k.mean,
            100.0 * (k.mean / STIFFNESS[1] - 1.0),
            100.0 * (b.mean / DAMPING - 1.0),
            rmse_percent(&estimates, &samples, 0),
            share(0),
            share(1),
        ];
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        let quiet = |part: &std::ops::Range<usize>| &estimates[part.start + 2 * TRANSIENT_ROWS..part.end];
        let alarms = parts.iter().flat_map(quiet).filter(|e| e.flags.contains(Flags::CHANGED));
        false_alarms += alarms.count();
    }
    let [onset, up, down, deviation, bias_stiffness, bias_damping, rmse, covered_stiffness, covered_damping] =
        columns.map(MeanAndDeviation::of);
    Ok(ComparisonRow {
        estimator,
        matched: is_matched,
        onset,
        up,
        down,
        deviation,
        bias_stiffness,
        bias_damping,
        rmse,
        covered_stiffness,
        covered_damping,
        false_alarms,
    })
}

/// How many rows there are, and the shares of them that hold the truth of the part that begins at row `start`.
fn inside(estimates: &[Estimate], start: usize) -> (usize, [f64; 2]) {
    let [up, down] = JUMPS;
    let truth = if start < up {
        STIFFNESS[0]
    } else if start < down {
        STIFFNESS[1]
    } else {
        STIFFNESS[2]
    };
    (estimates.len(), coverage(estimates, truth, DAMPING))
}
