//! The table of all rows, source by source.

use super::answer::Answer;
use super::row::{OWN, Row};
use crate::challenge::binomial::clopper_pearson;
use crate::experiment_design::explanation::UNKNOWN;
use crate::investigate::watched_bed::Watched;

/// A way to an answer, and its name.
type Way = (&'static str, fn(&Row) -> &Answer);

const WAYS: [Way; 3] = [
    ("first recording alone", |row| &row.comparison.first),
    ("fixed rich trials", |row| &row.comparison.fixed),
    ("designed trials", |row| row.comparison.last()),
];

/// A group of rigs, and its name.
type Group = (&'static str, fn(&Row) -> bool);

const ALL: Group = ("all", |_| true);
const NOTHING: Group = ("nothing missing", |row| row.truth.is_empty());

/// Of rigs that were drawn, whose strength is known.
const OF_DRAWN: [Group; 4] = [
    ALL,
    ("one effect of strength 1 or more", |row| {
        is_one_effect(row) && row.strength.is_some_and(|strength| strength >= 1.0)
    }),
    ("one effect, any strength", is_one_effect),
    NOTHING,
];

/// Of rigs of another author.
const OF_OTHERS: [Group; 5] = [
    ALL,
    ("one effect", is_one_effect),
    ("two effects", |row| row.truth.len() == 2),
    NOTHING,
    ("outside the list", |row| row.truth == [UNKNOWN]),
];

fn is_one_effect(row: &Row) -> bool {
    row.truth.len() == 1 && row.truth[0] != UNKNOWN
}

/// The tables of `rows`, one a source in the order of the rows: of each group that has any, how many each way names rightly, with exact
/// 95 % intervals.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut sources: Vec<&str> = Vec::new();
    for row in rows {
        if !sources.contains(&row.source.as_str()) {
            sources.push(&row.source);
        }
    }
    let of = |source: &&str| {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.source == **source).collect();
        let (whose, groups) = match *source {
            OWN => ("Rigs of the own generator".to_owned(), OF_DRAWN.as_slice()),
            other => (format!("Rigs of `{other}`"), OF_OTHERS.as_slice()),
        };
        format!("{whose}:\n\n{}{}", counts(&rows, groups), limits_used(&rows))
    };
    sources.iter().map(of).collect::<Vec<_>>().join("\n")
}

/// The table of one source.
fn counts(rows: &[&Row], groups: &[Group]) -> String {
    let mut text = "| rigs | | named rightly and alone | named rightly |\n|---|---|---|---|\n".to_owned();
    for (group, select) in groups {
        let chosen: Vec<&Row> = rows.iter().copied().filter(|row| select(row)).collect();
        if chosen.is_empty() {
            continue;
        }
        for (way, pick) in WAYS {
            let count = |is: fn(&Row, &Answer) -> bool| chosen.iter().filter(|row| is(row, pick(row))).count();
            let [alone, right] =
                [count(Row::is_right_and_alone), count(Row::is_right)].map(|hits| cell(hits, chosen.len()));
            text += &format!("| {group} | {way} | {alone} | {right} |\n");
        }
    }
    text
}

/// "3 of 4 (19 to 99 %)".
fn cell(hits: usize, of: usize) -> String {
    let [low, high] = clopper_pearson(hits, of);
    format!("{hits} of {of} ({:.0} to {:.0} %)", 100.0 * low, 100.0 * high)
}

