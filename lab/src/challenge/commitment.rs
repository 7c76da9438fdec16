//! The commitment: a SHA-256 over the true answers, published before the first diagnosis.
//!
//! Each case has a line of JSON: the SHA-256 of every file that the diagnosis will see, and the true answer. A score is made from
//! [`OpenedAnswers`] only, and these are had by checking the lines against the commitment only.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest as _, Sha256};

/// Who made a case, which decides how its answer is written and scored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// From a folder of another author: [`super::external_cases::ExternalAnswer`].
    External,
    /// Drawn from the seed: [`super::drawn_answer::DrawnAnswer`].
    Drawn,
    /// A real recording: [`super::recordings::specimen::SealedAnswer`].
    Recorded,
}

/// One line of the file of answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CommittedCase {
    /// Its folder below that of the run.
    pub case: String,
    /// Who made it.
    pub origin: Origin,
    /// SHA-256 of each file in its folder, by name.
    pub files: BTreeMap<String, String>,
    /// What is true of it.
    pub answer: Value,
}

impl CommittedCase {
    /// The case whose files lie in `home/case`.
    ///
    /// # Errors
    /// A file cannot be read, or the answer cannot be written as JSON.
    pub fn new(home: &Path, case: &str, origin: Origin, answer: &impl Serialize) -> Result<Self> {
        let answer = serde_json::to_value(answer).context("an answer cannot be written as JSON")?;
        Ok(Self { case: case.to_owned(), origin, files: hashes(&home.join(case))?, answer })
    }

    /// Checks that every committed file in `home` is the one that was committed to.
    ///
    /// # Errors
    /// A file is gone or has changed.
    pub fn check_files(&self, home: &Path) -> Result<()> {
        for (name, sha256) in &self.files {
            let path = home.join(&self.case).join(name);
            let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            ensure!(hash(&bytes) == *sha256, "{}: changed after its SHA-256 {sha256} was committed to", path.display());
        }
        Ok(())
    }
}

/// A file of answers that has been committed to.
#[derive(Debug, Clone)]
pub struct Commitment {
    path: PathBuf,
    sha256: String,
}

impl Commitment {
    /// Writes `answers` to `path`, a line of JSON each, and commits to it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn commit(path: &Path, answers: &[CommittedCase]) -> Result<Self> {
        let mut text = String::new();
        for answer in answers {
            text += &serde_json::to_string(answer).context("an answer cannot be written as JSON")?;
            text.push('\n');
        }
        fs::write(path, &text).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { path: path.to_owned(), sha256: hash(text.as_bytes()) })
    }

    /// The commitment `sha256` that an earlier run made to the file at `path`.
    #[must_use]
    pub fn made(path: &Path, sha256: &str) -> Self {
        Self { path: path.to_owned(), sha256: sha256.to_owned() }
    }

    /// SHA-256 of the file, in hexadecimal.
    #[must_use]
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Checks the file against the commitment and reads it.
    ///
    /// # Errors
    /// The file is gone, or is another than was committed to.
    pub fn open(&self) -> Result<OpenedAnswers> {
        let text = fs::read_to_string(&self.path).with_context(|| format!("cannot read {}", self.path.display()))?;
        let lines: Vec<String> = text.split_terminator('\n').map(str::to_owned).collect();
        OpenedAnswers::check(lines, &self.sha256).with_context(|| format!("{}", self.path.display()))
    }
}

/// Answers that have been checked against their commitment.
#[derive(Debug, Clone)]
pub struct OpenedAnswers {
    sha256: String,
    lines: Vec<String>,
    cases: Vec<CommittedCase>,
}

impl OpenedAnswers {
    /// Checks `lines` against `sha256`.
    ///
    /// # Errors
    /// They are others than were committed to, or are no answers.
    pub fn check(lines: Vec<String>, sha256: &str) -> Result<Self> {
        let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
        let found = hash(text.as_bytes());
        ensure!(found == sha256, "found answers of SHA-256 {found}, expected those committed to by {sha256}");
        let cases = lines.iter().map(|line| serde_json::from_str(line).context("a line that is no answer"));
        Ok(Self { sha256: found, cases: cases.collect::<Result<_>>()?, lines })
    }

    /// SHA-256 of the lines, in hexadecimal.
    #[must_use]
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The lines as they were committed to.
    #[must_use]
    pub fn lines(&self) -> &[String] {
        &self.lines
    }

