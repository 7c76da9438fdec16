//! The traces inside the page.

use super::super::diagnosis::{Diagnosis, PlotData, Trace, Verdict};
use super::trial::{Trial, compared, lines};
use crate::page::{column, thin};
use serde::Serialize;
use std::io::{self, Write};

/// Numbers that a row of a trace takes: a time counts twice.
const NUMBERS_PER_ROW: usize = 10;

#[derive(Serialize)]
struct Description<'a> {
    position: &'a str,
    force: &'a str,
    lines: Vec<DescribedLine>,
    compared: Vec<&'a str>,
    trials: Vec<DescribedTrial>,
}

#[derive(Serialize)]
struct DescribedLine {
    key: &'static str,
    name: String,
}

#[derive(Serialize)]
struct DescribedTrial {
    traces: Vec<DescribedTrace>,
    /// The largest first, in seconds from the first row.
    places: Vec<DescribedPlace>,
    /// The shortest stretch that shows the answer, where it shows in this trial.
    opens: Option<[f64; 2]>,
    /// Whether depths count from a surface.
    touches: bool,
}

#[derive(Serialize)]
struct DescribedTrace {
    id: usize,
    channel: &'static str,
    rows: usize,
}

#[derive(Serialize)]
struct DescribedPlace {
    channel: &'static str,
    start: f64,
    end: f64,
}

/// Writes description and columns of every trial.
pub(super) fn write(
    answer: &Diagnosis,
    pictures: &PlotData,
    trials: &[Trial<'_>],
    out: &mut impl Write,
) -> io::Result<()> {
    let description = Description {
        position: pictures.position_unit,
        force: pictures.force_unit,
        lines: lines(answer, pictures)
            .into_iter()
            .map(|line| DescribedLine { key: line.key, name: line.name })
            .collect(),
        compared: compared(answer, pictures),
        trials: trials.iter().map(|trial| describe(trial, answer, pictures)).collect(),
    };
    column::description(&description, out)?;
    let budget = thin::budget(NUMBERS_PER_ROW * pictures.traces.len());
    for trial in trials {
        for (id, trace) in &trial.traces {
            columns(*id, trace, &shown(trial, trace, budget), out)?;
        }
    }
    Ok(())
}

fn describe(trial: &Trial<'_>, answer: &Diagnosis, pictures: &PlotData) -> DescribedTrial {
    let traces = trial.traces.iter();
    let places = trial.places.iter().filter(|place| place.start_s.is_finite() && place.end_s.is_finite());
    DescribedTrial {
        traces: traces.map(|(id, t)| DescribedTrace { id: *id, channel: t.channel, rows: t.time.len() }).collect(),
        places: places
            .map(|place| DescribedPlace { channel: place.channel, start: place.start_s, end: place.end_s })
            .collect(),
        opens: opens(trial, answer, pictures),
        touches: trial.traces.iter().any(|(_, trace)| trace.channel == "force")
            && !pictures.evidence.iter().any(|plot| plot.channel == "force" && plot.along == "position"),
    }
}

/// The stretch that a trial opens on; none where nothing is to be shown.
fn opens(trial: &Trial<'_>, answer: &Diagnosis, pictures: &PlotData) -> Option<[f64; 2]> {
    let plot = pictures.evidence.iter().find(|plot| plot.trial == trial.name)?;
    (answer.verdict != Verdict::NoMismatch).then_some(plot.stretch_s)
}

/// The rows that look like all of them, and of the largest places as many as may be, for there the page looks closely.
fn shown(trial: &Trial<'_>, trace: &Trace, budget: usize) -> Vec<usize> {
    let mut certain = thin::edges(&trace.valid, budget / 8);
    certain.extend(close_look(trial, trace, budget / 3));
    let left = |model: &[f32]| -> Vec<f32> {
        trace
            .measured
            .iter()
            .zip(model)
            .zip(&trace.valid)
            .map(|((m, s), valid)| if *valid { m - s } else { f32::NAN })
            .collect()
    };
    let residuals = [left(&trace.as_given), left(&trace.refitted), left(&trace.improved)];
    let signals = [&trace.measured, &trace.depth, &residuals[0], &residuals[1], &residuals[2]];
    thin::rows(trace.time.len(), &certain, &signals.map(Vec::as_slice), budget)
}

fn close_look(trial: &Trial<'_>, trace: &Trace, most: usize) -> Vec<usize> {
    let mut rows = Vec::new();
    for place in trial.places.iter().filter(|place| place.channel == trace.channel) {
        let origin = trace.time[0];
        // As much again to both sides, for the page opens a little wider than the place is.
        let margin = place.end_s - place.start_s;
        let from = trace.time.partition_point(|time| *time < origin + place.start_s - margin);
        let until = trace.time.partition_point(|time| *time <= origin + place.end_s + margin);
        let room = most.saturating_sub(rows.len());
        let every = until.saturating_sub(from).div_ceil(room.max(1)).max(1);
        rows.extend((from..until).step_by(every).take(room));
    }
    rows
}

fn columns(id: usize, trace: &Trace, rows: &[usize], out: &mut impl Write) -> io::Result<()> {
    // The first row is the origin: it is what the places count from, and a clock since 1970 has no room for digits.
    column::write(out, &format!("t{id}-time"), rows, |row| (trace.time[row] - trace.time[0]).to_le_bytes())?;
    column::write(out, &format!("t{id}-seen"), rows, |row| [u8::from(trace.valid[row])])?;
    let floats = [
        ("depth", &trace.depth),
        ("measured", &trace.measured),
        ("given", &trace.as_given),
        ("refitted", &trace.refitted),
        ("improved", &trace.improved),
        ("floor", &trace.expected_noise),
    ];
    for (name, values) in floats {
        column::write(out, &format!("t{id}-{name}"), rows, |row| values[row].to_le_bytes())?;
    }
    if !trace.learned.is_empty() {
        column::write(out, &format!("t{id}-learned"), rows, |row| trace.learned[row].to_le_bytes())?;
    }
    Ok(())
}