/// What was used of the limits, in a sentence.
fn limits_used(rows: &[&Row]) -> String {
    let most = |pick: fn(&Row) -> [f64; 4]| rows.iter().copied().flat_map(pick).fold(0.0, f64::max);
    let stopped: usize = rows.iter().map(|row| row.comparison.stopped).sum();
    let recorded = rows.iter().filter(|row| row.comparison.watched == Watched::Recording).count();
    let what = match recorded {
        0 => "the true motion used".to_owned(),
        all if all == rows.len() => "the recorded motion used".to_owned(),
        _ => "the motion used, the true one or else the recorded one".to_owned(),
    };
    format!(
        "\nGreatest share of a limit that {what}: {:.2} in designed trials, {:.2} in fixed ones; {stopped} designed trials were cut off.\n",
        most(|row| row.comparison.used),
        most(|row| row.comparison.used_by_fixed),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::investigate::trial_of_method::answer::tests::{answer, names};
    use crate::investigate::trial_of_method::row::tests::row;

    /// The part of `table` on `whose` rigs.
    fn part<'a>(table: &'a str, whose: &str) -> &'a str {
        let from = table.find(whose).unwrap_or_else(|| panic!("no {whose} in {table}"));
        let rest = &table[from..];
        &rest[..rest[1..].find("Rigs of").map_or(rest.len(), |end| end + 1)]
    }

    fn line(part: &str, of: &str) -> String {
        part.lines().find(|line| line.contains(of)).unwrap_or_default().to_owned()
    }

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
        assert!(line(&table, "| all | first recording alone |").contains("| 1 of 2 (1 to 99 %) | 2 of 2"), "{table}");
        assert!(line(&table, "| all | designed trials |").contains("| 2 of 2"), "{table}");
        assert!(line(&table, "| all | fixed rich trials |").contains("| 0 of 2"), "{table}");
        assert!(line(&table, "strength 1 or more | designed trials |").contains("| 1 of 1"), "{table}");
        assert!(table.contains("0.80 in designed trials, 0.90 in fixed ones; 2 designed trials"), "{table}");
    }

    #[test]
    fn each_source_is_counted_for_itself_in_groups_of_its_own() {
        let right = |truth: &[&str]| row(truth, answer(truth, &[]), Vec::new(), answer(truth, &[]));
        let of = |source: &str, row: Row| Row {
            source: source.to_owned(),
            case: Some("000".to_owned()),
            strength: None,
            ..row
        };
        let also = Row {
            also: vec![names(&["hysteresis"])],
            ..row(&["adhesion"], answer(&["hysteresis"], &[]), Vec::new(), answer(&[], &[]))
        };
        let rows = [
            right(&["adhesion"]),
            of("elsewhere", right(&[])),
            of("elsewhere", also),
            of("elsewhere", right(&["adhesion", "cogging"])),
            of("elsewhere", right(&["unknown"])),
            of("nowhere", row(&["unknown"], answer(&[], &[]), Vec::new(), answer(&[], &[]))),
        ];
        let table = table(&rows);
        let (own, elsewhere, nowhere) =
            (part(&table, "own generator"), part(&table, "`elsewhere`"), part(&table, "`nowhere`"));
        assert!(line(own, "| all | designed trials |").contains("| 1 of 1") && own.contains("strength"), "{own}");
        assert!(line(elsewhere, "| all | designed trials |").contains("| 4 of 4"), "{elsewhere}");
        assert!(line(elsewhere, "| all | fixed rich trials |").contains("| 3 of 4"), "{elsewhere}");
        for group in ["one effect", "two effects", "nothing missing", "outside the list"] {
            assert!(
                line(elsewhere, &format!("| {group} | designed trials |")).contains("| 1 of 1"),
                "{group}: {elsewhere}"
            );
        }
        assert!(!elsewhere.contains("strength"), "{elsewhere}");
        assert!(line(nowhere, "| outside the list | designed trials |").contains("| 0 of 1"), "{nowhere}");
        assert!(!nowhere.contains("one effect"), "a group without a rig: {nowhere}");
    }

    #[test]
    fn the_table_says_where_only_the_recorded_motion_is_known() {
        let mut rows = [0, 1].map(|_| row(&[], answer(&[], &[]), Vec::new(), answer(&[], &[])));
        assert!(table(&rows).contains("that the true motion used:"));
        rows[0].comparison.watched = Watched::Recording;
        assert!(table(&rows).contains("that the motion used, the true one or else the recorded one:"));
        rows[1].comparison.watched = Watched::Recording;
        assert!(table(&rows).contains("that the recorded motion used:"));
    }
}
