//! Where a coarse encoder's steps tell more than their height: the instants at which it steps.
//!
//! A reading that stays on one count for several rows is off by up to half a step, and off in the same direction for as
//! long. But at the row where it leaves the count the position is known: it is the boundary between the two. Between two
//! such instants the motion is taken as a cubic. Where the reading steps at every row there is nothing to gain, and the
//! reading stays as it is.

use crate::diagnose::thresholds::dequantize::MIN_ROWS_ON_COUNT;

/// A stretch of rows on one count.
#[derive(Debug, Clone, Copy)]
struct CountRun {
    first: usize,
    /// One beyond the last.
    end: usize,
    level: f64,
}

/// An instant at which the position is known.
#[derive(Debug, Clone, Copy)]
struct Transition {
    time: f64,
    value: f64,
}

/// Replaces readings in steps of `step` by the motion that its steps tell.
pub fn dequantize(time: impl Fn(usize) -> f64, values: &mut [f64], step: f64) {
    if step <= 0.0 {
        return;
    }
    let runs = runs(values, step);
    let knot = |left: &CountRun, right: &CountRun| Transition {
        time: 0.5 * (time(left.end - 1) + time(right.first)),
        value: 0.5 * (left.level + right.level),
    };
    let knots: Vec<Transition> = runs.windows(2).map(|pair| knot(&pair[0], &pair[1])).collect();
    // Run i lies between knots i - 1 and i.
    for at in 1..runs.len().saturating_sub(1) {
        let run = runs[at];
        if run.end - run.first >= MIN_ROWS_ON_COUNT {
            let slope_in = slope(&knots, at - 1);
            let slope_out = slope(&knots, at);
            fill(&time, values, run, (knots[at - 1], slope_in), (knots[at], slope_out), step);
        }
    }
}

fn runs(values: &[f64], step: f64) -> Vec<CountRun> {
    let mut runs: Vec<CountRun> = Vec::new();
    for (row, &level) in values.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if (run.level - level).abs() < 0.5 * step => run.end = row + 1,
            _ => runs.push(CountRun { first: row, end: row + 1, level }),
        }
    }
    runs
}

/// Slope of the parabola through a knot and its neighbours.
fn slope(knots: &[Transition], at: usize) -> f64 {
    let secant = |a: Transition, b: Transition| (b.value - a.value) / (b.time - a.time);
    match (at.checked_sub(1).map(|before| knots[before]), knots.get(at + 1)) {
        (Some(before), Some(after)) => {
            let (left, right) = (knots[at].time - before.time, after.time - knots[at].time);
            (right * secant(before, knots[at]) + left * secant(knots[at], *after)) / (left + right)
        }
        (Some(before), None) => secant(before, knots[at]),
        (None, Some(after)) => secant(knots[at], *after),
        (None, None) => 0.0,
    }
}

/// The cubic between two knots, kept within what the count allows.
fn fill(
    time: &impl Fn(usize) -> f64,
    values: &mut [f64],
    run: CountRun,
    (from, slope_in): (Transition, f64),
    (to, slope_out): (Transition, f64),
    step: f64,
) {
    let span = to.time - from.time;
    let far = if (to.value - from.value).abs() >= 0.5 * step {
        to.value
    } else if (span * (slope_in - slope_out) / 8.0).abs() <= step {
        // A tool that turns back within a count goes in as far as its slopes at either end carry it.
        2.0 * run.level - from.value
    } else {
        // One that went in faster than that and stayed has come to rest, at the middle of the count as far as anyone knows.
        run.level
    };
    let (low, high) = (from.value.min(far), from.value.max(far));
    for (row, value) in values.iter_mut().enumerate().take(run.end).skip(run.first) {
        let s = (time(row) - from.time) / span;
        let (s2, s3) = (s * s, s * s * s);
        let cubic = (2.0 * s3 - 3.0 * s2 + 1.0) * from.value
            + (s3 - 2.0 * s2 + s) * span * slope_in
            + (3.0 * s2 - 2.0 * s3) * to.value
            + (s3 - s2) * span * slope_out;
        *value = cubic.clamp(low, high);
    }
}
