//! The evidence against alternatives, and the experiment that would decide.

use super::super::diagnosis::{Alternative, Diagnosis, EffectEvidence, PlotData, Verdict};
use super::axis::across;
use super::wording::{gain, list, probability, title};
use super::{experiment, names_physics};
use maud::{Markup, html};

/// Height of a bar with its words, px.
const BAR_HEIGHT_PX: usize = 38;
/// Bars without a role beyond these are folded away.
const MAX_BARS: usize = 8;

/// Bars, alternatives and reference; nothing where no effect was tried.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    if pictures.scores.is_empty() && answer.alternatives.is_empty() && pictures.experiment.is_none() {
        return html! { p.nothing { "No single effect is weighed against another here: there is no evidence for any of them." } };
    }
    html! {
        section #evidence aria-labelledby="evidence-title" {
            h2 #evidence-title { (if names_physics(answer) { "Evidence against rivals" } else { "Would other physics help?" }) }
            (scores(answer, &pictures.scores))
            (rivals(answer))
            @if let Some(next) = &pictures.experiment { (experiment::figure(next, pictures)) }
        }
    }
}

fn scores(answer: &Diagnosis, scores: &[EffectEvidence]) -> Markup {
    // What has a role is shown wherever it stands.
    let (first, rest): (Vec<_>, Vec<_>) =
        scores.iter().enumerate().partition(|(rank, bar)| *rank < MAX_BARS || !bar.role.is_empty());
    html! {
        @if !scores.is_empty() {
            p.fine {
                "How much of what is missing each effect takes away when it is added alone, on data that no fit saw. p: how likely chance alone does as much; only small ones count. "
                @if !names_physics(answer) { (nothing_named(answer.verdict)) }
            }
            (bars(&first))
            @if !rest.is_empty() {
                details { summary { (rest.len()) " weaker effects" } (bars(&rest)) }
            }
        }
    }
}

fn nothing_named(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unknown => "None of them takes away enough to be named.",
        _ => "None of them was needed: their gains are what chance gives.",
    }
}

fn bars(scores: &[(usize, &EffectEvidence)]) -> Markup {
    let told: Vec<String> = scores
        .iter()
        .map(|(_, bar)| {
            let role = if bar.role.is_empty() { String::new() } else { format!(" ({})", bar.role) };
            format!("{}{role}: {}, {}", title(bar.name), gain(bar.held_out_gain), probability(bar.p_value))
        })
        .collect();
    let label = format!("What each effect takes away of what is missing. {}.", told.join("; "));
    html! {
        svg.bars role="img" aria-label=(label) height=(BAR_HEIGHT_PX * scores.len()) {
            @for (row, (_, bar)) in scores.iter().enumerate() { (drawn(bar, row * BAR_HEIGHT_PX)) }
        }
    }
}

fn drawn(bar: &EffectEvidence, top: usize) -> Markup {
    let class = match bar.role {
        "answer" => "improved",
        "rival" => "rival",
        _ => "other",
    };
    html! {
        text.strong[!bar.role.is_empty()] x="0" y=(top + 15) {
            (title(bar.name))
            @if !bar.role.is_empty() { tspan.(class) { " ● " (bar.role) } }
        }
        text.figure x="100%" y=(top + 15) text-anchor="end" {
            (gain(bar.held_out_gain)) tspan.soft { ", " (probability(bar.p_value)) }
        }
        rect.track x="0" y=(top + 21) width="100%" height="9" {}
        @if bar.held_out_gain > 0.0 {
            rect.(class) x="0" y=(top + 21) width=(across(bar.held_out_gain.min(1.0))) height="9" {}
        }
    }
}

fn rivals(answer: &Diagnosis) -> Markup {
    if answer.alternatives.is_empty() {
        return html! {
            @if names_physics(answer) { p { "There are no rivals: nothing else that was tried explains these recordings as well." } }
        };
    }
    html! {
        h3 { "What these recordings cannot tell from the answer" }
        div.wide tabindex="0" role="region" aria-label="Rivals" {
            table.rivals {
                thead { tr { th scope="col" { "It could as well be" } th scope="col" { "Takes away" } th scope="col" { "What would tell them apart" } } }
                tbody { @for rival in &answer.alternatives { (of_rival(rival)) } }
            }
        }
    }
}

fn of_rival(rival: &Alternative) -> Markup {
    let names: Vec<String> = rival.physics.iter().map(|name| title(name)).collect();
    html! {
        tr {
            th scope="row" { (list(&names)) }
            td { (gain(rival.held_out_gain)) }
            td { (rival.separated_by) }
        }
    }
}
