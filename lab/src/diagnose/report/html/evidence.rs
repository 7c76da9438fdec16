//! The answer against what else would do, on one measure, and the experiment that would decide.

use super::super::diagnosis::{Alternative, Diagnosis, FitQuality, PlotData};
use super::wording::{channel, gain, heading, list, title};
use super::{experiment, names_physics};
use maud::{Markup, html};

/// A table a channel that is explained, and the reference to run; nothing where nothing is named.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    if !names_physics(answer) && pictures.experiment.is_none() {
        return html! {};
    }
    let explained = answer.channels.iter().filter(|fit| !named(answer, fit.channel).is_empty());
    html! {
        section #evidence aria-labelledby="evidence-title" {
            h2 #evidence-title { "The answer, and what else would do" }
            p.fine {
                "Takes away: of the mean square that refitted values leave in the channel above the sensors' noise, the share that these effects explain, on held-out stretches of the recordings."
            }
            @for fit in explained { (table(answer, fit)) }
            @if let Some(next) = &pictures.experiment { (experiment::figure(next, pictures)) }
        }
    }
}

/// Effects that the answer names in a channel.
fn named(answer: &Diagnosis, channel: &str) -> Vec<String> {
    let physics = answer.physics.iter().filter(|physics| physics.name != "unknown" && physics.channel == channel);
    physics.map(|physics| title(&physics.name)).collect()
}

fn table(answer: &Diagnosis, fit: &FitQuality) -> Markup {
    let others: Vec<&Alternative> = answer.alternatives.iter().filter(|other| other.channel == fit.channel).collect();
    html! {
        div.wide tabindex="0" role="region" aria-label={ "Explanations of the " (channel(fit.channel)) } {
            table.rivals {
                thead { tr { th scope="col" { (heading(channel(fit.channel))) } th scope="col" { "Takes away" } th scope="col" { "What would separate it from the answer" } } }
                tbody {
                    tr.best { th scope="row" { (list(&named(answer, fit.channel))) " " span.mark { "answer" } } td { (gain(fit.explained_share)) } td { "–" } }
                    @for other in &others { (row(other)) }
                }
            }
        }
        @if others.is_empty() { p.fine { "Nothing else that was tried explains the " (channel(fit.channel)) " of these recordings as well." } }
    }
}

fn row(other: &Alternative) -> Markup {
    let names: Vec<String> = other.physics.iter().map(|name| title(name)).collect();
    html! {
        tr {
            th scope="row" { (list(&names)) " " span.mark.open { "not ruled out" } }
            td { (gain(other.held_out_gain)) }
            td { (other.separated_by) }
        }
    }
}
