//! Correlation of the errors of the fitted values.

use super::super::diagnosis::{Correlations, Diagnosis};
use super::wording::channel;
use crate::page::quantity::coefficient;
use maud::{Markup, html};

/// Correlation from which two values are said to be estimated only together.
const HIGH_CORRELATION: f64 = 0.9;

/// A table a channel, open where two errors are highly correlated; nothing where fewer than two were fitted.
pub(super) fn section(answer: &Diagnosis) -> Markup {
    html! {
        @if !answer.correlations.is_empty() {
            section #correlations aria-labelledby="correlations-title" {
                h2 #correlations-title { "Correlation of the fitted values" }
                @for one in &answer.correlations { (of_channel(one, answer.correlations.len() > 1)) }
            }
        }
    }
}

fn of_channel(one: &Correlations, is_named: bool) -> Markup {
    let pairs = correlated_pairs(one);
    html! {
        @if is_named { h3 { "By the " (channel(one.channel)) } }
        @for (a, b, correlation) in &pairs {
            p {
                code { (a) } " and " code { (b) } " are only estimated together: their errors have a correlation of " (coefficient(*correlation)) ". If one is larger than \
                 estimated, " @if *correlation < 0.0 { "the other is smaller" } @else { "so is the other" } ", and the fit is as good; another motion would separate them."
            }
        }
        @if pairs.is_empty() {
            p { "No two errors have a correlation beyond ±" (format!("{HIGH_CORRELATION}")) ": the recordings determine each value by itself." }
        }
        details open[!pairs.is_empty()] {
            summary { "Correlations of the errors" }
            div.wide tabindex="0" role="region" aria-label="Correlations" { (table(one)) }
        }
    }
}

/// Pairs beyond [`HIGH_CORRELATION`].
fn correlated_pairs(one: &Correlations) -> Vec<(&str, &str, f64)> {
    let names = &one.parameters;
    let pairs = (0..names.len()).flat_map(|a| (a + 1..names.len()).map(move |b| (a, b)));
    let each = pairs.map(|(a, b)| (names[a].as_str(), names[b].as_str(), one.matrix[a][b]));
    each.filter(|(.., correlation)| correlation.abs() > HIGH_CORRELATION).collect()
}

/// The lower triangle; columns are numbered as the rows are.
fn table(one: &Correlations) -> Markup {
    html! {
        table.correlations {
            caption { "From −1 to 1, by the curvature of the fit; 0: the error of one says nothing of the other" }
            thead { tr { th scope="col" { "Value" } @for at in 1..one.parameters.len() { th scope="col" { (at) } } } }
            tbody {
                @for (at, name) in one.parameters.iter().enumerate() {
                    tr {
                        th scope="row" { (at + 1) " " code { (name) } }
                        @for correlation in &one.matrix[at][..at] { td class=(shade(*correlation)) { (coefficient(*correlation)) } }
                    }
                }
            }
        }
    }
}

/// Blue above zero, orange below, in three steps.
fn shade(correlation: f64) -> &'static str {
    match correlation {
        c if c > HIGH_CORRELATION => "above strong",
        c if c > 0.5 => "above some",
        c if c > 0.2 => "above weak",
        c if c < -HIGH_CORRELATION => "below strong",
        c if c < -0.5 => "below some",
        c if c < -0.2 => "below weak",
        _ => "",
    }
}
