//! The residual of the drive's channel, row by row.

use super::drive_report::{CHANNEL, Touched};
use super::residual_map::{ChannelResidual, ResidualRow};
use crate::diagnose::drive::outcome::Outcome;
use crate::diagnose::drive::trial::DriveTrial;
use crate::diagnose::phase::Phase;
use crate::diagnose::verdict::Verdict;
use crate::rig::Coordinate;

/// Length of a stretch that is reported as a place, s; a shorter trial is one stretch.
const STRETCH_S: f64 = 1.0;

/// The rows of `outcome`.
pub(super) fn drive_residual<'a>(
    outcome: &'a Outcome,
    coordinate: Coordinate,
    touched: Option<&Touched>,
) -> ChannelResidual<'a> {
    let step_s = outcome.trials.first().map_or(1.0, |trial| trial.period_s);
    let highest_hz = outcome.band_hz.min(0.45 / step_s);
    ChannelResidual {
        channel: CHANNEL,
        coordinate,
        position_name: "position",
        trials: outcome.trials.iter().map(|trial| trial.name.as_str()).collect(),
        rows: rows(outcome, touched),
        columns: [before(outcome), &outcome.missing[2]],
        step_s,
        highest_hz,
        expected_noise: outcome.expected_noise,
        // The missing force is smoothed: all of its noise lies within the band.
        noise_to_hz: highest_hz,
        longest_s: STRETCH_S,
    }
}

fn rows(outcome: &Outcome, touched: Option<&Touched>) -> Vec<ResidualRow> {
    let noise = outcome.expected_noise.powi(2);
    let before = before(outcome);
    let mut rows = Vec::new();
    for (number, trial) in outcome.trials.iter().enumerate() {
        let missing = before[number].iter().zip(&outcome.missing[2][number]);
        for (row, (first, last)) in missing.enumerate() {
            let (first, last) = (first.powi(2), last.powi(2));
            let left = if outcome.verdict == Verdict::Unknown { noise } else { last };
            let (position, velocity) = (trial.position[row], velocity(trial, row));
            rows.push(ResidualRow {
                trial: number,
                time_s: trial.time[row] - trial.time[0],
                position,
                velocity,
                phase: touched.map_or(Phase::Free, |touched| touched.phase(number, position, velocity)),
                before: first,
                after: last,
                noise,
                gained: first - left,
            });
        }
    }
    rows
}

/// The mismatch that is located: of given values where nothing but them is wrong, else of refitted ones.
fn before(outcome: &Outcome) -> &[Vec<f64>] {
    match outcome.verdict {
        Verdict::NoMismatch | Verdict::Parameters => &outcome.missing[0],
        _ => &outcome.missing[1],
    }
}

/// Velocity over some rows: one row is the encoder's step.
pub(super) fn velocity(trial: &DriveTrial, row: usize) -> f64 {
    const HALF: usize = 5;
    let (from, to) = (row.saturating_sub(HALF), (row + HALF).min(trial.len() - 1));
    if to == from { 0.0 } else { (trial.position[to] - trial.position[from]) / (trial.time[to] - trial.time[from]) }
}
