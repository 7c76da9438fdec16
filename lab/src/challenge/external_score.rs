//! Cases of another author, scored.

use serde::{Deserialize, Serialize};

use super::case_counts::{NoEffectCounts, OutsideCounts, PairCounts, count};
use super::diagnosed_answer::DiagnosedAnswer;
use super::diagnosis_json::DiagnosisJson;
use super::external_cases::ExternalAnswer;
use super::recordings::specimen_score::spaced;
use super::scored_case::{ScoredCase, UNKNOWN};

/// One case, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExternalCaseScore {
    /// Its name in its folder.
    pub case: String,
    /// Effects that it conceals.
    pub truth: Vec<String>,
    /// Other answers that are equally right.
    pub also: Vec<Vec<String>>,
    /// What the diagnosis answered.
    #[serde(flatten)]
    pub answer: DiagnosedAnswer,
    /// From the command's start to its end.
    pub seconds: f64,
    /// Why there is no answer.
    pub failure: Option<String>,
}

impl ExternalCaseScore {
    /// Scores `diagnosis`, or why there is none, against `answer`.
    #[must_use]
    pub fn score(answer: &ExternalAnswer, diagnosis: Result<&DiagnosisJson, &str>, seconds: f64) -> Self {
        let (answered, failure) = match diagnosis {
            Ok(diagnosis) => (DiagnosedAnswer::of(diagnosis), None),
            Err(failure) => (DiagnosedAnswer::default(), Some(failure.to_owned())),
        };
        Self {
            case: answer.case.clone(),
            truth: answer.truth.clone(),
            also: answer.also.clone(),
            answer: answered,
            seconds,
            failure,
        }
    }

    /// Whether what it says is true is what `answer` says.
    #[must_use]
    pub fn states(&self, answer: &ExternalAnswer) -> bool {
        (&self.case, &self.truth, &self.also) == (&answer.case, &answer.truth, &answer.also)
    }

    fn is_outside(&self) -> bool {
        self.truth == [UNKNOWN]
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        let failure = self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        let (mark, truth, named) = (self.mark(), spaced(&self.truth), spaced(&self.answer.named));
        format!("{mark:6} {} {truth} -> {named}, {:.1} s{failure}", self.case, self.seconds)
    }
}

impl ScoredCase for ExternalCaseScore {
    fn truth(&self) -> &[String] {
        &self.truth
    }

    fn answer(&self) -> &DiagnosedAnswer {
        &self.answer
    }

    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// The names are those of the truth or of an equally right answer, none more.
    fn is_right(&self) -> bool {
        let mut right = std::iter::once(&self.truth).chain(&self.also);
        self.failure.is_none() && right.any(|names| self.answer.names_exactly(names))
    }
}

/// The cases of one folder, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExternalSetScore {
    /// Name of the folder.
    pub name: String,
    /// How many.
    pub cases: usize,
    /// Cases that conceal nothing.
    pub none: NoEffectCounts,
    /// Cases with one effect of the list.
    pub single: ExternalSingleCounts,
    /// Cases with several.
    pub pairs: PairCounts,
    /// Cases with an effect outside the list.
    pub outside: OutsideCounts,
    /// Every case.
    pub rows: Vec<ExternalCaseScore>,
}

/// Cases with one effect of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExternalSingleCounts {
    /// How many.
    pub n: usize,
    /// Something is named, or reported as unknown.
    pub detected: usize,
    /// The effect, or an equally right answer, and nothing else.
    pub named_rightly: usize,
    /// The effect is among the answer and its alternatives.
    pub within_rivals: usize,
}

