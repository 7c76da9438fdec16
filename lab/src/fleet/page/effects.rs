//! Which physics the simulations of the fleet leave out, and in how many rigs.

use crate::page::effect_name::effect_name;
use std::collections::BTreeMap;

use maud::{Markup, html};

use super::some_of;
use crate::fleet::table::{Rig, Table};

/// Names of rigs that are shown of an effect.
const MAX_NAMES: usize = 6;

pub(super) fn section(table: &Table) -> Markup {
    let diagnosed: Vec<Rig<'_>> = table.rigs().filter(|rig| !rig.is_failed()).collect();
    let mut rigs: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for rig in &diagnosed {
        rig.effects().into_iter().for_each(|name| rigs.entry(name).or_default().push(rig.name()));
    }
    let mut effects: Vec<(&str, Vec<&str>)> = rigs.into_iter().collect();
    effects.sort_by_key(|(_, rigs)| std::cmp::Reverse(rigs.len()));
    html! {
        section {
            h2 { "Physics that the simulations leave out" }
            @if effects.is_empty() { p { "No effect is named." } } @else {
                div.wide tabindex="0" role="region" aria-label="Effects by number of rigs" { table.effects {
                    thead { tr { th { "effect" } th { "rigs" } th.bars {} th.text { "which" } } }
                    tbody { @for (name, rigs) in &effects { tr {
                        th scope="row" { (effect_name(name)) }
                        td { (rigs.len()) }
                        td.bars { span.bar style={ "width: " (format!("{:.1}", 100.0 * rigs.len() as f64 / diagnosed.len() as f64)) "%" } {} }
                        td.text { (some_of(rigs, MAX_NAMES)) }
                    } } }
                } }
            }
        }
    }
}
