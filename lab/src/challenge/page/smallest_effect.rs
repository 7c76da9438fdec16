//! An effect that no eye sees, and what is said of it.

use crate::page::effect_name::effect_name;
use crate::page::quantity::{between, rounded, seconds};
use std::fmt::Write as _;

use maud::{Markup, html};
use palpate_cases::truth::CaseKind;
use palpate_cases::{CaseRequest, EffectSelection, SimulatorKind, draw};

use super::super::case_files::{self, CaseFiles};
use super::super::case_score::CaseScore;
use super::super::challenge_score::ChallengeScore;
use super::super::scored_case::ScoredCase as _;
use super::super::statistics::median;
use crate::diagnose::diagnose;
use crate::diagnose::report::diagnosis::Trace;

/// Rows of the picture.
const PICTURE_ROWS: usize = 900;

/// Deviation of normal noise over the median of its absolute value: rows at the very touch do not count.
const DEVIATION_OVER_MAD: f64 = 1.4826;

/// What is drawn, row by row.
struct Picture {
    unit: &'static str,
    time: Vec<f64>,
    recorded: Vec<f64>,
    simulated: Vec<f64>,
    /// What the named effect changes of the simulation.
    effect: Vec<f64>,
    deviation: f64,
    named: String,
}

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let Some((row, picture)) = smallest(challenge).and_then(|row| Some((row, picture(row)?))) else { return html! {} };
    html! {
        section {
            h2 { "The smallest effect that was named correctly" }
            p {
                "Case " (row.index) ": " (effect_name(&row.truth.join(" and "))) " of " (format!("{:.2}", row.strength))
                " of the expected noise. Recorded force and the simulation without it, values refitted, lie over one another; row by row the difference \
                 is noise, and the effect, as the tool models it, runs within. The tool says: " strong { (picture.named) }
            }
            (panel("Force over time", picture.unit, &picture.time, &[("recorded", &picture.recorded), ("simulated", &picture.simulated)]))
            p.legend { span.recorded { "● recorded" } "  " span.simulated { "━ simulated without the effect" } }
            (panel("Recorded less simulated", picture.unit, &picture.time,
                &[("recorded", &difference(&picture)), ("effect", &picture.effect)]))
            p.legend {
                span.recorded { "● recorded less simulated, standard deviation " (rounded(picture.deviation, picture.unit, 2)) } "  "
                span.effect { "━ what the named effect changes" }
            }
        }
    }
}

/// The smallest effect of our own simulation that was named rightly.
fn smallest(challenge: &ChallengeScore) -> Option<&CaseScore> {
    let own = |row: &&CaseScore| row.source == SimulatorKind::Own && row.kind == CaseKind::Single && row.is_right();
    let in_force = |row: &&CaseScore| row.strength < 1.0 && !row.truth.is_empty();
    challenge.rows.iter().filter(own).filter(in_force).min_by(|a, b| a.strength.total_cmp(&b.strength))
}

