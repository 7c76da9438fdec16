//! The nominal values, given against fitted.

use super::super::diagnosis::{Diagnosis, Nominal};
use super::names_physics;
use super::wording::estimate;
use crate::page::quantity::plain;
use crate::page::table::difference;
use maud::{Markup, html};

/// A table; a sentence where nothing was refitted.
pub(super) fn section(answer: &Diagnosis) -> Markup {
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
        }
    }
}

fn row(value: &Nominal) -> Markup {
    let differs = difference(value.fitted, value.given);
    html! {
        tr {
            th scope="row" { code { (value.name) } }
            td { (plain(value.given, &value.unit)) }
            td { (estimate(value.fitted, value.ci95, &value.unit)) @if !differs.is_empty() { small { (differs) } } }
            td { (agreement(value)) }
        }
    }
}

fn agreement(value: &Nominal) -> Markup {
    let [low, high] = value.ci95;
    match (low <= value.given && value.given <= high, value.given < low || value.given > high) {
        (true, _) => html! { "agree" },
        (_, true) => html! { strong.off { "differ" } },
        _ => html! { "unknown" },
    }
}
