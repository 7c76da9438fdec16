//! Real recordings: what their makers know, and what was said.

use maud::{Markup, html};

use super::super::challenge_score::ChallengeScore;
use super::super::recordings::grade::Grade;
use super::super::recordings::specimen_score::{RecordingScores, SpecimenScore, spaced};
use super::super::recordings::table::{line, residual, rivals};

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let Some(recorded) = &challenge.recorded else { return html! {} };
    html! {
        section {
            h2 { "Real recordings" }
            p { (line(recorded)) }
            p {
                "Measured on hardware by others, with a linear rig file. What their makers report was committed to with the other answers. Where a \
                 specimen has several trials or strokes, half of them were diagnosed, and the improved rig file was evaluated on the others \
                 with nothing refitted, except the position of the surface in that trial: it is estimated from the beginning of the trial, \
                 which is not scored."
            }
            (table(recorded))
            p.fine {
                "Residuals are root mean squares, refitted nominal law to named physics (expected noise). *: of stretches of the same trial, each predicted from \
                 the others, where a recording cannot be split."
            }
        }
    }
}

fn table(recorded: &RecordingScores) -> Markup {
    html! {
        div.wide { table.recorded {
            thead { tr { th { "recording" } th.text { "known" } th.text { "verdict" } th.text { "named" } th.text { "not ruled out" } th { "residual" } th.text { "judgement" } } }
            tbody { @for row in &recorded.rows { (row_of(row)) } }
        } }
    }
}

fn row_of(row: &SpecimenScore) -> Markup {
    let class = match row.grade {
        Grade::Named => "met",
        Grade::Owned | Grade::Undecidable => "open",
        Grade::Wrong | Grade::Missed => "missed",
    };
    html! {
        tr {
            th { (row.recording) small { (parted(row)) } }
            td.text { (row.description) }
            td.text { (row.verdict.as_deref().unwrap_or("no answer").replace('_', " ")) }
            td.text { @if let Some(why) = &row.failure { (why) } @else { (spaced(&row.named)) } }
            td.text { (rivals(row)) }
            td { (residual(row)) }
            td.text { span class=(class) { (row.words()) } }
        }
    }
}

/// What was trained on and what was scored.
fn parted(row: &SpecimenScore) -> String {
    let stems = |files: &[String]| {
        let stems: Vec<&str> = files.iter().map(|file| file.trim_end_matches(".csv")).collect();
        stems.join(", ")
    };
    match &row.no_split_reason {
        Some(why) => format!("not parted: {why}"),
        None if row.training == row.scored => "trained on its first strokes, scored on the others".to_owned(),
        None => format!("trained on {}; scored on {}", stems(&row.training), stems(&row.scored)),
    }
}
