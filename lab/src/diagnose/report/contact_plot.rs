//! What the page draws of a contact: force over time, and over depth.

use super::contact_report::CHANNEL;
use super::diagnosis::{StatePlot, Trace};
use super::traversals;
use crate::diagnose::contact::outcome::Outcome;
use crate::rig::Coordinate;

/// Part of a pass that is drawn before the touch and after the release.
const APPROACH: f64 = 0.15;

/// Passes as long as this many of the stretch that shows the answer are drawn in part.
const MOST_STRETCHES: f64 = 40.0;

/// Force by a law, from what it leaves.
fn by(outcome: &Outcome, residual: &[Vec<f64>], trial: usize) -> Vec<f32> {
    let rows = outcome.trials[trial].force.iter().zip(&residual[trial]);
    rows.map(|(force, left)| (force - left) as f32).collect()
}

/// Force with what was learned and has no name; empty where there is nothing.
fn by_learned(outcome: &Outcome, trial: usize) -> Vec<f32> {
    outcome.left_by_learned().map_or_else(Vec::new, |residual| by(outcome, residual, trial))
}

/// Depth below the fitted surface; the position itself where the spring pulls as well, which has no surface.
fn depth(outcome: &Outcome, trial: usize) -> Vec<f32> {
    let model = &outcome.chosen.model;
    let surface = if model.bilateral { 0.0 } else { model.surface(&outcome.chosen.values, trial) };
    outcome.trials[trial].position.iter().map(|position| (position - surface) as f32).collect()
}

/// What [`depth`] is called.
pub(super) fn depth_name(outcome: &Outcome) -> &'static str {
    if outcome.chosen.model.bilateral { "position" } else { "depth" }
}

/// One trace a trial.
pub(super) fn traces(outcome: &Outcome) -> Vec<Trace> {
    let each = outcome.trials.iter().enumerate().map(|(at, trial)| {
        // By the sensors alone: a weight holds what the refitted law leaves as well.
        let noise =
            |variance: &f64| (if variance.is_finite() { variance.sqrt() } else { outcome.expected_noise }) as f32;
        Trace {
            trial: trial.name.clone(),
            channel: CHANNEL,
            time: trial.time.iter().map(|time| trial.origin_s + time).collect(),
            depth: depth(outcome, at),
            measured: trial.force.iter().map(|force| *force as f32).collect(),
            as_given: by(outcome, &outcome.residuals[0], at),
            refitted: by(outcome, &outcome.residuals[1], at),
            improved: by(outcome, &outcome.residuals[2], at),
            learned: by_learned(outcome, at),
            expected_noise: outcome.noise[at].iter().map(noise).collect(),
            valid: outcome.weights[at].iter().map(|weight| *weight > 0.0).collect(),
        }
    });
    each.collect()
}

/// Effects that show as time goes by, whatever the depth.
const BY_TIME: [&str; 7] =
    ["stress_relaxation", "force_drift", "environment_mass", "tool_inertia", "channel_delay", "force_lag", "mains_hum"];

/// Force over depth, and before it, where the first effect of the answer is one of time, force over time: over the pass around the stretch
/// `shown` of a trial, or over the first trial where no stretch stands out.
pub(super) fn evidence(
    outcome: &Outcome,
    first_effect: Option<&str>,
    shown: Option<(usize, [f64; 2])>,
    coordinate: Coordinate,
) -> Vec<StatePlot> {
    let Some(over_depth) = force_over_depth(outcome, shown, coordinate) else { return Vec::new() };
    let is_by_time = first_effect.is_some_and(|name| BY_TIME.contains(&name));
    let over_time = is_by_time.then(|| force_over_time(outcome, &over_depth)).flatten();
    over_time.into_iter().chain([over_depth]).collect()
}

/// The rows of `over_depth`, over time.
fn force_over_time(outcome: &Outcome, over_depth: &StatePlot) -> Option<StatePlot> {
    let time = &outcome.trials.iter().find(|trial| trial.name == over_depth.trial)?.time;
    let first = time.partition_point(|time| *time < over_depth.drawn_s[0]);
    let rows = time.get(first..first + over_depth.state.len())?;
    let state = rows.iter().map(|time| *time as f32).collect();
    Some(StatePlot { along: "time", unit: "s", state, ..over_depth.clone() })
}

fn force_over_depth(outcome: &Outcome, shown: Option<(usize, [f64; 2])>, coordinate: Coordinate) -> Option<StatePlot> {
    let first = outcome.trials.first()?;
    let (trial, stretch_s) = shown.unwrap_or((0, [0.0, first.time.last().copied()?]));
    let depth = depth(outcome, trial);
    let time = &outcome.trials[trial].time;
    let rows = pass(time, &depth, stretch_s, outcome.chosen.model.bilateral);
    let is_touching = |row: &usize| outcome.chosen.model.bilateral || depth[*row] > 0.0;
    let touching = (rows.start..rows.end).find(|row| time[*row] >= stretch_s[0] && is_touching(row));
    let rows = traversals::limited(&depth, rows.clone(), touching.unwrap_or(rows.start));
    let of = |column: Vec<f32>| column.get(rows.clone()).map(<[f32]>::to_vec).unwrap_or_default();
    // A row that does not count was not simulated: a gap, not a line through the measurement.
    let weights = &outcome.weights[trial];
    let simulated = |mut column: Vec<f32>| {
        column.iter_mut().zip(weights).filter(|(_, weight)| **weight <= 0.0).for_each(|(force, _)| *force = f32::NAN);
        of(column)
    };
    Some(StatePlot {
        channel: CHANNEL,
        trial: outcome.trials[trial].name.clone(),
        stretch_s,
        drawn_s: [*time.get(rows.start)?, *time.get(rows.end - 1)?],
        along: depth_name(outcome),
        unit: coordinate.position_unit(),
        ordinate: if coordinate == Coordinate::Rotary { "torque" } else { "force" },
        ordinate_unit: coordinate.force_unit(),
        measured: of(outcome.trials[trial].force.iter().map(|force| *force as f32).collect()),
        as_given: simulated(by(outcome, &outcome.residuals[0], trial)),
        refitted: simulated(by(outcome, &outcome.residuals[1], trial)),
        improved: simulated(by(outcome, &outcome.residuals[2], trial)),
        learned: simulated(by_learned(outcome, trial)),
        state: of(depth),
    })
}

/// The rows from before the touch to after the release around the stretch from `start` to `end`.
fn pass(time: &[f64], depth: &[f32], [start, end]: [f64; 2], bilateral: bool) -> std::ops::Range<usize> {
    let at = |moment: f64| time.partition_point(|time| *time < moment);
    let longest = MOST_STRETCHES * (end - start).max(f64::MIN_POSITIVE);
    let (least, most) = (at(start - longest), at(end + longest).max(at(start) + 1).min(time.len()));
    if bilateral {
        return least..most;
    }
    let touches = |row: &usize| depth[*row] > 0.0;
    // Where the stretch itself lies before the touch or after the release, the contact beside it comes first.
    let from = (least..at(start)).rev().skip_while(|row| !touches(row)).find(|row| !touches(row)).unwrap_or(least);
    let until = (at(end)..most).find(|row| !touches(row)).unwrap_or(most);
    let until = until.max(at(end)).min(most);
    let margin = APPROACH * (time[until.min(time.len() - 1)] - time[from]);
    at(time[from] - margin).max(least)..at(time[until.min(time.len() - 1)] + margin).clamp(from + 1, most)
}
