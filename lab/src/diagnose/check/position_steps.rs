//! Readings that leap, and sensors that step too coarsely for the motion.

use super::checked_trial::{CheckedTrial, range};
use super::ranked_finding::RankedFinding;
use super::wording::{count, digits, quantity};
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_position_steps::{
    BLIND_STEPS, COARSE_STEPS, GRAVE_JUMP_FRACTION, JUMP_RANGE_FRACTION, JUMP_RATE_RATIO, JUMP_RESOLUTION_STEPS,
    NOISE_RANGE_SIGMAS,
};
use crate::rig::Rig;

/// Positions that leap from one row to the next and stay there.
pub fn jumps(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let (time, position) = (&view.recording.time, &view.recording.position);
    let rate = |row: usize| (position[row + 1] - position[row]).abs() / (time[row + 1] - time[row]);
    let rates: Vec<f64> = (0..position.len() - 1).map(rate).collect();
    let usual = quantile(rates.clone(), 0.99)?;
    let whole = range(position);
    let dropped = |row: usize| {
        let near = 1.5 * view.recording.period();
        view.raw.dropouts.iter().any(|at| (at + view.raw.origin - time[row]).abs() < near)
    };
    let leaps: Vec<usize> = (0..rates.len())
        .filter(|&row| {
            let leap = (position[row + 1] - position[row]).abs();
            rates[row] > JUMP_RATE_RATIO * usual
                && leap > JUMP_RANGE_FRACTION * whole
                && leap > JUMP_RESOLUTION_STEPS * view.raw.figures.position.resolution
        })
        .filter(|&row| !dropped(row))
        .collect();
    let worst = leaps.iter().copied().max_by(|a, b| rates[*a].total_cmp(&rates[*b]))?;
    let leap = position[worst + 1] - position[worst];
    let text = format!(
        "The position leaps by {} in one row at {} s ({} in all), which no other row comes near: a contact that gives way or lets go at once, or a \
         counter that was reset, or two runs in one file. Unless the contact did it, cut the trial there.",
        quantity(leap, view.length),
        digits(time[worst + 1]),
        count(leaps.len(), "leap"),
    );
    let share = leap.abs() / whole;
    Some(RankedFinding {
        grave: share > GRAVE_JUMP_FRACTION,
        ..RankedFinding::mild("position_jump", format!("{}, position", view.name()), share, text)
    })
}

/// Sensors whose whole motion is a few of their steps.
pub fn coarse(rig: &Rig, view: &CheckedTrial<'_>) -> Vec<RankedFinding> {
    let figures = view.raw.figures;
    let deepest = quantile(view.depth.clone(), 0.99).unwrap_or(0.0);
    // Where the tool touches, the way it goes in is what the contact shows by.
    let touches = view.force.is_some() && rig.contact.is_some_and(|contact| !contact.bilateral) && deepest > 0.0;
    let (motion, where_) = if touches { (deepest, " in contact") } else { (range(&view.depth), "") };
    let force = view.recording.force.as_ref().zip(figures.force);
    let position = judge(motion, figures.position.resolution, figures.position.noise).map(|steps| RankedFinding {
        grave: steps < BLIND_STEPS,
        ..RankedFinding::mild(
            "coarse_position",
            format!("{}, position", view.name()),
            steps.recip(),
            format!(
                "The position sensor is coarse for this motion: {} is all the way{where_}, {} times what the sensor resolves. Move further, or use a \
                 finer encoder.",
                quantity(motion, view.length),
                digits(steps),
            ),
        )
    });
    let force = force.and_then(|(values, channel)| {
        let whole = range(values);
        let steps = judge(whole, channel.resolution, channel.noise)?;
        let text = format!(
            "The force sensor is coarse for this load: {} is all it moves by, {} times what the sensor resolves. Press harder, or use a more \
             sensitive sensor.",
            quantity(whole, view.push),
            digits(steps),
        );
        Some(RankedFinding { grave: steps < BLIND_STEPS, ..RankedFinding::mild("coarse_force", format!("{}, force", view.name()), steps.recip(), text) })
    });
    [position, force].into_iter().flatten().collect()
}

/// How many steps, or deviations of the noise, a motion has, where they are few.
fn judge(motion: f64, resolution: f64, noise: f64) -> Option<f64> {
    let steps = motion / resolution.max(noise);
    // A column that does not move at all, or by its noise only, is reported elsewhere.
    (motion > 0.0 && steps < COARSE_STEPS && (steps > NOISE_RANGE_SIGMAS || resolution >= noise)).then_some(steps)
}
