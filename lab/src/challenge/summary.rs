//! The score in a table of Markdown: for the README, and for people who read a terminal.

use palpate_cases::truth::CaseKind;

use super::binomial::clopper_pearson;
use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::recordings;
use super::recordings::table::line;
use super::scored_case::ScoredCase as _;
use super::targets::{Target, counts_of, statistics, targets};

/// What begins the part of a README or page of the documentation that the command writes.
pub const BEGIN: &str = "<!-- written by `palpate challenge --publish`; not by hand -->";
/// What ends it.
pub const END: &str = "<!-- end of what `palpate challenge` writes -->";

/// What the README shows: what fails, and of which run.
#[must_use]
pub fn readme(challenge: &ChallengeScore) -> String {
    format!("{}\n{}", failures(challenge), run(challenge))
}

/// What the documentation shows: every count, and every real recording.
#[must_use]
pub fn documented(challenge: &ChallengeScore) -> String {
    let recorded =
        challenge.recorded.as_ref().map_or(String::new(), |real| format!("\n{}", recordings::table::table(real)));
    table(challenge) + &recorded
}

/// Strength of an effect below which no recording shows it for sure: half of the noise.
const SMALL: f64 = 0.5;

/// How many answers of each kind are wrong, and of how many.
fn failures(challenge: &ChallengeScore) -> String {
    let mut wrong = [(0, 0); 5];
    for (kind, (_, hits, of)) in challenge.sources.iter().flat_map(|set| counts_of(set).into_iter().enumerate()) {
        wrong[kind] = (wrong[kind].0 + of - hits, wrong[kind].1 + of);
    }
    let [none, single, _, pairs, outside] = wrong;
    let count = |wrong: &dyn Fn(&CaseScore) -> bool, of: &dyn Fn(&CaseScore) -> bool| {
        let all: Vec<&CaseScore> = challenge.rows.iter().filter(|row| of(row)).collect();
        (all.iter().filter(|row| wrong(row)).count(), all.len())
    };
    let small = count(&|row| !row.is_right(), &|row| row.kind == CaseKind::Single && row.strength < SMALL);
    let large = count(&|row| !row.is_right(), &|row| row.is_large());
    let alarms = (challenge.none.false_alarms, challenge.none.n);
    let values: Vec<_> = challenge.rows.iter().flat_map(|row| &row.values).collect();
    let missed = values.iter().filter(|value| !value.covered).count();
    let of = |(wrong, all): (usize, usize)| format!("{wrong} of {all}");
    let ours = (challenge.outside.n - challenge.outside.owned, challenge.outside.n);
    let mut rows = vec![
        ("other authors' cases: one effect, not named rightly", of(single)),
        ("the same: two effects", of(pairs)),
        ("ours of strength 1 or more: one effect, not named rightly", of(large)),
        ("nothing missing: something named or `unknown`", format!("others {}; ours {}", of(none), of(alarms))),
        ("outside the list: not reported as unknown", format!("others {}; ours {}", of(outside), of(ours))),
        ("parameter interval misses the truth", format!("{} (5 % nominal)", of((missed, values.len())))),
        ("effect below half of the noise: not named", of(small)),
    ];
    if let Some(real) = &challenge.recorded {
        let unnamed = of((real.owned + real.missed, real.n));
        rows.push(("real recordings: not named", format!("{unnamed}; named wrongly {}", real.wrong)));
    }
    let lines = rows.into_iter().map(|(what, figure)| format!("| {what} | {figure} |\n"));
    "| what fails | measured |\n|---|---|\n".to_owned() + &lines.collect::<String>()
}

/// The table, and what it was made of.
#[must_use]
pub fn table(challenge: &ChallengeScore) -> String {
    let mut text = run(challenge) + "\n";
    if challenge.cases > 0 || !challenge.sources.is_empty() {
        text += &drawn(challenge);
    }
    if let Some(recorded) = &challenge.recorded {
        text += &format!("\n{}\n", line(recorded));
    }
    challenge.left_out.iter().for_each(|what| text += &format!("\nLeft out: {what}\n"));
    text
}

/// Which run it was, and what its answers were committed to by.
fn run(challenge: &ChallengeScore) -> String {
    format!(
        "Seed {}, {} cases, answers committed to by SHA-256 `{}` before the first diagnosis.\n",
        challenge.seed, challenge.cases, challenge.sealed_sha256
    )
}

/// The cases of other authors, a line for each, then the drawn ones, a line for each kind, and the statistics that are no shares.
fn drawn(challenge: &ChallengeScore) -> String {
    let mut text = String::new();
    if !challenge.sources.is_empty() {
        text += &others(challenge);
    }
    if challenge.cases > 0 {
        text += "| concealed | | of | share (95 % interval) | target |\n|---|---|---|---|---|\n";
        for Target { what, hits, of, target, .. } in targets(challenge) {
            text += &format!("| {what} | {hits} | {of} | {} | {target} |\n", percent(hits, of));
        }
        text += &format!("\n{}\n", statistics(challenge));
    }
    text
}

/// How many cases of each other author came out right, kind by kind, under the kinds' own names.
fn others(challenge: &ChallengeScore) -> String {
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = String::new();
    for set in &challenge.sources {
        let counts = counts_of(set);
        if text.is_empty() {
            let kinds = counts.iter().map(|(what, ..)| (*what).to_owned());
            text = row(std::iter::once("another author".to_owned()).chain(kinds).collect());
            text += "|---|---|---|---|---|---|\n";
        }
        let cell =
            |(_, hits, of): &(&str, usize, usize)| if *of > 0 { format!("{hits} of {of}") } else { "-".to_owned() };
        text += &row(std::iter::once(format!("`{}`", set.name)).chain(counts.iter().map(cell)).collect());
    }
    text + "\n"
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
