//! The report of a diagnosis: one self-contained page.

mod axis;
mod binned_residual;
mod correlations;
mod data;
mod effect;
mod evidence;
mod experiment;
mod finding;
mod fit_quality;
mod header;
mod locations;
mod nominal;
mod run;
mod state_plot;
mod trial;
mod wording;

use super::diagnosis::{Diagnosis, PlotData, StatePlot, Trace, Verdict};
use crate::page::shell;
use maud::html;
use std::io::{self, Write};

const STYLE: &str = include_str!("../../../assets/diagnose.css");
const SCRIPT: &str = include_str!("../../../assets/diagnose.js");

/// Writes the page. It needs nothing but itself: style, scripts and data are inside, and it forbids the browser to
/// fetch anything. Long trials are thinned to the rows that a screen can resolve.
///
/// # Errors
/// Whatever `out` reports; [`io::ErrorKind::InvalidInput`] where the vectors of a trace, a map or the experiment differ
/// in length.
pub fn write(answer: &Diagnosis, pictures: &PlotData, out: &mut impl Write) -> io::Result<()> {
    check(pictures)?;
    let trials = trial::group(answer, pictures);
    shell::open(&format!("{} – palpate diagnose", pictures.rig), STYLE, out)?;
    let body = html! {
        (header::header(answer, pictures))
        (evidence::section(answer, pictures))
        (fit_quality::section(answer))
        (trial::section(&trials, answer))
        (locations::section(answer, pictures))
        (nominal::section(answer, pictures))
        (correlations::section(answer))
        (finding::section(answer, pictures))
        (run::section(pictures.run.as_ref()))
    };
    out.write_all(body.0.as_bytes())?;
    data::write(answer, pictures, &trials, out)?;
    shell::close(&trial::templates(answer), SCRIPT, out)
}

/// Whether the answer names physics, and a model with it differs from one without.
fn names_physics(answer: &Diagnosis) -> bool {
    matches!(answer.verdict, Verdict::Explained | Verdict::PartlyExplained)
        || answer.physics.iter().any(|physics| physics.name != "unknown")
}

fn check(pictures: &PlotData) -> io::Result<()> {
    let torn_trace = pictures.traces.iter().find(|trace| !is_whole(trace)).map(|trace| trace.trial.as_str());
    let torn_plot = pictures.evidence.iter().find(|plot| !is_whole_plot(plot)).map(|plot| plot.along);
    let torn_map = pictures.maps.iter().find(|map| {
        let bins = map.labels.len();
        [map.before.len(), map.after.len(), map.share.len()].iter().any(|len| *len != bins)
    });
    let torn_experiment = pictures.experiment.as_ref().filter(|next| next.time.len() != next.reference.len());
    let torn = torn_trace.or(torn_plot).or(torn_map.map(|map| map.along)).or(torn_experiment.map(|_| "the experiment"));
    match torn {
        None => Ok(()),
        Some(what) => {
            let message = format!("{what}: the vectors of a picture must be of equal length");
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        }
    }
}

fn is_whole(trace: &Trace) -> bool {
    let columns =
        [&trace.depth, &trace.measured, &trace.as_given, &trace.refitted, &trace.improved, &trace.expected_noise];
    let rows = trace.time.len();
    let learned = [0, rows].contains(&trace.learned.len());
    trace.valid.len() == rows && learned && columns.iter().all(|column| column.len() == rows)
}

fn is_whole_plot(plot: &StatePlot) -> bool {
    let rows = plot.state.len();
    let columns = [&plot.measured, &plot.as_given, &plot.refitted, &plot.improved];
    [0, rows].contains(&plot.learned.len()) && columns.iter().all(|column| column.len() == rows)
}
