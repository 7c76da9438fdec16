//! The physics that the answer names, one card each.

use super::super::diagnosis::{Diagnosis, Physics, Value};
use super::wording::{estimate, gain, heading, odds};
use crate::effects;
use maud::{Markup, html};

/// One card an effect; nothing where nothing is named.
pub(super) fn section(answer: &Diagnosis) -> Markup {
    html! {
        @if !answer.physics.is_empty() {
            section #physics aria-label="What is missing" { @for physics in &answer.physics { (card(physics, only(answer, physics))) } }
        }
    }
}

/// Whether nothing else is named in its channel.
fn only(answer: &Diagnosis, physics: &Physics) -> bool {
    let beside = |other: &&Physics| other.name != "unknown" && other.channel == physics.channel;
    answer.physics.iter().filter(beside).count() < 2
}

fn card(physics: &Physics, only: bool) -> Markup {
    let unknown = physics.name == "unknown";
    html! {
        article.effect.unnamed[unknown] {
            h2 {
                @if unknown { "Something not in the list" } @else { (heading(&physics.name)) }
                span.mark { (acts_in(physics.acts_in)) }
            }
            p.statement { (physics.statement) }
            @if !physics.equation.is_empty() { p.equation { (physics.equation.replace("<=", "≤").replace(">=", "≥")) } }
            @if !physics.parameters.is_empty() {
                dl.values { @for value in &physics.parameters { (parameter(&physics.name, value)) } }
                p.fine { "± and ranges span 95 %, and are widened by how far values move where stretches of the recordings are left out." }
            }
            @if !unknown { p.fine { (evidence(physics, only)) } }
            @if let Some(regressor) = &physics.on_drive {
                p.fine { "In the control loop: " (regressor) "." }
            }
        }
    }
}

fn acts_in(place: &str) -> String {
    match place {
        "contact" => "acts in the contact".into(),
        "drive" => "acts in the drive".into(),
        "sensor" => "acts in the sensor".into(),
        channel => format!("seen in the {}", super::wording::channel(channel)),
    }
}

fn parameter(effect: &str, value: &Value) -> Markup {
    html! {
        div {
            dt { code { (value.name) } @if let Some(meaning) = meaning(effect, &value.name) { " " span { (meaning) } } }
            dd { (estimate(value.value, value.ci95, &value.unit)) }
        }
    }
}

/// What the catalogue says of a parameter.
fn meaning(effect: &str, parameter: &str) -> Option<&'static str> {
    let spec = effects::find(effect)?.spec();
    let mut all = spec.forms.iter().flat_map(|form| form.parameters);
    all.find(|known| known.name == parameter).map(|known| known.meaning)
}

fn evidence(physics: &Physics, only: bool) -> Markup {
    let evidence = physics.evidence;
    html! {
        "On data that no fit saw, it takes away " (gain(evidence.held_out_gain)) " of the mean square that the law without it leaves above the noise"
        @if !only { ", the other named effects in place" }
        "; " (odds(evidence.p_value)) "."
    }
}
