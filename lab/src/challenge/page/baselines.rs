//! The same files, put to others.

use maud::{Markup, html};

use super::super::baselines::{BaselineSummary, summaries};
use super::super::challenge_score::ChallengeScore;
use super::super::summary::percent;

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let summaries = summaries(&challenge.rows);
    if summaries.len() < 2 {
        return html! {};
    }
    html! {
        section {
            h2 { "The same files, put to others" }
            p {
                "Plain BIC chooses among the very laws of the diagnosis, by the criterion of the textbooks. PySINDy and SysIdentPy regress on \
                 libraries of terms; what their terms stand for is written in their scripts. All fit one trial and foretell the other."
            }
            div.wide { table.others {
                thead { tr { th { "who" } th { "alarms where nothing is missing" } th { "effects at least the floor: named, and nothing else" } th { "RMS left of them on unseen data, of the refitted law's" } th { "seconds" } th { "no answer" } } }
                tbody { @for standing in &summaries { (line(standing)) } }
            } }
        }
    }
}

fn line(standing: &BaselineSummary) -> Markup {
    let share = |(hits, of): (usize, usize)| format!("{hits} of {of}, {}", percent(hits, of));
    html! {
        tr {
            th { (title(&standing.who)) } td { (share(standing.alarms)) } td { (share(standing.right)) }
            td { (format!("{:.0} %", 100.0 * standing.left)) } td { (format!("{:.1}", standing.seconds)) } td { (standing.failed) }
        }
    }
}

fn title(who: &str) -> &str {
    match who {
        "bic" => "our laws by plain BIC",
        "pysindy" => "PySINDy",
        "sysidentpy" => "SysIdentPy",
        other => other,
    }
}
