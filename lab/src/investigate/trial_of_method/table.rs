//! The table of all rows.

use super::answer::Answer;
use super::row::Row;
use crate::challenge::binomial::clopper_pearson;
use crate::experiment_design::explanation::UNKNOWN;

/// A way to an answer, and its name.
type Way = (&'static str, fn(&Row) -> &Answer);

const WAYS: [Way; 3] = [
    ("first recording alone", |row| &row.comparison.first),
    ("fixed rich trials", |row| &row.comparison.fixed),
    ("designed trials", |row| row.comparison.last()),
];

/// A group of rigs, and its name.
type Group = (&'static str, fn(&Row) -> bool);

const GROUPS: [Group; 4] = [
    ("all", |_| true),
    ("one effect of strength 1 or more", |row| row.truth.len() == 1 && row.truth[0] != UNKNOWN && row.strength >= 1.0),
    ("one effect, any strength", |row| row.truth.len() == 1 && row.truth[0] != UNKNOWN),
    ("nothing missing", |row| row.truth.is_empty()),
];

/// The table of `rows`: of each group that has any, how many each way names rightly, with exact 95 % intervals.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut text = "| rigs | | named rightly and alone | named rightly |\n|---|---|---|---|\n".to_owned();
    for (group, select) in GROUPS {
        let chosen: Vec<&Row> = rows.iter().filter(|row| select(row)).collect();
        if chosen.is_empty() {
            continue;
        }
        for (way, pick) in WAYS {
            let count =
                |is: fn(&Answer, &[String]) -> bool| chosen.iter().filter(|row| is(pick(row), &row.truth)).count();
            let (alone, right) = (count(Answer::is_right_and_alone), count(Answer::is_right));
            let [alone, right] = [alone, right].map(|hits| cell(hits, chosen.len()));
            text += &format!("| {group} | {way} | {alone} | {right} |\n");
        }
    }
    text + &limits_used(rows)
}

/// "3 of 4 (19 to 99 %)".
fn cell(hits: usize, of: usize) -> String {
    let [low, high] = clopper_pearson(hits, of);
    format!("{hits} of {of} ({:.0} to {:.0} %)", 100.0 * low, 100.0 * high)
}

/// What was used of the limits, in a sentence.
fn limits_used(rows: &[Row]) -> String {
    let most = |pick: fn(&Row) -> [f64; 4]| rows.iter().flat_map(pick).fold(0.0, f64::max);
    let stopped: usize = rows.iter().map(|row| row.comparison.stopped).sum();
    format!(
        "\nGreatest share of a limit that the true motion used: {:.2} in designed trials, {:.2} in fixed ones; {stopped} \
         designed trials were cut off.\n",
        most(|row| row.comparison.used),
        most(|row| row.comparison.used_by_fixed),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::investigate::trial_of_method::answer::tests::answer;
    use crate::investigate::trial_of_method::row::tests::row;

    #[test]
    fn the_table_counts_the_last_round_against_the_first_and_the_fixed() {
        let rows = [
            row(
                &["adhesion"],
                answer(&["adhesion"], &["hysteresis"]),
                vec![answer(&["hysteresis"], &[]), answer(&["adhesion"], &[])],
                answer(&["hysteresis"], &[]),
            ),
            row(&[], answer(&[], &[]), Vec::new(), answer(&["adhesion"], &[])),
        ];
        let table = table(&rows);
        let line = |of: &str| table.lines().find(|line| line.contains(of)).unwrap_or_default().to_owned();
        assert!(line("| all | first recording alone |").contains("| 1 of 2 (1 to 99 %) | 2 of 2"), "{table}");
        assert!(line("| all | designed trials |").contains("| 2 of 2"), "{table}");
        assert!(line("| all | fixed rich trials |").contains("| 0 of 2"), "{table}");
        assert!(table.contains("0.80 in designed trials, 0.90 in fixed ones; 2 designed trials"), "{table}");
    }
}
