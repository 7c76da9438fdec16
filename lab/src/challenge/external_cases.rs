//! Cases of another author: a folder with `NNN/{rig.toml,trial-*.csv}` and one `truth*.json`.
//!
//! The file of answers maps the name of each case to `truth`, the effects that it conceals (`[]` for none, `["unknown"]` for one
//! outside the list), and optionally to `also`, other answers that are equally right on that recording.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};

use super::case_score::UNKNOWN;
use super::challenge_score::{NoEffectCounts, OutsideCounts, PairCounts};
use super::diagnosis_json::DiagnosisJson;
use super::recordings::specimen_score::spaced;
use crate::error::InputError;

/// The true answer of a case.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExternalAnswer {
    /// Name of the folder that it came from.
    #[serde(default)]
    pub set: String,
    /// Name of the case in that folder.
    #[serde(default)]
    pub case: String,
    /// Effects that it conceals.
    pub truth: Vec<String>,
    /// Other answers that are equally right.
    #[serde(default)]
    pub also: Vec<Vec<String>>,
}

/// A case that has been found in a folder.
#[derive(Debug, Clone)]
pub struct ExternalCase {
    /// Where it lies.
    pub folder: PathBuf,
    /// What is true of it.
    pub answer: ExternalAnswer,
}

/// The cases of `folder`, by name.
///
/// # Errors
/// There is no file of answers, it cannot be read, or a case has no rig file or no trial.
pub fn read(folder: &Path) -> Result<Vec<ExternalCase>> {
    let path = truth_file(folder)?;
    let text = std::fs::read_to_string(&path).map_err(|error| InputError::new(path.display(), error, "answers"))?;
    let expected = "names of cases, each with `truth`, a list of effects";
    let answers: BTreeMap<String, ExternalAnswer> =
        serde_json::from_str(&text).map_err(|error| InputError::new(path.display(), error, expected))?;
    ensure!(!answers.is_empty(), InputError::new(path.display(), "no case", expected));
    let set =
        std::fs::canonicalize(folder).ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let set = set.unwrap_or_else(|| "external".to_owned());
    let case = |(name, answer): (String, ExternalAnswer)| {
        let folder = folder.join(&name);
        ensure!(!trials(&folder)?.is_empty(), InputError::new(folder.display(), "no trial", "trial-1.csv, ..."));
        let rig = folder.join("rig.toml");
        ensure!(rig.is_file(), InputError::new(rig.display(), "no such file", "the rig file of the case"));
        Ok(ExternalCase { folder, answer: ExternalAnswer { set: set.clone(), case: name, ..answer } })
    };
    answers.into_iter().map(case).collect()
}

/// The one `truth*.json` of `folder`.
fn truth_file(folder: &Path) -> Result<PathBuf> {
    let is_truth = |name: &str| name.starts_with("truth") && name.ends_with(".json");
    let mut found = names(folder)?.into_iter().filter(|name| is_truth(name));
    match (found.next(), found.next()) {
        (Some(name), None) => Ok(folder.join(name)),
        (None, _) => {
            Err(InputError::new(folder.display(), "no truth*.json", "a folder of cases with its answers").into())
        }
        (Some(one), Some(other)) => {
            Err(InputError::new(folder.display(), format!("{one} and {other}"), "one file of answers").into())
        }
    }
}

/// Names of the trials in `folder`, sorted.
///
/// # Errors
/// The folder cannot be read.
pub fn trials(folder: &Path) -> Result<Vec<String>> {
    let is_trial = |name: &String| name.starts_with("trial-") && name.ends_with(".csv");
    Ok(names(folder)?.into_iter().filter(is_trial).collect())
}

/// Names of all files in `folder`, sorted.
fn names(folder: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

impl ExternalCase {
    /// Copies rig file and trials, and nothing else, to `folder`, which is made.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn copy_to(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        for name in trials(&self.folder)?.into_iter().chain(["rig.toml".to_owned()]) {
            let (from, to) = (self.folder.join(&name), folder.join(&name));
            std::fs::copy(&from, &to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
        }
        Ok(())
    }
}

/// One case, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExternalCaseScore {
    /// Its name in its folder.
    pub case: String,
    /// Effects that it conceals.
    pub truth: Vec<String>,
    /// Other answers that are equally right.
    pub also: Vec<Vec<String>>,
    /// The answer.
    pub named: Vec<String>,
    /// Alternatives that the diagnosis cannot distinguish from its answer.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Vec<String>>,
    /// The verdict, in its word.
    pub verdict: Option<String>,
    /// Held-out residual over the expected noise, values refitted.
    pub before: Option<f64>,
    /// The same with the named physics.
    pub after: Option<f64>,
    /// From the command's start to its end.
    pub seconds: f64,
    /// Why there is no answer.
    pub failure: Option<String>,
}

impl ExternalCaseScore {
    /// Scores `diagnosis`, or why there is none, against `answer`.
    #[must_use]
    pub fn score(answer: &ExternalAnswer, diagnosis: Result<&DiagnosisJson, &str>, seconds: f64) -> Self {
        let mut row = Self {
            case: answer.case.clone(),
            truth: answer.truth.clone(),
            also: answer.also.clone(),
            named: Vec::new(),
            alternatives: Vec::new(),
            verdict: None,
            before: None,
            after: None,
            seconds,
            failure: None,
        };
        match diagnosis {
            Err(failure) => row.failure = Some(failure.to_owned()),
            Ok(diagnosis) => {
                row.named = diagnosis.names();
                row.alternatives = diagnosis.alternative_names();
                row.before = diagnosis.fit.over_floor(diagnosis.fit.refitted);
                row.after = diagnosis.fit.over_floor(diagnosis.fit.improved);
                row.verdict = Some(diagnosis.verdict.clone());
            }
        }
        row
    }