/// Draws the case anew, and diagnoses it; none where that fails or its effect does not show in the force.
fn picture(row: &CaseScore) -> Option<Picture> {
    let what = EffectSelection::Single { name: row.truth.first().cloned(), strength: None };
    let case = draw(row.seed, row.index, &CaseRequest { selection: Some(what), ..CaseRequest::default() }).ok()?;
    let folder = tempfile::tempdir().ok()?;
    case.write(folder.path()).ok()?;
    let CaseFiles { rig, origin, trials } = case_files::read(folder.path()).ok()?;
    let found = diagnose(&rig, &origin, &trials, &[], 1, &|_| ()).ok()?;
    let traces = found.pictures.traces.iter();
    let size = |trace: &Trace| change(trace).map(|c| c * c).sum::<f64>() / trace.time.len().max(1) as f64;
    let trace = traces.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let trial = trials.iter().find(|trial| trial.name == trace.trial)?;
    let raw = if trace.channel == "force" { trial.force.as_ref()? } else { trial.effort.as_ref()? };
    let middle = busiest(trace);
    let first = middle.saturating_sub(PICTURE_ROWS / 2);
    let rows: Vec<usize> = (first..(first + PICTURE_ROWS).min(trace.time.len())).collect();
    let nearest = |time: f64| trial.time.partition_point(|t| *t < time - 1e-9).min(raw.len() - 1);
    let recorded: Vec<f64> = rows.iter().map(|row| raw[nearest(trace.time[*row])]).collect();
    let simulated: Vec<f64> = rows.iter().map(|row| f64::from(trace.refitted[*row])).collect();
    let changes: Vec<f64> = change(trace).collect();
    let apart = median(recorded.iter().zip(&simulated).map(|(recorded, simulated)| (recorded - simulated).abs()));
    Some(Picture {
        unit: found.pictures.force_unit,
        time: rows.iter().map(|row| trace.time[*row]).collect(),
        effect: rows.iter().map(|row| changes[*row]).collect(),
        deviation: DEVIATION_OVER_MAD * apart,
        recorded,
        simulated,
        named: found.answer.summary.clone(),
    })
}

fn change(trace: &Trace) -> impl Iterator<Item = f64> {
    trace.improved.iter().zip(&trace.refitted).map(|(improved, refitted)| f64::from(improved - refitted))
}

/// The row about which the effect changes most.
fn busiest(trace: &Trace) -> usize {
    let changes: Vec<f64> = change(trace).map(|c| c * c).collect();
    let mut sum: f64 = changes.iter().take(PICTURE_ROWS).sum();
    let (mut best, mut at) = (sum, 0);
    for end in PICTURE_ROWS..changes.len() {
        sum += changes[end] - changes[end - PICTURE_ROWS];
        if sum > best {
            (best, at) = (sum, end + 1 - PICTURE_ROWS);
        }
    }
    at + PICTURE_ROWS / 2
}

fn difference(picture: &Picture) -> Vec<f64> {
    picture.recorded.iter().zip(&picture.simulated).map(|(recorded, simulated)| recorded - simulated).collect()
}

/// Between what all but a few values lie: a row at the very touch is no measure for the rest.
fn most(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let cut = values.len() / 100;
    match (values.get(cut), values.get(values.len().saturating_sub(1 + cut))) {
        (Some(low), Some(high)) => {
            let room = 0.15 * (high - low);
            (low - room, high + room)
        }
        _ => (0.0, 1.0),
    }
}

/// Points for what is recorded, a line for all else, over time.
fn panel(title: &str, unit: &str, time: &[f64], series: &[(&str, &Vec<f64>)]) -> Markup {
    let (low, high) = most(series.iter().flat_map(|(_, values)| values.iter().copied()).collect());
    let span = (high - low).max(f64::MIN_POSITIVE);
    let (start, end) = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(1.0));
    let x = |t: f64| 1000.0 * (t - start) / (end - start).max(f64::MIN_POSITIVE);
    let y = |v: f64| 195.0 - 190.0 * (v.clamp(low, high) - low) / span;
    let path = |name: &str, values: &[f64]| {
        let points = time.iter().zip(values).map(|(t, v)| (x(*t), y(*v)));
        points.enumerate().fold(String::new(), |mut text, (at, (x, y))| {
            // A point is a line of no length with round ends.
            let _ = match (name, at) {
                ("recorded", _) => write!(text, "M{x:.1} {y:.1}h0"),
                (_, 0) => write!(text, "M{x:.1} {y:.1}"),
                _ => write!(text, "L{x:.1} {y:.1}"),
            };
            text
        })
    };
    html! {
        figure.trace {
            figcaption { (title) ": " (between(low, high, unit)) ", over " (seconds(end - start)) }
            svg viewBox="0 0 1000 200" preserveAspectRatio="none" role="img" aria-label=(title) height="200" {
                @for (name, values) in series { path class=(name) d=(path(name, values)) vector-effect="non-scaling-stroke" {} }
            }
        }
    }
}
