//! What changed since an earlier run.

use crate::page::effect_name::effect_name;
use maud::{Markup, html};

use super::{counted, link};
use crate::fleet::changes::{Change, Comparison, RigChanges, ValueChange};
use crate::fleet::outliers::label;
use crate::page::quantity::{between, plain};

pub(super) fn section(against: &str, comparison: &Comparison) -> Markup {
    html! {
        section {
            h2 { "What changed" }
            p {
                "Against " code { (against) } ": " (counted(comparison.compared, "rig")) " diagnosed both times, " (comparison.same_inputs)
                " of them on the same files; " (counted(comparison.values, "value")) " compared."
            }
            @if comparison.rigs.is_empty() { p { "Nothing changed." } } @else { (table(&comparison.rigs)) }
            p.fine {
                "A value has changed where its two 95 % intervals have no point in common. Of values that did not change, some six in a \
                 thousand do so by chance where both intervals are exact and of one width; more where they are too narrow."
            }
        }
    }
}

fn table(rigs: &[RigChanges]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label="What changed" { table.changes {
            thead { tr { th { "rig" } th.text { "what" } th.text { "before" } th.text { "now" } } }
            tbody { @for rig in rigs { @for (at, change) in rig.changes.iter().enumerate() {
                tr.more[at > 0] {
                    th scope="row" { @if at == 0 { @if !has_report(change) { (rig.rig) } @else { (link(&rig.rig)) } } }
                    (row(change))
                }
            } } }
        } }
    }
}

/// Whether this run wrote a report of the rig; the gravest change tells.
fn has_report(change: &Change) -> bool {
    match change {
        Change::Gone | Change::Failed(_) => false,
        Change::New(verdict) => !verdict.is_empty(),
        _ => true,
    }
}

fn row(change: &Change) -> Markup {
    let cells = |what: String, before: String, after: String| html! { td.text { (what) } td.text { (before) } td.text { (after) } };
    let dash = || "–".to_owned();
    match change {
        Change::Failed(error) => cells("fails now".to_owned(), "diagnosed".to_owned(), error.clone()),
        Change::Gone => cells("not in this run".to_owned(), "there".to_owned(), dash()),
        Change::Verdict(before, after) => cells("verdict".to_owned(), spoken(before), spoken(after)),
        Change::Named(name) => cells("effect".to_owned(), dash(), spoken(name)),
        Change::NoLongerNamed(name) => cells("effect".to_owned(), spoken(name), dash()),
        Change::Value(value) => cells(label(&value.effect, &value.parameter), before(value), after(value)),
        Change::Recovered(verdict) => cells("can be diagnosed again".to_owned(), "failed".to_owned(), spoken(verdict)),
        Change::New(verdict) => {
            let now = if verdict.is_empty() { "failed".to_owned() } else { spoken(verdict) };
            cells("new in this run".to_owned(), dash(), now)
        }
    }
}

fn spoken(name: &str) -> String {
    effect_name(name)
}

fn before(change: &ValueChange) -> String {
    with_interval(change.before, &change.unit)
}

fn after(change: &ValueChange) -> String {
    with_interval(change.after, &change.unit)
}

/// An estimate with its interval.
pub(super) fn with_interval([value, low, high]: [f64; 3], unit: &str) -> String {
    let number = plain(value, unit);
    match (low.is_finite(), high.is_finite()) {
        (true, true) if low == high => number,
        (true, true) => format!("{number} ({})", between(low, high, unit)),
        (true, false) => format!("{number} (above {})", plain(low, unit)),
        (false, true) => format!("{number} (below {})", plain(high, unit)),
        (false, false) => format!("{number} (interval open)"),
    }
}
