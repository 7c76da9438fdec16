//! What was aimed at, and what came out: the lines that page and README share.

use palpate_cases::truth::CaseKind;

use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;

/// One aim.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// What was concealed, and what was to be done.
    pub what: &'static str,
    /// Cases in which it was done.
    pub hits: usize,
    /// Of so many.
    pub of: usize,
    /// The aim in words; empty where there is none.
    pub aim: &'static str,
    /// The least share that meets it.
    pub least: Option<f64>,
}

/// All of them, those without a case too.
#[must_use]
pub fn targets(challenge: &ChallengeScore) -> Vec<Target> {
    let rows = &challenge.rows;
    let line = |what, of: &dyn Fn(&CaseScore) -> bool, is: &dyn Fn(&CaseScore) -> bool, aim, least| {
        let there: Vec<&CaseScore> = rows.iter().filter(|row| of(row)).collect();
        Target { what, hits: there.iter().filter(|row| is(row)).count(), of: there.len(), aim, least }
    };
    let single = |row: &CaseScore| row.kind == CaseKind::Single;
    let third = |row: &CaseScore| single(row) && (0.2..0.45).contains(&row.strength);
    let values: Vec<_> = rows.iter().flat_map(|row| &row.values).collect();
    let covered = values.iter().filter(|value| value.covered).count();
    let intervals = "intervals of parameters that hold the truth";
    let large = "one effect, at least as large as the floor: named rightly";
    vec![
        line(
            "nothing: left alone",
            &|row| row.kind == CaseKind::None,
            &|row| !row.is_false_alarm(),
            "99 %",
            Some(0.99),
        ),
        line(large, &CaseScore::is_large, &CaseScore::is_right, "95 %", Some(0.95)),
        line(
            "the same, truth within answer and rivals",
            &CaseScore::is_large,
            &CaseScore::is_within,
            "95 %",
            Some(0.95),
        ),
        line("one effect of about 0.3 of the floor: detected", &third, &CaseScore::is_detected, "50 %", Some(0.5)),
        line("one effect, any strength from 0.1 to 10: named rightly", &single, &CaseScore::is_right, "", None),
        line(
            "two effects: both and nothing else named",
            &|row| row.kind == CaseKind::Pair,
            &CaseScore::is_right,
            "85 %",
            Some(0.85),
        ),
        line(
            "outside the list: called unknown",
            &|row| row.kind == CaseKind::Outside,
            &CaseScore::is_owned,
            "95 %",
            Some(0.95),
        ),
        Target { what: intervals, hits: covered, of: values.len(), aim: "90 to 97 %", least: Some(0.9) },
    ]
}

/// The figures that are no shares, in a sentence each.
#[must_use]
pub fn beside(challenge: &ChallengeScore) -> String {
    format!(
        "Names offered where something was detected: {:.2} in the mean (aim 1.5). Parameters: median error {:.1} % (aim 5 %). Residual over \
         the floor where rightly named, median: {:.2} before, {:.2} after (aim 1.2). A diagnosis took {:.1} s (median).",
        challenge.single.mean_set_size,
        100.0 * challenge.parameters.median_error,
        challenge.residual_over_floor.before_median,
        challenge.residual_over_floor.after_median,
        challenge.seconds_median
    )
}
