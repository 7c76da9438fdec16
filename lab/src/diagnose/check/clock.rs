//! The time base: gaps, uneven sampling, rates that differ, drop-outs, too few or too slow rows.

use super::checked_trial::{CheckedTrial, bounds, range};
use super::ranked_finding::RankedFinding;
use super::wording::{count, digits, quantity};
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_clock::{
    FEW_ROWS, MAX_JITTER, PERIOD_RATIO, RATE_CHANGE_RATIO, RATE_SEGMENTS, TOO_FEW_ROWS,
};
use crate::rig::Rig;

/// What is wrong with the clock of one trial.
pub fn faults(view: &CheckedTrial<'_>) -> Vec<RankedFinding> {
    let rates = two_rates(view);
    let uneven = if rates.is_none() { jitter(view) } else { None };
    // Rows of a slower stretch are no loss; the change of rate is reported by itself.
    let gaps = if rates.is_none() { gaps(view) } else { None };
    [gaps, rates, uneven, dropouts(view)].into_iter().flatten().collect()
}

fn gaps(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let gaps = &view.raw.gaps;
    let longest = gaps.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let lost: f64 = gaps.iter().map(|gap| gap.1).sum();
    let share = lost / (view.raw.len() as f64 * view.raw.period);
    let at = view.raw.origin + longest.0;
    let grave = share > 0.5;
    let text = format!(
        "{} in the time column, the longest of {} at {} s, {:.1} % of the trial in all. What lies in a gap, and close beside it, is left out; \
         look for lost packets or a blocked logger.",
        count(gaps.len(), "gap"),
        quantity(longest.1, "s"),
        digits(at),
        100.0 * share,
    );
    Some(RankedFinding { grave, ..RankedFinding::mild("gaps", format!("{}, time", view.name()), share, text) })
}

