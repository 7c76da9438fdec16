//! The failures, by name.

use crate::page::effect_name::effect_name;
use maud::{Markup, html};
use palpate_cases::excitation::Excitation;
use palpate_cases::sensors::SensorGrade;
use palpate_cases::truth::CaseKind;

use super::super::case_score::CaseScore;
use super::super::challenge_score::ChallengeScore;
use super::super::scored_case::ScoredCase as _;

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let mut failures: Vec<&CaseScore> = challenge.rows.iter().filter(|row| !row.is_right()).collect();
    failures.sort_by(|a, b| b.strength.total_cmp(&a.strength));
    html! {
        section {
            h2 { "Cases that were not answered correctly" }
            p { (failures.len()) " of " (challenge.cases) " were not answered correctly, the strongest first." }
            div.wide { table {
                thead { tr { th { "case" } th.text { "concealed" } th { "strength" } th.text { "said" } th.text { "how" } th.text { "what made it hard" } } }
                tbody { @for row in failures { (line(row)) } }
            } }
        }
    }
}

fn line(row: &CaseScore) -> Markup {
    let names = |names: &[String]| if names.is_empty() { "nothing".to_owned() } else { effect_name(&names.join(", ")) };
    html! {
        tr {
            th { (row.index) small { (super::title(row.source)) } }
            td.text { (names(&row.truth)) }
            td { (format!("{:.2}", row.strength)) }
            td.text { @if let Some(why) = &row.failure { (why) } @else { (names(&row.answer.named)) } }
            td.text { (how(row)) }
            td.text { (hard(row)) }
        }
    }
}

fn how(row: &CaseScore) -> &'static str {
    match () {
        () if row.failure.is_some() => "no answer",
        () if row.is_false_alarm() => "false alarm",
        () if !row.is_detected() => "missed",
        () if row.is_within() => "truth among answer and alternatives",
        () if row.is_owned() && row.answer.named.len() == 1 => "reported as unknown",
        () if row.kind == CaseKind::Outside && row.is_owned() => "unknown, with a wrong name beside",
        () if row.truth.iter().any(|truth| row.answer.named.contains(truth)) => "found in part",
        () => "another name",
    }
}

/// What the case itself has that hides effects.
fn hard(row: &CaseScore) -> String {
    let reasons = [
        (row.strength < 0.3 && row.kind != CaseKind::None, "strength below 0.3"),
        ((0.3..1.0).contains(&row.strength), "strength below 1"),
        (row.grade == SensorGrade::Coarse, "coarse sensors"),
        (row.excitation == Excitation::Poor, "poor excitation"),
        (!row.effort, "no effort recorded"),
    ];
    let there: Vec<&str> = reasons.into_iter().filter(|(is, _)| *is).map(|(_, reason)| reason).collect();
    if there.is_empty() { "nothing of that kind".to_owned() } else { there.join(", ") }
}
