//! The residual of the contact's channel, row by row.

use super::contact_report::CHANNEL;
use super::residual_map::{ChannelResidual, ResidualRow};
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::phase::Phase;
use crate::diagnose::verdict::Verdict;
use crate::rig::Coordinate;

/// The rows of `outcome` that count.
pub(super) fn contact_residual(outcome: &Outcome, coordinate: Coordinate) -> ChannelResidual<'_> {
    let step_s = outcome.trials.first().map_or(1.0, |trial| trial.step_s);
    ChannelResidual {
        channel: CHANNEL,
        coordinate,
        position_name: "depth",
        trials: outcome.trials.iter().map(|trial| trial.name.as_str()).collect(),
        rows: rows(outcome),
        columns: [before(outcome), &outcome.residuals[2]],
        step_s,
        highest_hz: 0.45 / step_s,
        expected_noise: outcome.expected_noise,
        noise_to_hz: 0.5 / step_s,
        // One pass through a phase is one place.
        longest_s: f64::INFINITY,
    }
}

fn rows(outcome: &Outcome) -> Vec<ResidualRow> {
    let model = &outcome.chosen.model;
    let scales = &model.scales;
    let before = before(outcome);
    let mut rows = Vec::new();
    for (number, trial) in outcome.trials.iter().enumerate() {
        let surface = model.surface(&outcome.chosen.values, number);
        for row in (0..trial.len()).filter(|row| outcome.weights[number][*row] > 0.0) {
            let (depth, velocity) = (trial.position[row] - surface, trial.velocity[row]);
            rows.push(ResidualRow {
                trial: number,
                time_s: trial.time[row],
                position: depth,
                velocity,
                phase: Phase::of(depth, velocity, scales.depth, scales.speed, model.bilateral),
                before: before[number][row].powi(2),
                after: outcome.residuals[2][number][row].powi(2),
                noise: outcome.weights[number][row].powi(-2),
            });
        }
    }
    rows
}

/// The mismatch that is located: of given values where nothing but them is wrong, else of refitted ones.
fn before(outcome: &Outcome) -> &[Vec<f64>] {
    match outcome.verdict {
        Verdict::NoMismatch | Verdict::Parameters => &outcome.residuals[0],
        _ => &outcome.residuals[1],
    }
}