fn intervals(view: &CheckedTrial<'_>) -> Vec<f64> {
    view.recording.time.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn two_rates(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let steps = intervals(view);
    let size = steps.len() / RATE_SEGMENTS;
    if size < 4 {
        return None;
    }
    // The mean of the quartiles: the median of a clock that goes long and short in turn falls on either.
    let usual = |piece: &[f64]| Some(0.5 * (quantile(piece.to_vec(), 0.25)? + quantile(piece.to_vec(), 0.75)?));
    let pieces: Vec<f64> = steps.chunks_exact(size).filter_map(usual).collect();
    let (short, long) = bounds(&pieces);
    let change = pieces.windows(2).position(|pair| pair[1].max(pair[0]) > RATE_CHANGE_RATIO * pair[1].min(pair[0]))?;
    let at = view.recording.time[(change + 1) * size];
    let left_out = match view.raw.gaps.len() {
        0 => "Quick effects are seen in the faster part only".to_owned(),
        gaps => format!("{} of the slower part count as gaps and are left out", count(gaps, "interval")),
    };
    let text = format!(
        "The sample rate changes within the trial, near {} s: rows {} apart in one part, {} in another. {left_out}; record at one rate, or cut the \
         trial there.",
        digits(at),
        quantity(short, "s"),
        quantity(long, "s"),
    );
    Some(RankedFinding::mild("two_rates", format!("{}, time", view.name()), long / short, text))
}

fn jitter(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let period = view.recording.period();
    let near: Vec<f64> = intervals(view).into_iter().filter(|step| *step < 3.5 * period).collect();
    let spread = quantile(near.iter().map(|step| (step - period).abs()).collect(), 0.9)? / period;
    if near.len() < 10 || spread < MAX_JITTER {
        return None;
    }
    let low = quantile(near.clone(), 0.05)?;
    let high = quantile(near, 0.95)?;
    let text = format!(
        "The clock is uneven: nine in ten rows are {} to {} apart. If the sensors were read evenly and the stamps were set late, speeds are wrong by as \
         much: stamp rows where they are read.",
        quantity(low, "s"),
        quantity(high, "s"),
    );
    Some(RankedFinding::mild("jitter", format!("{}, time", view.name()), spread, text))
}

fn dropouts(view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let first = view.raw.dropouts.first()?;
    let number = view.raw.dropouts.len();
    let share = number as f64 / view.recording.time.len() as f64;
    let text = format!(
        "{}, the first at {} s: a single reading far outside all others. Replaced by a straight line; check the sensor's cable and read-out. A \
         commanded effort may truly kick for one row.",
        count(number, "drop-out"),
        digits(view.raw.origin + first),
    );
    Some(RankedFinding {
        grave: share > 0.02,
        ..RankedFinding::mild("dropouts", format!("{}, {}", view.name(), leaping(view, *first)), number as f64, text)
    })
}

/// The channel that leaps the most at `at` seconds, over its range.
fn leaping(view: &CheckedTrial<'_>, at: f64) -> &'static str {
    let recording = view.recording;
    let last = recording.time.len() - 1;
    let row = recording.time.partition_point(|time| time - view.raw.origin < at - 0.25 * view.raw.period).min(last);
    let leap = |values: &[f64]| (values[row] - values[row.saturating_sub(1)]).abs() / range(values);
    let columns = [("force", recording.force.as_ref()), ("effort", recording.effort.as_ref())];
    let others = columns.into_iter().filter_map(|(name, values)| Some((name, leap(values?))));
    let all = std::iter::once(("position", leap(&recording.position))).chain(others);
    all.filter(|(_, leap)| leap.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1)).map_or("position", |(name, _)| name)
}

/// What is wrong with the clocks of all trials together, and with the clock for this rig.
pub fn together(rig: &Rig, views: &[CheckedTrial<'_>]) -> Vec<RankedFinding> {
    [differing(views), too_few(views), too_slow(rig, views)].into_iter().flatten().collect()
}

fn differing(views: &[CheckedTrial<'_>]) -> Option<RankedFinding> {
    let slow = views.iter().max_by(|a, b| a.recording.period().total_cmp(&b.recording.period()))?;
    let fast = views.iter().min_by(|a, b| a.recording.period().total_cmp(&b.recording.period()))?;
    let (long, short) = (slow.recording.period(), fast.recording.period());
    let text = format!(
        "The trials differ in rate: rows {} apart here, {} in {}. All are analysed at the slowest rate; diagnose the fast ones by themselves to \
         see quick effects.",
        quantity(long, "s"),
        quantity(short, "s"),
        fast.name(),
    );
    (long > PERIOD_RATIO * short)
        .then(|| RankedFinding::mild("differing_rates", format!("{}, time", slow.name()), long / short, text))
}

fn too_few(views: &[CheckedTrial<'_>]) -> Option<RankedFinding> {
    let rows: usize = views.iter().map(|view| view.recording.time.len()).sum();
    let text = format!(
        "Only {} in all. Few effects can be distinguished, and only strong ones; some hundreds of rows are needed, thousands are better: record \
         longer or faster.",
        count(rows, "row"),
    );
    (rows < FEW_ROWS)
        .then(|| RankedFinding { grave: rows < TOO_FEW_ROWS, ..RankedFinding::mild("few_rows", "", 0.0, text) })
}

fn too_slow(rig: &Rig, views: &[CheckedTrial<'_>]) -> Option<RankedFinding> {
    let period = views.first()?.raw.period;
    let force = views.iter().any(|view| view.force.is_some());
    let effort = views.iter().any(|view| view.effort.is_some());
    let contact = rig.contact.filter(|contact| force && contact.damping > 0.0 && contact.stiffness > 0.0);
    let drive = rig.drive.filter(|drive| effort && drive.viscous > 0.0);
    let times = [
        contact.map(|contact| (contact.damping / contact.stiffness, "the contact's damping over stiffness")),
        drive.map(|drive| (drive.inertia / drive.viscous, "the drive's inertia over friction")),
    ];
    let (time, what) = times.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let text = format!(
        "Rows are {} apart, too slow for this rig: {what} is {}. What happens within that time is seen blurred or not at all; damping, delays and \
         lags least of all. Record at {} Hz or more.",
        quantity(period, "s"),
        quantity(time, "s"),
        digits((4.0 / time).ceil()),
    );
    (period > 0.5 * time).then(|| RankedFinding::mild("slow_sampling", "time", 0.0, text))
}
