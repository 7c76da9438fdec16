//! Which rigs stand out of the fleet, and why.

use crate::page::effect_name::effect_name;
use maud::{Markup, html};

use super::link;
use crate::fleet::outliers::{FarValue, MAX_Z, MIN_RIGS, Outlier, Reason, label};
use crate::fleet::table::Table;
use crate::page::quantity::{plain, rounded};

pub(super) fn section(table: &Table, outliers: &[Outlier]) -> Markup {
    let diagnosed = table.rigs().filter(|rig| !rig.is_failed()).count();
    html! {
        section {
            h2 { "Which rigs stand out" }
            @if outliers.is_empty() { p { "None." } } @else {
                div.wide tabindex="0" role="region" aria-label="Which rigs stand out" { table.outliers {
                    thead { tr { th { "rig" } th.text { "why" } } }
                    tbody { @for outlier in outliers { tr {
                        th scope="row" {
                            @if matches!(outlier.reasons[..], [Reason::Failed(_), ..]) { (outlier.rig) } @else { (link(&outlier.rig)) }
                        }
                        td.text { ul { @for reason in &outlier.reasons { li { (words(reason)) } } } }
                    } } }
                } }
            }
            p.fine {
                @if diagnosed < MIN_RIGS {
                    "With fewer than " (MIN_RIGS) " diagnosed rigs nothing is usual: only failures and unknown structure are listed. "
                }
                "A value stands out where it is more than " (MAX_Z) " deviations from the median of the rigs that have it (modified z-score: \
                 the spread is 1.4826 times the median absolute deviation, the value's own standard error added in squares). Where half \
                 of the rigs or more name the same effects, one is rare in a tenth of the rigs or fewer, and missed where nine tenths or \
                 more have it. Rigs of different makes are better kept in fleets of their own."
            }
        }
    }
}

fn words(reason: &Reason) -> Markup {
    match reason {
        Reason::Failed(error) => html! { strong.missed { "failed" } ": " (error) },
        Reason::Unknown => html! { "structure that no effect on the list explains" },
        Reason::RareEffect(name, count, of) => {
            html! { strong { (effect_name(name)) } ", which " (count) " of " (of) " have" }
        }
        Reason::LacksEffect(name, count, of) => {
            html! { "no " strong { (effect_name(name)) } ", which " (count) " of " (of) " have" }
        }
        Reason::Value(far) => value(far),
    }
}

fn value(far: &FarValue) -> Markup {
    let (quantity, point) = (&far.quantity, &far.point);
    html! {
        (label(&quantity.effect, &quantity.parameter)) " " strong { (number(point.value[0], &quantity.unit, quantity.is_relative)) }
        @if quantity.is_relative { " of what its rig file states" }
        ", median " (number(quantity.median, &quantity.unit, quantity.is_relative))
        " (z\u{a0}=\u{a0}" (rounded(point.z, "1", 2)) ")"
    }
}

/// A value of a quantity; a share of what the rig file states in per cent.
pub(super) fn number(value: f64, unit: &str, is_relative: bool) -> String {
    if is_relative && (0.01..10.0).contains(&value.abs()) {
        format!("{}\u{a0}%", rounded(100.0 * value, "1", 4))
    } else {
        plain(value, unit)
    }
}
