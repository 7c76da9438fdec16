//! One rig, scored.

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::comparison::Comparison;

/// The source of rigs that the cases' own generator draws.
pub const OWN: &str = "own";

/// One rig, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Whose rig it is: [`OWN`], or the name of another author's folder.
    #[serde(default = "own")]
    pub source: String,
    /// Its place in the list of cases of its source.
    pub index: u64,
    /// Its name in the folder that it came from; `None` where it was drawn.
    #[serde(default)]
    pub case: Option<String>,
    /// What it conceals; "unknown" where that is outside of the list.
    pub truth: Vec<String>,
    /// Other answers that are equally right.
    #[serde(default)]
    pub also: Vec<Vec<String>>,
    /// RMS residual of the refitted nominal model along the first recording, over the sensor's error; `None` where the truth does not say.
    pub strength: Option<f64>,
    /// What the three ways came to.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// Rows of earlier versions were all drawn.
fn own() -> String {
    OWN.to_owned()
}

impl Row {
    /// Whether `answer` names the truth, or what is equally right, and nothing else.
    #[must_use]
    pub fn is_right(&self, answer: &Answer) -> bool {
        std::iter::once(&self.truth).chain(&self.also).any(|names| answer.names_exactly(names))
    }

    /// The same, and no alternative is left.
    #[must_use]
    pub fn is_right_and_alone(&self, answer: &Answer) -> bool {
        self.is_right(answer) && answer.is_alone()
    }

    /// Its number, or the folder's name and its own.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.case {
            Some(case) => format!("{}/{case}", self.source),
            None => format!("{:4}", self.index),
        }
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        let mark = |answer: &Answer| match () {
            () if self.is_right_and_alone(answer) => "alone",
            () if self.is_right(answer) => "right",
            () => "no",
        };
        let Comparison { first, rounds, fixed, used, seconds, .. } = &self.comparison;
        let rounds: Vec<&str> = rounds.iter().map(mark).collect();
        let most = used.iter().fold(0.0, |most: f64, share| most.max(*share));
        let strength = self.strength.map_or_else(String::new, |strength| format!(" ({strength:.2})"));
        format!(
            "{} {}{strength}: first {}, designed {}, fixed {}; limits used to {most:.2}, {seconds:.0} s; {}",
            self.name(),
            self.truth.join(" and "),
            mark(first),
            rounds.join(" "),
            mark(fixed),
            self.comparison.last().named.join(" and "),
        )
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::investigate::trial_of_method::answer::tests::{answer, names};
    use crate::investigate::watched_bed::Watched;

    /// A drawn rig that conceals `truth` with a strength of 2.
    pub fn row(truth: &[&str], first: Answer, rounds: Vec<Answer>, fixed: Answer) -> Row {
        let comparison = Comparison {
            first,
            rounds,
            fixed,
            watched: Watched::TrueMotion,
            used: [0.5, 0.8, 0.1, 0.2],
            used_by_fixed: [0.9, 0.1, 0.1, 0.1],
            stopped: 1,
            recorded_s: [25.0, 25.0],
            outcome: String::new(),
            seconds: 1.0,
        };
        let (source, also) = (OWN.to_owned(), Vec::new());
        Row { source, index: 0, case: None, truth: names(truth), also, strength: Some(2.0), comparison }
    }

    /// Truth, what is equally right, named, alternatives; right, alone.
    type Judged = (&'static [&'static str], &'static [&'static [&'static str]], Answer, [bool; 2]);

    #[test]
    fn every_answer_against_every_truth() {
        let table: [Judged; 11] = [
            (&["adhesion"], &[], answer(&["adhesion"], &[]), [true, true]),
            (&["adhesion"], &[], answer(&["adhesion"], &["hysteresis"]), [true, false]),
            (&["adhesion"], &[], answer(&["adhesion", "hysteresis"], &[]), [false, false]),
            (&["adhesion"], &[], answer(&[], &["adhesion"]), [false, false]),
            (&["adhesion"], &[&["hysteresis"]], answer(&["hysteresis"], &[]), [true, true]),
            (&["adhesion"], &[&["hysteresis"]], answer(&["hysteresis"], &["adhesion"]), [true, false]),
            (&["adhesion"], &[&["hysteresis"]], answer(&["adhesion", "hysteresis"], &[]), [false, false]),
            (
                &["adhesion"],
                &[&["cogging"], &["adhesion", "unknown"]],
                answer(&["unknown", "adhesion"], &[]),
                [true, true],
            ),
            (&[], &[], answer(&[], &[]), [true, true]),
            (&[], &[], answer(&["unknown"], &[]), [false, false]),
            (&["unknown"], &[], answer(&["unknown"], &[]), [true, true]),
        ];
        for (truth, also, answer, expected) in table {
            let also = also.iter().map(|one| names(one)).collect();
            let row = Row { also, ..row(truth, answer.clone(), Vec::new(), answer.clone()) };
            assert_eq!([row.is_right(&answer), row.is_right_and_alone(&answer)], expected, "{row:?}");
        }
    }

    #[test]
    fn a_row_that_was_written_before_there_were_sources_is_a_drawn_one() {
        let old = r#"{"index": 7, "truth": ["adhesion"], "strength": 2.5, "first": {"named": [], "alternatives": []}, "rounds": [],
            "fixed": {"named": ["adhesion"], "alternatives": [["hysteresis"]]}, "used": [0.1, 0.2, 0.3, 0.4],
            "used_by_fixed": [0.5, 0.6, 0.7, 0.8], "stopped": 0, "recorded_s": [0.0, 25.0], "outcome": "", "seconds": 3.0}"#;
        let row: Row = serde_json::from_str(old).unwrap();
        assert_eq!((row.source.as_str(), row.index, row.strength), (OWN, 7, Some(2.5)));
        assert!(row.case.is_none() && row.also.is_empty() && row.comparison.watched == Watched::TrueMotion);
        assert_eq!(row.comparison.used_by_fixed[3], 0.8);
        let again: Row = serde_json::from_str(&serde_json::to_string(&row).unwrap()).unwrap();
        assert_eq!(again, row);
    }

    #[test]
    fn a_rig_of_another_author_is_told_by_its_folder_and_without_a_strength() {
        let drawn = row(&["adhesion"], answer(&[], &[]), Vec::new(), answer(&[], &[]));
        assert!(drawn.line().starts_with("   0 adhesion (2.00): first no"), "{}", drawn.line());
        let other = Row { source: "elsewhere".to_owned(), case: Some("031".to_owned()), strength: None, ..drawn };
        assert!(other.line().starts_with("elsewhere/031 adhesion: first no"), "{}", other.line());
    }
}
