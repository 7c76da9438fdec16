//! What the page draws of a drive: effort over time, and what of it is friction and load over speed or position.

use super::diagnosis::{StatePlot, Trace};
use super::drive_report::{CHANNEL, found};
use super::drive_residual::velocity;
use super::traversals;
use crate::diagnose::drive::input::Inputs;
use crate::diagnose::drive::law::DriveLaw;
use crate::diagnose::drive::missing_force::missing_force;
use crate::diagnose::drive::model::index;
use crate::diagnose::drive::named::NamedEffect;
use crate::diagnose::drive::outcome::Outcome;
use crate::rig::Coordinate;

/// Effects that show over the position; all others are drawn over the speed.
const BY_POSITION: [&str; 2] = [GRAVITY_LOAD, COGGING];
const GRAVITY_LOAD: &str = "gravity_load";
const COGGING: &str = "cogging";

// What is missing pushes like an effort: a law that misses some asks for less effort than was measured, or, of friction, whose force is
// against the motion, for more. The effort that a law gives for the motion is what was measured and what it misses together.

/// One trace a trial.
pub(super) fn traces(outcome: &Outcome) -> Vec<Trace> {
    let whole = outcome.chosen.model.law(&outcome.chosen.values);
    let law = DriveLaw {
        effort_averaging: whole.effort_averaging,
        load_scale: whole.load_scale,
        ..DriveLaw::nominal(1.0, 0.0, whole.effort_delay_s)
    };
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
/// The inertia is the answer's: of refitted values without the missing physics it may be anything. What is left to friction and load is what
/// that inertia alone would miss, turned about; what a law gives of it is that and what the law misses together. Smoothed like the missing
/// force.
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
    let effects = found(outcome);
    let drawn = drawn(first_effect, &effects);
    let by_position = drawn.is_some_and(|name| BY_POSITION.contains(&name));
    let velocities: Vec<f64> = (0..trial.len()).map(|row| velocity(trial, row)).collect();
    let beside_inertia = beside_inertia(outcome, number);
    let [given, refitted, improved] = [0, 1, 2].map(|of| &outcome.missing[of][number]);
    let measured = |row: usize| beside_inertia[row];
    let state: Vec<f32> = if by_position { &trial.position } else { &velocities }.iter().map(|x| *x as f32).collect();
    let first = trial.time.partition_point(|time| time - trial.time[0] < stretch_s[0]);
    let rows = match ripple_pitch(&effects).filter(|_| drawn == Some(COGGING)) {
        Some(pitch) => a_few_pitches(&trial.position, first, pitch),
        None => traversals::limited(&state, 0..trial.len(), first),
    };
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

/// Pitches of a ripple that a picture can show.
const MOST_PITCHES: f64 = 6.0;

/// The effect that the picture is of: the first that the answer names. A constant load is as large everywhere, and gives way to a ripple beside it.
fn drawn<'a>(first: Option<&'a str>, effects: &[NamedEffect]) -> Option<&'a str> {
    let of = |name: &str| effects.iter().find(|effect| effect.name() == name);
    let is_constant = first == Some(GRAVITY_LOAD) && of(GRAVITY_LOAD).is_some_and(|load| load.values.len() == 1);
    if is_constant && of(COGGING).is_some() { Some(COGGING) } else { first }
}

/// The pitch of the cogging among `effects`.
fn ripple_pitch(effects: &[NamedEffect]) -> Option<f64> {
    let cogging = effects.iter().find(|effect| effect.name() == COGGING)?;
    let names = cogging.effect.spec().forms[cogging.form].parameters.iter().map(|parameter| parameter.name);
    names.zip(&cogging.values).find(|(name, _)| *name == "pitch").map(|(_, pitch)| pitch.abs())
}

/// The rows from `first` on that stay within a few pitches of where it stands.
fn a_few_pitches(position: &[f64], first: usize, pitch: f64) -> std::ops::Range<usize> {
    let first = first.min(position.len().saturating_sub(2));
    let stays = |at: &&f64| (**at - position[first]).abs() <= MOST_PITCHES * pitch;
    first..first + position[first..].iter().take_while(stays).count()
}

/// Effort less the inertia's part along a trial, smoothed as every law's missing force is.
fn beside_inertia(outcome: &Outcome, trial: usize) -> Vec<f64> {
    let (nominal, chosen) = (&outcome.nominal, &outcome.chosen);
    let common =
        nominal.noise.with_crossing(outcome.band_hz, nominal.model.scales.period_s, nominal.values[index::INERTIA]);
    let whole = chosen.model.law(&chosen.values);
    let bare = DriveLaw {
        effort_averaging: whole.effort_averaging,
        effort_lag_s: whole.effort_lag_s,
        limit: whole.limit,
        load_scale: whole.load_scale,
        force_gain_error: whole.force_gain_error,
        force_delay_s: whole.force_delay_s,
        tool_inertia: whole.tool_inertia,
        ..DriveLaw::nominal(whole.inertia, 0.0, whole.effort_delay_s)
    };
    missing_force(&outcome.trials[trial], &bare, &common, &common).into_iter().map(|missing| -missing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_load_gives_the_picture_to_a_ripple_beside_it_and_a_weight_that_turns_keeps_it() {
        let effect = |name: &str, form: usize, values: usize| NamedEffect {
            effect: crate::effects::find(name).unwrap(),
            form,
            values: vec![1.0; values],
            intervals: vec![[0.5, 1.5]; values],
        };
        let constant = || effect(GRAVITY_LOAD, 0, 1);
        let by_angle = || effect(GRAVITY_LOAD, 1, 3);
        let ripple = || effect(COGGING, 0, 3);
        assert_eq!(drawn(Some(GRAVITY_LOAD), &[constant(), ripple()]), Some(COGGING));
        assert_eq!(drawn(Some(GRAVITY_LOAD), &[by_angle(), ripple()]), Some(GRAVITY_LOAD));
        assert_eq!(drawn(Some(GRAVITY_LOAD), &[constant()]), Some(GRAVITY_LOAD));
        assert_eq!(drawn(Some("coulomb_friction"), &[constant(), ripple()]), Some("coulomb_friction"));
    }

    #[test]
    fn a_ripple_is_drawn_over_a_few_of_its_pitches() {
        let position: Vec<f64> = (0..1000).map(|row| 0.01 * f64::from(row)).collect();
        // Six pitches of 0.1 are sixty rows beside the first.
        let rows = a_few_pitches(&position, 100, 0.1);
        assert!(rows.start == 100 && (160..=162).contains(&rows.end), "{rows:?}");
        assert_eq!(a_few_pitches(&position, 5000, 0.1), 998..1000);
    }
}
