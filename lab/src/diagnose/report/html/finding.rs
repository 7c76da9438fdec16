//! What was checked, what was found on the way, and what to record next.

use super::super::diagnosis::{Diagnosis, Finding, PlotData, Verdict};
use super::wording::{place_words, title, worst};
use crate::effects::{self, Place};
use maud::{Markup, html};

/// What casts doubt on the answer, for the head of the page; nothing where nothing does.
pub(super) fn grave(answer: &Diagnosis) -> Markup {
    let grave: Vec<&Finding> = answer.findings.iter().filter(|finding| finding.grave).collect();
    html! {
        @if !grave.is_empty() {
            section.doubt aria-label="What casts doubt on this answer" {
                h2 { "Before you rely on this" }
                ul { @for finding in grave { (item(finding)) } }
            }
        }
    }
}

/// The end of the page.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    html! {
        (next(answer, pictures))
        (findings(answer))
        (checked(answer))
    }
}

fn item(finding: &Finding) -> Markup {
    html! { li { @if !finding.place.is_empty() { strong.file { (finding.place) } ": " } (finding.text) } }
}

fn findings(answer: &Diagnosis) -> Markup {
    if answer.findings.is_empty() {
        return html! { p.nothing { "The recordings themselves gave no cause for remark." } };
    }
    html! {
        section #findings aria-labelledby="findings-title" {
            h2 #findings-title { "What the recordings themselves show" }
            ul.findings {
                @for finding in answer.findings.iter().filter(|finding| finding.grave) { (item(finding)) }
                @for finding in answer.findings.iter().filter(|finding| !finding.grave) { (item(finding)) }
            }
        }
    }
}

/// The effects that were tried, by where they act.
fn checked(answer: &Diagnosis) -> Markup {
    if answer.checked.is_empty() {
        return html! { p.nothing { "No effect was tried." } };
    }
    let acts_in = |name: &str| effects::find(name).map(|effect| effect.spec().place);
    let places = [Some(Place::Contact), Some(Place::Drive), Some(Place::Sensor), None];
    html! {
        section #checked aria-labelledby="checked-title" {
            h2 #checked-title { "What was checked" }
            p.fine { (answer.checked.len()) " effects were tried. " code { "palpate effects" } " explains each of them." }
            dl.checked {
                @for place in places {
                    @let names: Vec<String> = answer.checked.iter().filter(|name| acts_in(name) == place).map(|name| title(name)).collect();
                    @if !names.is_empty() { div { dt { (place.map_or("elsewhere", Place::name)) } dd { (names.join(" · ")) } } }
                }
            }
        }
    }
}

fn next(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let advice = advice(answer, pictures);
    html! {
        section #next aria-labelledby="next-title" {
            h2 #next-title { "What to record next" }
            @if let [only] = advice.as_slice() { p { (only) } } @else { ul { @for one in &advice { li { (one) } } } }
        }
    }
}

fn advice(answer: &Diagnosis, pictures: &PlotData) -> Vec<String> {
    let mut advice: Vec<String> = Vec::new();
    advice.extend(pictures.experiment.as_ref().map(|next| next.text.clone()));
    for rival in answer.alternatives.iter().filter(|rival| !rival.separated_by.is_empty()) {
        if !advice.contains(&rival.separated_by) {
            advice.push(rival.separated_by.clone());
        }
    }
    if matches!(answer.verdict, Verdict::Unknown | Verdict::PartlyExplained) {
        advice.push(closer_look(answer));
    }
    if advice.is_empty() {
        advice.push(nothing_needed(answer.verdict).into());
    }
    advice
}

/// Where something is there that nothing explains, more of the same place tells what it depends on.
fn closer_look(answer: &Diagnosis) -> String {
    let place = match worst(answer, None) {
        Some(place) if !place.states.is_empty() => format!("{}{}", place_words(place), place.states),
        Some(place) => place_words(place).trim_end_matches(", ").into(),
        None => "wherever it shows".into(),
    };
    format!(
        "To see what the unexplained part depends on, record more of where it lies ({place}): once slowly, once fast, once deep and once shallow."
    )
}

fn nothing_needed(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoMismatch => {
            "Nothing is needed for these motions. Other depths, speeds or loads than the recorded ones may still show something."
        }
        Verdict::Parameters => {
            "Put the fitted values into the rig file and hold it against a recording that this one did not see."
        }
        _ => "Nothing is needed to decide between explanations. A fresh recording would confirm the named physics.",
    }
}
