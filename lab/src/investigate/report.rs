//! The page of an investigation: what was open, what was run, what it answered.

mod intervals;
mod motion;

use crate::page::effect_name::effect_name;
use std::io::{self, Write};
use std::path::Path;

use maud::{Markup, html};

use super::questions::words;
use super::record::{Investigation, Round, State, TrialRecord, ValueState, round_folder};
use super::test_bed::Ending;
use crate::page::quantity::{plain, rounded};
use crate::page::shell;
use crate::recording::Recording;
use crate::rig::Rig;

const STYLE: &str = include_str!("../../assets/investigate.css");

/// Writes the page; the recordings of the rounds are read from `folder`. It needs nothing but itself.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(investigation: &Investigation, rig: &Rig, folder: &Path, out: &mut impl Write) -> io::Result<()> {
    shell::open(&format!("{} – palpate investigate", rig.name), STYLE, out)?;
    let body = html! {
        (opening(investigation, rig))
        (table(&investigation.rounds))
        (intervals::section(&investigation.rounds))
        @for round in &investigation.rounds { (section(round, investigation, rig, folder)) }
        (model(investigation))
    };
    out.write_all(body.0.as_bytes())?;
    shell::close(&html! {}, "", out)
}

fn opening(investigation: &Investigation, rig: &Rig) -> Markup {
    let trials = investigation.rounds.iter().filter(|round| round.trial.is_some()).count();
    let ended =
        investigation.outcome.map_or("It was interrupted; the same command resumes it.", |outcome| outcome.sentence());
    html! {
        header {
            p.eyebrow { "Palpate investigate · on " code { (investigation.setup.on) } }
            h1 { (rig.name) ": which explanation is left?" }
            @if let Some(state) = investigation.last_state() { p.lead { (state.summary) } }
            p { (ended) " Designed trials: " (trials) "." }
            @if let Some(state) = investigation.last_state().filter(|state| !state.open.is_empty()) {
                p.notices { "Still open: " (state.open.join("; ")) "." }
            }
        }
    }
}

fn table(rounds: &[Round]) -> Markup {
    html! {
        section {
            h2 { "Round by round" }
            div.wide { table {
                thead { tr { th { "round" } th.text { "motion" } th.text { "answer" } th.text { "not ruled out" } th { "residual over noise" } } }
                tbody { @for round in rounds { tr {
                    th { (round.number) }
                    td.text { (round.trial.as_ref().map_or_else(|| given(round).to_owned(), |trial| trial.motions.join("; then "))) }
                    @match &round.state {
                        Some(state) => {
                            td.text { (answer(state)) }
                            td.text { (alternatives(state)) }
                            td { (format!("{:.2}", state.residual_over_noise)) }
                        }
                        None => { td colspan="3" { "not diagnosed" } }
                    }
                } } }
            } }
        }
    }
}

/// What a round without a trial, the first, begins with.
fn given(round: &Round) -> &'static str {
    if round.state.is_some() { "given recordings" } else { "no recording was given" }
}

fn answer(state: &State) -> String {
    if state.physics.is_empty() { state.verdict.replace('_', " ") } else { words(&state.physics) }
}

fn alternatives(state: &State) -> String {
    if state.alternatives.is_empty() {
        return "–".to_owned();
    }
    state.alternatives.iter().map(|names| words(names)).collect::<Vec<_>>().join("; ")
}

fn section(round: &Round, investigation: &Investigation, rig: &Rig, folder: &Path) -> Markup {
    let Some(trial) = &round.trial else { return html! {} };
    let folder = round_folder(folder, round.number);
    let recorded = Recording::read(&folder.join("recording.csv"), rig).ok();
    let commanded = motion::commanded(&folder.join("reference.csv"));
    html! {
        section {
            h2 { "Round " (round.number) }
            p { (trial.why) }
            (questions(trial))
            @if let Some(commanded) = &commanded { (motion::figure(commanded, recorded.as_ref(), &investigation.setup.limits, rig)) }
            p { (ending(&trial.ending)) " " (used(trial)) }
            @if !trial.faults.is_empty() { ul.notices { @for fault in &trial.faults { li { (fault) } } } }
            @if !trial.is_used { p.notices { "The diagnosis goes on without this recording." } }
            @if let Some(state) = &round.state { p { strong { "Answer: " } (state.summary) } }
        }
    }
}

fn questions(trial: &TrialRecord) -> Markup {
    html! {
        @if !trial.questions.is_empty() {
            div.wide { table {
                thead { tr { th.text { "open before" } th { "expected energy (12 decide)" } } }
                tbody { @for (words, energy) in &trial.questions { tr { th.text { (words) } td { (rounded(*energy, "1", 2)) } } } }
            } }
        }
    }
}

fn ending(ending: &Ending) -> String {
    match ending {
        Ending::Completed => "The whole reference was run.".to_owned(),
        Ending::Stopped(violation) => format!("It was cut off: {violation}."),
        Ending::Interrupted => "It was interrupted.".to_owned(),
        Ending::Failed(why) => format!("It failed: {why}."),
    }
}

fn used(trial: &TrialRecord) -> String {
    let [position, speed, force, effort] = trial.used_limits.map(|share| format!("{:.0} %", 100.0 * share));
    format!("Of its limits it used: position {position}, speed {speed}, force {force}, effort {effort}.")
}

fn model(investigation: &Investigation) -> Markup {
    let Some(state) = investigation.last_state() else { return html! {} };
    html! {
        section {
            h2 { "The model at the end" }
            p { "The rig file with the named physics is " code { "improved.toml" } " beside this page; " code { "palpate simulate" } " runs it." }
            @if !state.values.is_empty() {
                div.wide { table {
                    thead { tr { th { "effect" } th { "value" } th { "estimate" } th { "95 % interval" } } }
                    tbody { @for value in &state.values { (row(value)) } }
                } }
            }
        }
    }
}

fn row(value: &ValueState) -> Markup {
    let interval = value.ci95.map_or("open".to_owned(), |[low, high]| {
        format!("{} to {}", plain(low, &value.unit), plain(high, &value.unit))
    });
    html! {
        tr { th { (effect_name(&value.effect)) } td { (value.name.replace('_', " ")) } td { (plain(value.value, &value.unit)) } td { (interval) } }
    }
}
