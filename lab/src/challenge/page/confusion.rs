//! What was concealed against what was named.

use crate::page::effect_name::effect_name;
use std::collections::{BTreeMap, BTreeSet};

use maud::{Markup, html};
use palpate_cases::truth::CaseKind;

use super::super::case_score::CaseScore;
use super::super::challenge_score::ChallengeScore;

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let rows: Vec<&CaseScore> = challenge.rows.iter().filter(|row| row.kind != CaseKind::Pair).collect();
    let mut counts: BTreeMap<(u8, String), BTreeMap<String, usize>> = BTreeMap::new();
    for row in &rows {
        let said = said(row);
        *counts.entry(truth(row)).or_default().entry(said).or_default() += 1;
    }
    let columns: BTreeSet<&str> = counts.values().flat_map(|said| said.keys()).map(String::as_str).collect();
    let mut columns: Vec<&str> = columns.into_iter().collect();
    // What is no name stands last, together.
    columns.sort_by_key(|name| (["more than one", "unknown", "nothing"].contains(name), *name));
    html! {
        section {
            h2 { "Concealed effect against named effect" }
            p { "Rows: concealed effect. Columns: named effect. Correct answers are on the diagonal. All strengths, down to 0.1." }
            div.wide { table.confusion {
                thead { tr { th { "concealed" } @for column in &columns { th { span { (effect_name(column)) } } } } }
                tbody { @for ((_, truth), said) in &counts { (line(truth, said, &columns)) } }
            } }
        }
    }
}

fn truth(row: &CaseScore) -> (u8, String) {
    match row.kind {
        CaseKind::None => (2, "nothing".to_owned()),
        CaseKind::Outside => (1, format!("{} (outside)", row.truth.join(" and "))),
        _ => (0, row.truth.join(" and ")),
    }
}

fn said(row: &CaseScore) -> String {
    match row.answer.named.as_slice() {
        [] => "nothing".to_owned(),
        [one] => one.clone(),
        [one, rest @ ..] if rest.iter().all(|other| other == one) => one.clone(),
        _ => "more than one".to_owned(),
    }
}

fn line(truth: &str, said: &BTreeMap<String, usize>, columns: &[&str]) -> Markup {
    let all: usize = said.values().sum();
    let wanted = if truth.ends_with("(outside)") { "unknown" } else { truth };
    html! {
        tr {
            th { (effect_name(truth)) }
            @for column in columns {
                @let count = said.get(*column).copied().unwrap_or(0);
                @let share = format!("--share: {:.2}", count as f64 / all.max(1) as f64);
                td class=(if *column == wanted { "right" } else if count > 0 { "wrong" } else { "" }) style=(share) {
                    @if count > 0 { (count) }
                }
            }
        }
    }
}
