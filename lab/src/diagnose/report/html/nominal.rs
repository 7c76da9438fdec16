//! The nominal values, given against fitted.

use super::super::diagnosis::{Diagnosis, Nominal, PlotData};
use super::names_physics;
use super::wording::estimate;
use crate::page::quantity::plain;
use crate::page::table::difference;
use maud::{Markup, html};

/// A table; a sentence where nothing was refitted.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    if answer.nominal.is_empty() {
        return html! { p.nothing #nominal { "No nominal value was refitted: the recordings bound none of them." } };
    }
    html! {
        section #nominal aria-labelledby="nominal-title" {
            h2 #nominal-title { "Nominal values" }
            div.wide tabindex="0" role="region" aria-label="Nominal values" {
                table {
                    caption {
                        "What the rig file says, and what the recordings say"
                        @if names_physics(answer) { " once the named physics is in" }
                        "; ± spans 95 %. A wrong value is not missing physics."
                    }
                    thead { tr { th scope="col" { "Value" } th scope="col" { "Rig file" } th scope="col" { "Fitted" } th scope="col" { "Rig file and recordings" } } }
                    tbody { @for value in &answer.nominal { (row(value)) } }
                }
            }
            (replayed(answer, pictures))
        }
    }
}

/// Where the estimators of a drive give other values of the same recording, and why.
fn replayed(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let stiffness = answer.nominal.iter().find(|value| value.name.starts_with("stiffness"));
    let touches = stiffness.is_some();
    let is_bounded = stiffness.is_some_and(|value| value.ci95[1] - value.ci95[0] < 2.0 * value.fitted.abs());
    html! {
        @if touches {
            p.fine {
                "Stiffness and damping of these recordings as a drive estimates them, moment by moment: "
                code { "palpate replay" }
                @if let Some(run) = &pictures.run { " (" code { (run.command.replace("palpate diagnose", "palpate replay").split(" --").take(2).collect::<Vec<_>>().join(" --")) } ")" }
                @if let Some(replay) = pictures.run.as_ref().and_then(|run| run.replay_page.as_ref()) { ": " a href=(replay) { "the replay beside this page" } }
                ". Its law is a spring and a damper alone and its answer the median over the contact"
                @if names_physics(answer) { ", so it differs from the values above, which hold beside the named physics." }
                @else if !is_bounded { ". These recordings bound neither, and a replay will not bound them either." }
                @else if answer.physics.is_empty() { ": it agrees with the values above within both intervals, unless stiffness changes along the way." }
                @else { "; where physics is missing, either is a compromise, and they weigh the rows differently." }
            }
        }
    }
}

/// Whether the rig file can state the value.
fn is_stated(value: &Nominal) -> bool {
    !value.name.starts_with("effort_")
}

fn row(value: &Nominal) -> Markup {
    // A position has no natural zero: its ratio to another says nothing.
    let is_position = value.name.starts_with("surface");
    let differs = if is_position { String::new() } else { difference(value.fitted, value.given) };
    html! {
        tr {
            th scope="row" { code { (value.name) } }
            td { @if is_stated(value) { (plain(value.given, &value.unit)) } @else { "–" } }
            td { (estimate(value.fitted, value.ci95, &value.unit)) @if !differs.is_empty() { small { (differs) } } }
            td { (agreement(value)) }
        }
    }
}

fn agreement(value: &Nominal) -> Markup {
    let [low, high] = value.ci95;
    if !is_stated(value) {
        return html! { @if low <= 0.0 && 0.0 <= high { "none is seen" } @else { "not in a rig file" } };
    }
    if !(low.is_finite() && high.is_finite()) {
        return html! { "not bounded" };
    }
    match (low <= value.given && value.given <= high, value.given < low || value.given > high) {
        (true, _) => html! { "agree" },
        (_, true) => html! { strong.off { "differ" } },
        _ => html! { "unknown" },
    }
}