impl ExternalSetScore {
    /// Counts `rows` of the folder `name`.
    #[must_use]
    pub fn of(name: &str, rows: Vec<ExternalCaseScore>) -> Self {
        let (outside, rest): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.is_outside());
        let of = |least: usize, most: usize| {
            rest.iter().copied().filter(|row| (least..=most).contains(&row.truth.len())).collect::<Vec<_>>()
        };
        let (none, single, several) = (of(0, 0), of(1, 1), of(2, usize::MAX));
        Self {
            name: name.to_owned(),
            cases: rows.len(),
            none: NoEffectCounts::of(&none),
            single: ExternalSingleCounts {
                n: single.len(),
                detected: count(&single, ExternalCaseScore::is_detected),
                named_rightly: count(&single, ExternalCaseScore::is_right),
                within_rivals: count(&single, ExternalCaseScore::is_within),
            },
            pairs: PairCounts::of(&several),
            outside: OutsideCounts::of(&outside),
            rows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::case_score::tests::diagnosis;

    fn answer(truth: &[&str], also: &[&[&str]]) -> ExternalAnswer {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let also = also.iter().map(|names| own(names)).collect();
        ExternalAnswer { set: "elsewhere".to_owned(), case: "000".to_owned(), truth: own(truth), also }
    }

    fn row(truth: &[&str], also: &[&[&str]], named: &[&str], alternatives: &[&str]) -> ExternalCaseScore {
        ExternalCaseScore::score(&answer(truth, also), Ok(&diagnosis(named, alternatives)), 1.0)
    }

    /// Every kind of answer against every kind of truth: right, within.
    #[test]
    fn every_answer_against_every_truth() {
        type Names = &'static [&'static str];
        /// Truth, equally right answers, named, alternatives; right, within.
        type Judged = (Names, &'static [Names], Names, Names, [bool; 2]);
        let table: &[Judged] = &[
            (&[], &[], &[], &[], [true, true]),
            (&[], &[], &["unknown"], &[], [false, false]),
            (&[], &[&["force_bias"]], &["force_bias"], &[], [true, true]),
            (&["adhesion"], &[], &[], &["adhesion"], [false, false]),
            (&["adhesion"], &[], &["adhesion"], &[], [true, true]),
            (&["adhesion"], &[], &["cogging"], &["adhesion"], [false, true]),
            (&["adhesion"], &[], &["adhesion", "unknown"], &[], [false, true]),
            (&["adhesion"], &[&["hysteresis"]], &["hysteresis"], &[], [true, true]),
            (&["adhesion"], &[&["hysteresis", "unknown"]], &["hysteresis"], &[], [false, false]),
            (&["adhesion", "cogging"], &[], &["cogging", "adhesion"], &[], [true, true]),
            (&["adhesion", "cogging"], &[], &["adhesion"], &[], [false, false]),
            (&["unknown"], &[], &["unknown"], &[], [true, true]),
            (&["unknown"], &[], &["adhesion"], &[], [false, false]),
        ];
        for (truth, also, named, alternatives, expected) in table {
            let row = row(truth, also, named, alternatives);
            assert_eq!([row.is_right(), row.is_within()], *expected, "{truth:?} {also:?}: {named:?}");
        }
        let broke = ExternalCaseScore::score(&answer(&[], &[]), Err("it broke"), 1.0);
        assert!(!broke.is_right() && !broke.is_within() && !broke.is_detected());
    }

    #[test]
    fn every_count_is_the_one_that_is_counted_by_hand() {
        let rows = vec![
            row(&[], &[], &[], &[]),
            row(&[], &[], &["adhesion"], &[]),
            row(&[], &[], &["unknown"], &[]),
            row(&[], &[&["adhesion"]], &["adhesion"], &[]),
            row(&["adhesion"], &[], &["adhesion"], &[]),
            row(&["adhesion"], &[], &["cogging"], &["adhesion"]),
            row(&["adhesion"], &[], &[], &[]),
            row(&["adhesion", "cogging"], &[], &["adhesion", "cogging"], &[]),
            row(&["adhesion", "cogging"], &[], &["adhesion"], &[]),
            row(&["unknown"], &[], &["unknown"], &[]),
            row(&["unknown"], &[], &["cogging"], &[]),
            row(&["unknown"], &[&["cogging"]], &["cogging"], &[]),
        ];
        let score = ExternalSetScore::of("elsewhere", rows);
        assert_eq!(score.cases, 12);
        assert_eq!((score.none.n, score.none.false_alarms), (4, 2));
        let expected = ExternalSingleCounts { n: 3, detected: 2, named_rightly: 1, within_rivals: 2 };
        assert_eq!(score.single, expected);
        assert_eq!((score.pairs.n, score.pairs.named_rightly), (2, 1));
        assert_eq!((score.outside.n, score.outside.owned), (3, 2));
    }

    #[test]
    fn a_line_begins_with_what_came_of_it() {
        let line = |named: &[&str], alternatives: &[&str]| row(&["adhesion"], &[], named, alternatives).line();
        assert!(line(&["adhesion"], &[]).starts_with("right  000"), "{}", line(&["adhesion"], &[]));
        assert!(line(&["cogging"], &["adhesion"]).starts_with("within"));
        assert!(line(&["cogging"], &[]).starts_with("WRONG"));
        assert!(line(&[], &[]).starts_with("missed"));
        let broke = ExternalCaseScore::score(&answer(&[], &[]), Err("it stopped"), 1.0).line();
        assert!(broke.starts_with("BROKE") && broke.ends_with(": it stopped"), "{broke}");
    }
}
