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
            h2 { "Baselines on the same files" }
            p {
                "Plain BIC chooses among the very laws of the diagnosis, by the Bayesian information criterion. PySINDy and SysIdentPy regress on \
                 libraries of terms; what their terms stand for is written in their scripts. All are fitted to one trial and evaluated on the other."
            }
            div.wide { table.others {
                thead { tr { th { "method" } th { "false alarms where nothing is missing" } th { "one effect of strength 1 or more: named, and nothing else" } th { "held-out RMS residual, relative to the refitted nominal law" } th { "seconds" } th { "no answer" } } }
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