    /// Whether what it says is true is what `answer` says.
    #[must_use]
    pub fn states(&self, answer: &ExternalAnswer) -> bool {
        (&self.case, &self.truth, &self.also) == (&answer.case, &answer.truth, &answer.also)
    }

    /// Something is named, or reported as unknown.
    #[must_use]
    pub fn is_detected(&self) -> bool {
        !self.named.is_empty()
    }

    /// The names are those of the truth or of an equally right answer, none more.
    #[must_use]
    pub fn is_right(&self) -> bool {
        let named = set(&self.named);
        self.failure.is_none() && (named == set(&self.truth) || self.also.iter().any(|also| named == set(also)))
    }

    /// The whole truth is among the names of the answer and its alternatives.
    #[must_use]
    pub fn is_within(&self) -> bool {
        let mut offered = set(&self.named);
        offered.extend(self.alternatives.iter().flatten().map(String::as_str));
        self.is_right() || (self.is_detected() && !self.truth.is_empty() && set(&self.truth).is_subset(&offered))
    }

    fn is_outside(&self) -> bool {
        self.truth == [UNKNOWN]
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        let mark = match () {
            () if self.failure.is_some() => "BROKE",
            () if self.is_right() => "right",
            () if self.is_within() => "within",
            () if self.is_detected() => "WRONG",
            () => "missed",
        };
        let failure = self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        let (truth, named) = (spaced(&self.truth), spaced(&self.named));
        format!("{mark:6} {} {truth} -> {named}, {:.1} s{failure}", self.case, self.seconds)
    }
}

fn set(names: &[String]) -> BTreeSet<&str> {
    names.iter().map(String::as_str).collect()
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
        let count =
            |rows: &[&ExternalCaseScore], is: fn(&ExternalCaseScore) -> bool| rows.iter().filter(|row| is(row)).count();
        let alarm = |row: &ExternalCaseScore| row.is_detected() && !row.is_right();
        Self {
            name: name.to_owned(),
            cases: rows.len(),
            none: NoEffectCounts { n: none.len(), false_alarms: count(&none, alarm) },
            single: ExternalSingleCounts {
                n: single.len(),
                detected: count(&single, ExternalCaseScore::is_detected),
                named_rightly: count(&single, ExternalCaseScore::is_right),
                within_rivals: count(&single, ExternalCaseScore::is_within),
            },
            pairs: PairCounts { n: several.len(), named_rightly: count(&several, ExternalCaseScore::is_right) },
            outside: OutsideCounts {
                n: outside.len(),
                owned: count(&outside, |row| row.is_right() || row.named.iter().any(|name| name == UNKNOWN)),
            },
            rows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::case_score::tests::diagnosis;
    use tempfile::TempDir;

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

    /// A folder of two cases with their answers.
    fn folder() -> TempDir {
        let folder = TempDir::new().unwrap();
        for case in ["000", "001"] {
            let case = folder.path().join(case);
            std::fs::create_dir(&case).unwrap();
            let others = ["notes.txt", "trial-notes.txt", "calibration.csv"];
            for file in ["rig.toml", "trial-1.csv", "trial-2.csv"].into_iter().chain(others) {
                std::fs::write(case.join(file), file).unwrap();
            }
        }
        let truth =
            r#"{"000": {"truth": []}, "001": {"truth": ["adhesion"], "also": [["hysteresis"]], "note": "hard"}}"#;
        std::fs::write(folder.path().join("truth.json"), truth).unwrap();
        for file in ["truth.txt", "settings.json"] {
            std::fs::write(folder.path().join(file), file).unwrap();
        }
        folder
    }

    #[test]
    fn a_folder_is_read_and_the_diagnosis_gets_rig_and_trials_alone() {
        let folder = folder();
        let cases = read(folder.path()).unwrap();
        let [first, second] = cases.as_slice() else { panic!("{cases:?}") };
        assert!(first.answer.truth.is_empty() && first.answer.case == "000");
        assert_eq!(
            (&second.answer.truth, &second.answer.also),
            (&vec!["adhesion".to_owned()], &vec![vec!["hysteresis".to_owned()]])
        );
        let copy = folder.path().join("copy");
        second.copy_to(&copy).unwrap();
        assert_eq!(names(&copy).unwrap(), ["rig.toml", "trial-1.csv", "trial-2.csv"]);
    }

    #[test]
    fn a_folder_that_lacks_something_is_refused_by_the_name_of_what_it_lacks() {
        let refused = |spoil: fn(&Path), expected: &str| {
            let folder = folder();
            spoil(folder.path());
            let error = format!("{:#}", read(folder.path()).unwrap_err());
            assert!(error.contains(expected), "{expected}: {error}");
        };
        refused(|folder| std::fs::remove_file(folder.join("truth.json")).unwrap(), "truth*.json");
        refused(|folder| std::fs::write(folder.join("truth-2.json"), "{}").unwrap(), "truth-2.json");
        refused(|folder| std::fs::write(folder.join("truth.json"), "{}").unwrap(), "no case");
        refused(|folder| std::fs::write(folder.join("truth.json"), r#"{"000": {}}"#).unwrap(), "truth");
        refused(|folder| std::fs::remove_file(folder.join("001/rig.toml")).unwrap(), "rig.toml");
        refused(|folder| std::fs::remove_dir_all(folder.join("001")).unwrap(), "001");
        let without_trials = |folder: &Path| {
            ["trial-1.csv", "trial-2.csv"]
                .iter()
                .for_each(|name| std::fs::remove_file(folder.join("001").join(name)).unwrap());
        };
        refused(without_trials, "no trial");
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
