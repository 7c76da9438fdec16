//! The score in a table of Markdown: for the README, and for people who read a terminal.

use palpate_cases::truth::Kind;

use super::interval::of_share;
use super::row::Row;
use super::score::Challenge;

/// What begins the part of a README that the command writes.
pub const BEGIN: &str = "<!-- written by `palpate challenge --publish`; not by hand -->";
/// What ends it.
pub const END: &str = "<!-- end of what `palpate challenge` writes -->";

/// The table, and what it was made of.
#[must_use]
pub fn table(challenge: &Challenge) -> String {
    let rows = &challenge.rows;
    let select = |is: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| is(row)).collect::<Vec<_>>();
    let single = |row: &Row| row.kind == Kind::Single;
    let large = |row: &Row| single(row) && row.strength >= 1.0;
    let quiet = |row: &Row| !row.is_false_alarm();
    let mut text = format!(
        "Seed {}, {} cases, answers sealed by SHA-256 `{}` before the first diagnosis.\n\n",
        challenge.seed, challenge.cases, challenge.sealed_sha256
    );
    text += "| concealed | | of | share (95 % interval) | aim |\n|---|---|---|---|---|\n";
    let mut line = |what: &str, rows: &[&Row], is: &dyn Fn(&Row) -> bool, aim: &str| {
        let hits = rows.iter().filter(|row| is(row)).count();
        text += &format!("| {what} | {hits} | {} | {} | {aim} |\n", rows.len(), percent(hits, rows.len()));
    };
    line("nothing: left alone", &select(&|row| row.kind == Kind::None), &quiet, "99 %");
    line("one effect, at least as large as the floor: named rightly", &select(&large), &Row::is_right, "95 %");
    line("the same, truth within answer and rivals", &select(&large), &Row::is_within, "95 %");
    let third = |row: &Row| single(row) && (0.2..0.45).contains(&row.strength);
    line("one effect of about 0.3 of the floor: detected", &select(&third), &Row::is_detected, "50 %");
    line("one effect, any strength from 0.1 to 10: named rightly", &select(&single), &Row::is_right, "");
    line("two effects: both and nothing else named", &select(&|row| row.kind == Kind::Pair), &Row::is_right, "85 %");
    let outside = |row: &Row| row.kind == Kind::Outside;
    line("outside the list: called unknown", &select(&outside), &Row::is_owned, "95 %");
    let values = rows.iter().flat_map(|row| &row.values).collect::<Vec<_>>();
    let covered = values.iter().filter(|value| value.covered).count();
    text += &format!(
        "| intervals of parameters that hold the truth | {covered} | {} | {} | 90 to 97 % |\n",
        values.len(),
        percent(covered, values.len())
    );
    text += &format!(
        "\nNames offered where something was detected: {:.2} in the mean (aim 1.5). Parameters: median error {:.1} % (aim 5 %). Residual over \
         the floor where rightly named, median: {:.2} before, {:.2} after (aim 1.2). A diagnosis took {:.1} s (median).\n",
        challenge.single.mean_set_size,
        100.0 * challenge.parameters.median_error,
        challenge.residual_over_floor.before_median,
        challenge.residual_over_floor.after_median,
        challenge.seconds_median
    );
    challenge.left_out.iter().for_each(|what| text += &format!("\nLeft out: {what}\n"));
    text
}

/// "92 % (81 to 97 %)"; nothing where there is no case.
#[must_use]
pub fn percent(hits: usize, of: usize) -> String {
    if of == 0 {
        return String::new();
    }
    let [low, high] = of_share(hits, of).map(|share| 100.0 * share);
    format!("{:.0} % ({low:.0} to {high:.0} %)", 100.0 * hits as f64 / of as f64)
}

/// `text` with what stands between the marks replaced by `table`; `None` where the marks are not there.
#[must_use]
pub fn replaced(text: &str, table: &str) -> Option<String> {
    let begin = text.find(BEGIN)? + BEGIN.len();
    let end = begin + text[begin..].find(END)?;
    Some(format!("{}\n\n{}\n\n{}", &text[..begin], table.trim(), &text[end..]))
}