    /// The cases in their order.
    #[must_use]
    pub fn cases(&self) -> &[CommittedCase] {
        &self.cases
    }
}

/// SHA-256 of each file in `folder`, by name.
fn hashes(folder: &Path) -> Result<BTreeMap<String, String>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut found = BTreeMap::new();
    for entry in entries {
        let path = entry.with_context(|| format!("cannot read {}", folder.display()))?.path();
        let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        found.insert(name, hash(&bytes));
    }
    Ok(found)
}

/// SHA-256 of `bytes`, in hexadecimal.
#[must_use]
pub fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use tempfile::TempDir;

    /// Three cases of one file each, and their commitment.
    fn committed() -> (TempDir, Vec<CommittedCase>, Commitment) {
        let home = TempDir::new().unwrap();
        let case = |(name, answer): (&str, &str)| {
            fs::create_dir(home.path().join(name)).unwrap();
            fs::write(home.path().join(name).join("rig.toml"), name).unwrap();
            CommittedCase::new(home.path(), name, Origin::External, &json!({ "truth": [answer] })).unwrap()
        };
        let cases: Vec<_> = [("a", "adhesion"), ("b", "backlash"), ("c", "cogging")].into_iter().map(case).collect();
        let commitment = Commitment::commit(&home.path().join("answers.jsonl"), &cases).unwrap();
        (home, cases, commitment)
    }

    /// Why the commitment of [`committed`] refuses `edit`ed lines, both from the file and from a score.
    fn refused(edit: impl Fn(&mut Vec<String>)) {
        let (home, _, commitment) = committed();
        let mut lines = commitment.open().unwrap().lines().to_vec();
        edit(&mut lines);
        assert!(OpenedAnswers::check(lines.clone(), commitment.sha256()).is_err());
        fs::write(home.path().join("answers.jsonl"), lines.join("\n") + "\n").unwrap();
        let error = commitment.open().unwrap_err();
        assert!(format!("{error:#}").contains(commitment.sha256()), "{error:#}");
    }

    #[test]
    fn the_hash_is_sha256() {
        // FIPS 180-4: the empty message, and "abc".
        assert_eq!(hash(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(hash(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn what_was_committed_to_is_opened_as_it_was() {
        let (home, cases, commitment) = committed();
        assert_eq!(commitment.sha256(), hash(&fs::read(home.path().join("answers.jsonl")).unwrap()));
        let opened = commitment.open().unwrap();
        assert_eq!((opened.cases(), opened.sha256()), (cases.as_slice(), commitment.sha256()));
        let later = Commitment::made(&home.path().join("answers.jsonl"), commitment.sha256());
        assert_eq!(later.open().unwrap().cases(), cases);
    }

    #[test]
    fn a_changed_answer_is_refused() {
        refused(|lines| lines[1] = lines[1].replace("backlash", "hysteresis"));
    }

    #[test]
    fn another_order_of_answers_is_refused() {
        refused(|lines| lines.swap(0, 1));
    }

    #[test]
    fn a_removed_and_an_added_answer_are_refused() {
        refused(|lines| drop(lines.pop()));
        refused(|lines| lines.push(lines[0].clone()));
    }

    #[test]
    fn a_file_of_answers_that_differs_in_one_byte_is_refused() {
        for other in ["\n", " \n", "\r\n"] {
            let (home, _, commitment) = committed();
            let path = home.path().join("answers.jsonl");
            let text = fs::read_to_string(&path).unwrap();
            fs::write(&path, text.trim_end().to_owned() + other + other).unwrap();
            assert!(commitment.open().is_err(), "{other:?}");
        }
        let (home, _, commitment) = committed();
        fs::remove_file(home.path().join("answers.jsonl")).unwrap();
        assert!(commitment.open().is_err());
    }

    #[test]
    fn a_changed_file_of_a_case_is_refused() {
        let (home, cases, _) = committed();
        let check = |at: usize| cases[at].check_files(home.path());
        assert!((0..3).all(|at| check(at).is_ok()));
        fs::write(home.path().join("b/rig.toml"), "b ").unwrap();
        fs::remove_file(home.path().join("c/rig.toml")).unwrap();
        assert!(check(0).is_ok());
        assert!(check(1).unwrap_err().to_string().contains("changed after"));
        assert!(check(2).is_err());
    }
}
