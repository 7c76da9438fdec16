//! Readings that stand still where they should move: constant columns, frozen channels, clipping.

use super::checked_trial::{CheckedTrial, bounds, middle, range};
use super::ranked_finding::RankedFinding;
use super::wording::{digits, quantity};
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_stuck_channel::{
    FROZEN_ROWS, MIN_EQUAL_ROWS, MIN_MOVED_FRACTION, MOVED_FRACTION_INSIDE_RANGE, NOISE_OVER_STEP,
};
use crate::sensors::white_noise;

/// Columns that do not change at all.
pub fn dead(view: &CheckedTrial<'_>) -> Vec<RankedFinding> {
    let recording = view.recording;
    let columns = [
        ("dead_position", "position", Some(&recording.position)),
        ("dead_force", "force", recording.force.as_ref()),
        ("dead_effort", "effort", recording.effort.as_ref()),
    ];
    let dead = columns.into_iter().filter_map(|(kind, name, values)| {
        let values = values?;
        let (low, high) = bounds(values);
        let unit = if name == "position" { view.length } else { view.push };
        let text = format!(
            "The {name} column is {} in every row: nothing was measured there. Check the channel, or leave the column out.",
            quantity(low, unit),
        );
        (low == high).then(|| RankedFinding::grave(kind, format!("{}, {name}", view.name()), 1.0, text))
    });
    dead.collect()
}

/// A stretch of equal readings.
#[derive(Clone, Copy)]
struct Run {
    first: usize,
    /// One beyond the last.
    end: usize,
}

fn runs(values: &[f64]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for row in 0..values.len() {
        match runs.last_mut() {
            Some(run) if values[run.first] == values[row] => run.end = row + 1,
            _ => runs.push(Run { first: row, end: row + 1 }),
        }
    }
    runs.retain(|run| run.end - run.first >= MIN_EQUAL_ROWS && run.end - run.first < values.len());
    runs
}

/// Channels that stand still for a while though they should not.
pub fn stuck(view: &CheckedTrial<'_>) -> Vec<RankedFinding> {
    let force = view.recording.force.as_ref().map(|force| force_stuck(view, force));
    let effort = view.recording.effort.as_ref().map(|effort| effort_clipped(view, effort));
    [Some(position_stuck(view)), force, effort].into_iter().flatten().flatten().collect()
}

/// Adds the rows of runs up and words them: at the channel's own end clipped, else stuck.
fn word(view: &CheckedTrial<'_>, name: &str, values: &[f64], found: &[Run]) -> Option<RankedFinding> {
    let longest = found.iter().copied().max_by_key(|run| run.end - run.first)?;
    let (low, high) = bounds(values);
    let value = values[longest.first];
    let clipped = value == low || value == high;
    let same = |run: &&Run| values[run.first] == value;
    let rows: usize = found.iter().filter(same).map(|run| run.end - run.first).sum();
    let share = rows as f64 / values.len() as f64;
    let time = &view.recording.time;
    let unit = if name == "position" { view.length } else { view.push };
    let place =
        format!("{}, {name}, {} to {} s", view.name(), digits(time[longest.first]), digits(time[longest.end - 1]));
    let head =
        format!("The {name} stays at exactly {} for {} rows", quantity(value, unit), longest.end - longest.first);
    let (kind, text) = match (name, clipped) {
        ("position", true) => (
            "clipped_position",
            format!(
                "{head}, its own end, while other channels move on: the sensor clips or the counter has ended. Move its range."
            ),
        ),
        ("position", false) => (
            "stuck_position",
            format!(
                "{head} while other channels move on: the sensor hung, or the reading was not refreshed. Check its read-out, or cut the stretch."
            ),
        ),
        ("force", true) => (
            "clipped_force",
            format!(
                "{head}, its own end, while the tool moves on: the sensor or its converter clips. Press less, or use a wider range."
            ),
        ),
        ("force", false) => (
            "stuck_force",
            format!(
                "{head} though it should change: the sensor hung, or the reading was not refreshed. Check its read-out, or cut the stretch."
            ),
        ),
        (_, _) => (
            "clipped_effort",
            format!(
                "{head}, its own end, while the motion changes: the drive or the channel is at its limit. If the limit lies behind the channel, the tool got less than the column says; keep below it."
            ),
        ),
    };
    // A known limit of force or effort is an effect of its own; a position that is not true spoils all there is.
    let grave = name == "position" && share > 0.01 || share > 0.25 && name != "effort";
    Some(RankedFinding { grave, ..RankedFinding::mild(kind, place, share, text) })
}

/// Whether `values` carry noise that would show in every row.
fn is_noisy(view: &CheckedTrial<'_>, values: &[f64], resolution: f64) -> bool {
    let noise = white_noise(&view.recording.time, values);
    noise > NOISE_OVER_STEP * resolution && noise > 1e-5 * range(values)
}

/// A column of the even clock at a recorded row: without its drop-outs.
fn at(view: &CheckedTrial<'_>, column: &[f64], row: usize) -> f64 {
    let place = (view.recording.time[row] - view.raw.origin) / view.raw.period;
    column[(place.round().max(0.0) as usize).min(column.len() - 1)]
}

