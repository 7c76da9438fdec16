//! Targets and results: the lines that page and README share. Cases of other authors stand above our own.

use palpate_cases::truth::CaseKind;

use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::external_score::ExternalSetScore;
use super::scored_case::ScoredCase as _;

/// One line.
#[derive(Debug, Clone)]
pub struct Target {
    /// Cases, and what a correct answer is.
    pub what: String,
    /// Cases answered so.
    pub hits: usize,
    /// Of so many.
    pub of: usize,
    /// The target in words; empty where there is none.
    pub target: &'static str,
    /// The least share that meets it.
    pub least: Option<f64>,
}

/// The cases of other authors, a group of lines for each folder that has such cases.
#[must_use]
pub fn external_lines(challenge: &ChallengeScore) -> Vec<Target> {
    let mut lines = Vec::new();
    for set in &challenge.sources {
        let line = |(what, hits, of): (&str, usize, usize)| {
            let what = format!("`{}` (another author), {what}", set.name);
            Target { what, hits, of, target: "", least: None }
        };
        lines.extend(counts_of(set).into_iter().filter(|(_, _, of)| *of > 0).map(line));
    }
    lines
}

/// What a correct answer is for each kind of case of another author, how many were given, and of how many cases.
#[must_use]
pub fn counts_of(set: &ExternalSetScore) -> [(&'static str, usize, usize); 5] {
    [
        ("no effect: no false alarm", set.none.n - set.none.false_alarms, set.none.n),
        ("one effect: named correctly", set.single.named_rightly, set.single.n),
        ("the same: truth among answer and alternatives", set.single.within_rivals, set.single.n),
        ("two effects: both named and nothing else", set.pairs.named_rightly, set.pairs.n),
        ("outside the list: reported as unknown", set.outside.owned, set.outside.n),
    ]
}

/// All lines of our own cases, those without a case too.
#[must_use]
pub fn targets(challenge: &ChallengeScore) -> Vec<Target> {
    let rows = &challenge.rows;
    let line = |what: &str, of: &dyn Fn(&CaseScore) -> bool, is: &dyn Fn(&CaseScore) -> bool, aim, least| {
        let there: Vec<&CaseScore> = rows.iter().filter(|row| of(row)).collect();
        Target {
            what: what.to_owned(),
            hits: there.iter().filter(|row| is(row)).count(),
            of: there.len(),
            target: aim,
            least,
        }
    };
    let single = |row: &CaseScore| row.kind == CaseKind::Single;
    let third = |row: &CaseScore| single(row) && (0.2..0.45).contains(&row.strength);
    let values: Vec<_> = rows.iter().flat_map(|row| &row.values).collect();
    let covered = values.iter().filter(|value| value.covered).count();
    let intervals = "95 % intervals of parameters that contain the true value";
    let large = "one effect of strength 1 or more: named correctly";
    vec![
        line(
            "no effect: no false alarm",
            &|row| row.kind == CaseKind::None,
            &|row| !row.is_false_alarm(),
            "99 %",
            Some(0.99),
        ),
        line(large, &CaseScore::is_large, &CaseScore::is_right, "95 %", Some(0.95)),
        line(
            "the same: truth among answer and alternatives",
            &CaseScore::is_large,
            &CaseScore::is_within,
            "95 %",
            Some(0.95),
        ),
        line("one effect of strength 0.2 to 0.45: detected", &third, &CaseScore::is_detected, "50 %", Some(0.5)),
        line("one effect, any strength from 0.1 to 10: named correctly", &single, &CaseScore::is_right, "", None),
        line(
            "two effects: both named and nothing else",
            &|row| row.kind == CaseKind::Pair,
            &CaseScore::is_right,
            "85 %",
            Some(0.85),
        ),
        line(
            "outside the list: reported as unknown",
            &|row| row.kind == CaseKind::Outside,
            &CaseScore::is_owned,
            "95 %",
            Some(0.95),
        ),
        Target { what: intervals.to_owned(), hits: covered, of: values.len(), target: "90 to 97 %", least: Some(0.9) },
    ]
}

/// Statistics that are no shares, in a sentence each.
#[must_use]
pub fn statistics(challenge: &ChallengeScore) -> String {
    format!(
        "Names in answer and alternatives where something was detected: {:.2} in the mean (target 1.5). Parameters: median error {:.1} % \
         (target 5 %). Held-out residual over the expected noise where named correctly, median: {:.2} before, {:.2} after (target 1.2). \
         A diagnosis took {:.1} s (median).",
        challenge.single.mean_set_size,
        100.0 * challenge.parameters.median_error,
        challenge.residual_over_floor.before_median,
        challenge.residual_over_floor.after_median,
        challenge.seconds_median
    )
}
