//! The residual of the contact's channel, row by row.

use super::contact_plot::depth_name;
use super::contact_report::CHANNEL;
use super::residual_map::{ChannelResidual, ResidualRow};
use crate::diagnose::contact::outcome::Outcome;
use crate::diagnose::contact::trial::ContactTrial;
use crate::diagnose::phase::Phase;
use crate::diagnose::verdict::Verdict;
use crate::rig::Coordinate;

/// The rows of `outcome` that count.
pub(super) fn contact_residual(outcome: &Outcome, coordinate: Coordinate) -> ChannelResidual<'_> {
    let step_s = outcome.trials.first().map_or(1.0, |trial| trial.step_s);
    ChannelResidual {
        channel: CHANNEL,
        coordinate,
        position_name: depth_name(outcome),
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
    let trials = outcome.parasitic.as_ref().map(|force| force.taken_off(&outcome.trials));
    for (number, trial) in trials.as_ref().unwrap_or(&outcome.trials).iter().enumerate() {
        let surface = model.surface(&outcome.chosen.values, number);
        let pull = pull(trial, surface);
        for row in (0..trial.len()).filter(|row| outcome.weights[number][*row] > 0.0) {
            let (depth, velocity) = (trial.position[row] - surface, trial.velocity[row]);
            rows.push(ResidualRow {
                trial: number,
                time_s: trial.time[row],
                position: if model.bilateral { trial.position[row] } else { depth },
                velocity,
                phase: match Phase::of(depth, velocity, scales.depth, scales.speed, model.bilateral) {
                    // What still pulls has not let go, and what already pushes or pulls has been touched.
                    Phase::Free if pull(trial.force[row]) => {
                        if velocity > 0.0 {
                            Phase::Onset
                        } else {
                            Phase::Release
                        }
                    }
                    phase => phase,
                },
                before: before[number][row].powi(2),
                after: outcome.residuals[2][number][row].powi(2),
                noise: outcome.noise[number][row],
                gained: gained(outcome, before, number, row),
            });
        }
    }
    rows
}

/// Deviations of the sensor from its usual reading outside of the contact from which a force acts there.
const MIN_PULL_DEVIATIONS: f64 = 8.0;

/// Tells of a force reading outside of the contact whether something acts: against the usual reading there.
fn pull(trial: &ContactTrial, surface: f64) -> impl Fn(f64) -> bool {
    let outside = trial.force.iter().zip(&trial.position).filter(|(_, position)| **position < surface);
    let mut readings: Vec<f64> = outside.map(|(force, _)| *force).collect();
    readings.sort_by(f64::total_cmp);
    let usual = readings.get(readings.len() / 2).copied().unwrap_or(0.0);
    let limit = MIN_PULL_DEVIATIONS * trial.force_variance.sqrt();
    move |force| (force - usual).abs() > limit
}

/// What the answer takes of a row: the learned element's law where there is one, else the named effects', and where nothing is named
/// all that is above the noise.
fn gained(outcome: &Outcome, before: &[Vec<f64>], trial: usize, row: usize) -> f64 {
    let left = match (outcome.left_by_learned(), outcome.verdict) {
        (Some(residual), _) => residual[trial][row].powi(2),
        (None, Verdict::Unknown) => outcome.noise[trial][row],
        (None, _) => outcome.residuals[2][trial][row].powi(2),
    };
    before[trial][row].powi(2) - left
}

/// The mismatch that is located: of given values where nothing but them is wrong, else of refitted ones.
fn before(outcome: &Outcome) -> &[Vec<f64>] {
    match outcome.verdict {
        Verdict::NoMismatch | Verdict::Parameters => &outcome.residuals[0],
        _ => &outcome.residuals[1],
    }
}
