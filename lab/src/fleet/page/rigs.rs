//! Every rig with its answer.

use crate::page::effect_name::effect_name;
use maud::{Markup, html};

use super::changes::with_interval;
use super::link;
use crate::fleet::row::Row;
use crate::fleet::table::{Rig, Table};
use crate::page::quantity::rounded;

pub(super) fn section(table: &Table) -> Markup {
    html! {
        section {
            h2 { "All rigs" }
            div.wide tabindex="0" role="region" aria-label="All rigs" { table.rigs {
                thead { tr { th { "rig" } th.text { "verdict" } th.text { "named physics" } th.text { "not distinguished from it" } th { "residual over noise" } } }
                tbody { @for rig in table.rigs() { (row(rig)) } }
            } }
            p.fine { "Values are with their 95 % intervals. Residual: with the named physics, on data that no fit saw; noise: what the sensors alone would leave." }
        }
    }
}

fn row(rig: Rig<'_>) -> Markup {
    let head = rig.head();
    html! {
        tr {
            @if rig.is_failed() {
                th scope="row" { (rig.name()) }
                td.text colspan="4" { strong.missed { "failed" } ": " (head.error) }
            } @else {
                th scope="row" { (link(rig.name())) }
                td.text { (head.verdict.replace('_', " ")) }
                td.text { @for name in rig.effects() { (effect(rig, name)) } }
                td.text { (effect_name(&head.alternatives)) }
                td { (head.residual_over_noise.map_or("–".to_owned(), |ratio| rounded(ratio, "1", 3))) }
            }
        }
    }
}

fn effect(rig: Rig<'_>, name: &str) -> Markup {
    let values: Vec<&Row> = rig.effect_values().filter(|row| row.effect == name).collect();
    html! {
        div { (effect_name(name)) @for row in values { small { (row.parameter.replace('_', " ")) " " (value(row)) } } }
    }
}

fn value(row: &Row) -> String {
    let [low, high] = [row.ci95_low.unwrap_or(f64::NEG_INFINITY), row.ci95_high.unwrap_or(f64::INFINITY)];
    with_interval([row.value.unwrap_or(f64::NAN), low, high], &row.unit)
}
