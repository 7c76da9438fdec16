//! The score in a table of Markdown: for the README, and for people who read a terminal.

use super::binomial::clopper_pearson;
use super::challenge_score::ChallengeScore;
use super::recordings::table::line;
use super::targets::{Target, beside, targets};

/// What begins the part of a README or page of the documentation that the command writes.
pub const BEGIN: &str = "<!-- written by `palpate challenge --publish`; not by hand -->";
/// What ends it.
pub const END: &str = "<!-- end of what `palpate challenge` writes -->";

/// The table, and what it was made of.
#[must_use]
pub fn table(challenge: &ChallengeScore) -> String {
    let mut text = format!(
        "Seed {}, {} cases, answers sealed by SHA-256 `{}` before the first diagnosis.\n\n",
        challenge.seed, challenge.cases, challenge.sealed_sha256
    );
    if challenge.cases > 0 {
        text += &drawn(challenge);
    }
    if let Some(recorded) = &challenge.recorded {
        text += &format!("\n{}\n", line(recorded));
    }
    challenge.left_out.iter().for_each(|what| text += &format!("\nLeft out: {what}\n"));
    text
}

/// The cases that were drawn: a line each, and the figures that are no shares.
fn drawn(challenge: &ChallengeScore) -> String {
    let mut text = "| concealed | | of | share (95 % interval) | aim |\n|---|---|---|---|---|\n".to_owned();
    for Target { what, hits, of, aim, .. } in targets(challenge) {
        text += &format!("| {what} | {hits} | {of} | {} | {aim} |\n", percent(hits, of));
    }
    text + &format!("\n{}\n", beside(challenge))
}

/// "92 % (81 to 97 %)"; nothing where there is no case.
#[must_use]
pub fn percent(hits: usize, of: usize) -> String {
    if of == 0 {
        return String::new();
    }
    let [low, high] = clopper_pearson(hits, of).map(|share| 100.0 * share);
    format!("{:.0} % ({low:.0} to {high:.0} %)", 100.0 * hits as f64 / of as f64)
}

/// `text` with what stands between the marks replaced by `table`; `None` where the marks are not there.
#[must_use]
pub fn replaced(text: &str, table: &str) -> Option<String> {
    let begin = text.find(BEGIN)? + BEGIN.len();
    let end = begin + text[begin..].find(END)?;
    Some(format!("{}\n\n{}\n\n{}", &text[..begin], table.trim(), &text[end..]))
}