fn force_stuck(view: &CheckedTrial<'_>, force: &[f64]) -> Option<RankedFinding> {
    let channel = view.raw.figures.force?;
    let position = &view.recording.position;
    let inside: Vec<f64> = view.depth.iter().copied().filter(|depth| *depth > 0.0).collect();
    let whole = range(force);
    let slope = whole / range(if inside.len() > MIN_EQUAL_ROWS { &inside } else { &view.depth });
    let least = (MIN_MOVED_FRACTION * whole).max(4.0 * channel.resolution).max(6.0 * channel.noise).value();
    let noisy = is_noisy(view, force, channel.resolution);
    let ends = bounds(force);
    // What is read where nothing touches is the middle of the lower half, whatever the surface.
    let idle = quantile(force.to_vec(), 0.02).unwrap_or(0.0);
    let standing = |run: &Run| {
        let (low, high) = bounds(&position[run.first..run.end]);
        let is_idle = (force[run.first] - idle).abs() < least.min(0.1 * whole);
        let is_end = force[run.first] == ends.0 || force[run.first] == ends.1;
        let moved = slope * (high - low);
        // Damping can hold a force still for a moment while the tool slows down: only at its end is a little enough.
        let enough = if is_end { least } else { (MOVED_FRACTION_INSIDE_RANGE * whole).max(2.0 * least).value() };
        (!is_idle && slope.is_finite() && moved > enough) || noisy && run.end - run.first >= FROZEN_ROWS
    };
    let found: Vec<Run> = runs(force).into_iter().filter(standing).collect();
    word(view, "force", force, &found)
}

fn position_stuck(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let position = &view.recording.position;
    let time = &view.recording.time;
    let channel = view.raw.figures.position;
    let force = view.raw.force.as_ref().zip(view.raw.figures.force);
    let rise = |run: &Run| {
        let Some((force, sensor)) = force else { return false };
        let (mut least, mut rise) = (f64::INFINITY, 0.0f64);
        for row in run.first..run.end {
            let now = at(view, force, row);
            least = least.min(now);
            rise = rise.max(now - least);
        }
        // A held contact relaxes: its force falls. One that rises means motion.
        rise > (4.0 * MIN_MOVED_FRACTION * range(force)).max(8.0 * sensor.noise)
    };
    let travelled = |run: &Run| {
        let Some(velocity) = &view.recording.velocity else { return false };
        let way: f64 = (run.first + 1..run.end)
            .map(|row| 0.5 * (velocity[row] + velocity[row - 1]) * (time[row] - time[row - 1]))
            .sum();
        let seen: Vec<f64> = velocity[run.first..run.end].iter().map(|speed| speed.abs()).collect();
        let usual = quantile(velocity.iter().map(|speed| speed.abs()).collect(), 0.95);
        // A small bias of the velocity adds up over a long rest, and means nothing.
        let is_fast = middle(seen) > usual.map(|usual| 0.1 * usual);
        is_fast && way.abs() > (MIN_MOVED_FRACTION * range(position)).max(5.0 * channel.resolution)
    };
    let standing = |run: &Run| rise(run) && is_abrupt(position, *run, channel.resolution) || travelled(run);
    let found: Vec<Run> = runs(position).into_iter().filter(standing).collect();
    word(view, "position", position, &found)
}

/// Whether a position stops or starts as no tool does: it leaps when it comes free again, or ends at full speed. A tool
/// that is held may feel its surface move; it came to rest before.
fn is_abrupt(position: &[f64], run: Run, resolution: f64) -> bool {
    let steps: Vec<f64> = position.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let [usual, fast] = [0.95, 0.99].map(|at| quantile(steps.clone(), at).unwrap_or(0.0));
    let (low, high) = bounds(position);
    let ends = position[run.first] == low || position[run.first] == high || run.end == position.len();
    let leap = position.get(run.end).map_or(0.0, |next| (next - position[run.first]).abs());
    let before = run.first.saturating_sub(MIN_EQUAL_ROWS);
    let way = (position[run.first] - position[before]).abs();
    let entry = way > (0.25 * usual * MIN_EQUAL_ROWS as f64).max(2.0 * resolution);
    leap > (4.0 * fast).max(4.0 * resolution) || ends && entry
}

fn effort_clipped(view: &CheckedTrial<'_>, effort: &[f64]) -> Option<RankedFinding> {
    let (low, high) = bounds(effort);
    let mut levels = effort.to_vec();
    levels.sort_unstable_by(f64::total_cmp);
    levels.dedup();
    // A switched drive is always at one of its levels.
    if levels.len() < MIN_EQUAL_ROWS {
        return None;
    }
    let position = &view.recording.position;
    let least = (MIN_MOVED_FRACTION * range(position)).max(4.0 * view.raw.figures.position.resolution);
    let at_end = |run: &Run| {
        let value = effort[run.first];
        let (from, to) = bounds(&position[run.first..run.end]);
        value != 0.0 && (value == low || value == high) && to - from > least
    };
    let found: Vec<Run> = runs(effort).into_iter().filter(at_end).collect();
    word(view, "effort", effort, &found)
}
