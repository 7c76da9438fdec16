//! Cases of another author: a folder with `NNN/{rig.toml,trial-*.csv}` and one `truth*.json`.
//!
//! The file of answers maps the name of each case to `truth`, the effects that it conceals (`[]` for none, `["unknown"]` for one
//! outside the list), and optionally to `also`, other answers that are equally right on that recording.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};

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
    tables(folder, "trial-")
}

/// Names of the CSV files in `folder` that begin with `prefix`, sorted.
///
/// # Errors
/// The folder cannot be read.
pub fn tables(folder: &Path, prefix: &str) -> Result<Vec<String>> {
    let is_it = |name: &String| name.starts_with(prefix) && name.ends_with(".csv");
    Ok(names(folder)?.into_iter().filter(is_it).collect())
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

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

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
}
