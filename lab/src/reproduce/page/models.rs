//! Beyond K and B.

use maud::{Markup, html};

use super::super::models::{Case, Parameter, SEEDS};
use super::{number, spread, wide};
use crate::page::quantity::with_interval;

pub(super) fn section(cases: &[Case]) -> Markup {
    let table = html! {
        table.claims.models {
            caption { "Means of " (SEEDS) " trials; ± is the 95 % interval that the estimator tells" }
            thead { tr { th scope="col" { "What is touched" } th scope="col" { "law" } th scope="col" { "found by that law" } th scope="col" { "K and B by spring and damper alone" } th scope="col" { "RMSE%: that law / spring and damper" } } }
            tbody { @for case in cases { (line(case)) } }
        }
    };
    html! {
        section #models aria-labelledby="models-title" {
            h2 #models-title { "Beyond K and B" }
            p { "Other contacts are linear in what is not known of them, too. The library makes their rows (" code { "ContactModel" } ", " code { "ModelStream" } ") and the recursion takes two or three parameters (" code { "ParameterRls" } "); a law of two passes through every other estimator as well. The bench has each of them, and the estimator, behind the matched filter of 20 Hz, is told which." }
            (wide("Other contact laws", &table))
            p.fine { "The tool's mass takes a little of B with it: the drive's effort is held for a period and the force is read right after it has changed, so the sensor sees the mass half a period early, which is m w² T / 2 of B at an angular frequency w." }
        }
    }
}

fn line(case: &Case) -> Markup {
    html! {
        tr {
            th scope="row" { (case.name) }
            td { (case.equation) small { code { (case.regressor) } } }
            td { @for parameter in &case.parameters { div { (words(parameter)) } } }
            td { (spread(&case.plain[0], 1)) " N/m" br; (spread(&case.plain[1], 2)) " N s/m" }
            td { (number(case.rmse[0].mean, 2)) " / " (number(case.rmse[1].mean, 2)) }
        }
    }
}

fn words(parameter: &Parameter) -> Markup {
    html! {
        (parameter.symbol) " = " (with_interval(parameter.found.mean, parameter.half_width, parameter.unit))
        small { "true " (crate::page::quantity::plain(parameter.truth, parameter.unit)) }
    }
}
