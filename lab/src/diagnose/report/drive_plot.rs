//! What the page draws of a drive: effort over time, and what of it is friction and load over speed or position.

use super::diagnosis::{StatePlot, Trace};
use super::drive_report::CHANNEL;
use super::drive_residual::velocity;
use super::traversals;
use crate::diagnose::drive::input::Inputs;
use crate::diagnose::drive::law::DriveLaw;
use crate::diagnose::drive::model::index;
use crate::diagnose::drive::outcome::Outcome;
use crate::rig::Coordinate;

/// Effects that show over the position; all others are drawn over the speed.
const BY_POSITION: [&str; 2] = ["gravity_load", "cogging"];

// What is missing pushes like an effort: a law that misses some asks for less effort than was measured, or, of friction, whose force is
// against the motion, for more. The effort that a law gives for the motion is what was measured and what it misses together.

/// One trace a trial.
pub(super) fn traces(outcome: &Outcome) -> Vec<Trace> {
    let law = DriveLaw::nominal(1.0, 0.0, outcome.chosen.values[index::DELAY]);
    let each = outcome.trials.iter().enumerate().map(|(at, trial)| {
        let effort = Inputs::of(trial, &law).effort;
        let by = |which: usize| -> Vec<f32> {
            effort.iter().zip(&outcome.missing[which][at]).map(|(effort, missing)| (effort + missing) as f32).collect()
        };
        Trace {
            trial: trial.name.clone(),
            channel: CHANNEL,
            time: trial.time.clone(),
            depth: trial.position.iter().map(|position| *position as f32).collect(),
            as_given: by(0),
            refitted: by(1),
            improved: by(2),
            learned: Vec::new(),
            measured: effort.iter().map(|effort| *effort as f32).collect(),
            expected_noise: vec![outcome.expected_noise as f32; trial.len()],
            valid: trial.restart.iter().map(|restart| !restart).collect(),
        }
    });
    each.collect()
}

/// The effort less the inertia's part, over the speed, of the trial that `shown` names; for an effect of the position, over that.
///
/// What is left to friction and load is, by the refitted law, what viscous friction takes less what is missing beside it; what another
/// law gives of it is that and what it misses together. Smoothed like the missing force.
pub(super) fn friction(
    outcome: &Outcome,
    first_effect: Option<&str>,
    shown: Option<(usize, [f64; 2])>,
    coordinate: Coordinate,
) -> Option<StatePlot> {
    let (number, stretch_s) = match shown {
        Some(shown) => shown,
        None => (0, [0.0, outcome.trials.first()?.duration_s()]),
    };
    let trial = outcome.trials.get(number)?;
    let by_position = first_effect.is_some_and(|name| BY_POSITION.contains(&name));
    let velocities: Vec<f64> = (0..trial.len()).map(|row| velocity(trial, row)).collect();
    let viscous = outcome.nominal.values[index::VISCOUS];
    let [given, refitted, improved] = [0, 1, 2].map(|of| &outcome.missing[of][number]);
    let measured = |row: usize| viscous * velocities[row] - refitted[row];
    let state: Vec<f32> = if by_position { &trial.position } else { &velocities }.iter().map(|x| *x as f32).collect();
    let first = trial.time.partition_point(|time| time - trial.time[0] < stretch_s[0]);
    let rows = traversals::limited(&state, 0..trial.len(), first);
    let time = |row: usize| trial.time.get(row).map_or(0.0, |time| time - trial.time[0]);
    let column = |value: &dyn Fn(usize) -> f64| rows.clone().map(|row| value(row) as f32).collect::<Vec<f32>>();
    Some(StatePlot {
        channel: CHANNEL,
        trial: trial.name.clone(),
        stretch_s,
        drawn_s: [time(rows.start), time(rows.end.saturating_sub(1))],
        along: if by_position { "position" } else { "speed" },
        unit: if by_position { coordinate.position_unit() } else { coordinate.velocity_unit() },
        ordinate: "effort beside inertia",
        ordinate_unit: coordinate.force_unit(),
        state: state.get(rows.clone())?.to_vec(),
        measured: column(&measured),
        as_given: column(&|row| measured(row) + given[row]),
        refitted: column(&|row| measured(row) + refitted[row]),
        improved: column(&|row| measured(row) + improved[row]),
        learned: Vec::new(),
    })
}
