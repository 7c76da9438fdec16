//! The folder of a run: what an interrupted run left there is what the next one goes on from.
//!
//! `run.json` holds the settings, `answers.jsonl` the answers with `commitment.json` beside it, `results.jsonl` a line for each
//! diagnosis that has ended. While cases are drawn, `drawn.jsonl` holds those that are complete.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::case_result::CaseResult;
use super::commitment::{Commitment, CommittedCase};
use crate::error::InputError;
use crate::interrupt::Temporary;

/// Everything that decides what a run is. A folder belongs to one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Seed of the drawn cases.
    pub seed: u64,
    /// Number of drawn cases that was asked for.
    pub cases: usize,
    /// Simulators and folders, as the command line names them.
    pub sources: Vec<String>,
    /// Real recordings, as the command line names them.
    pub recordings: Vec<String>,
    /// Whether baselines run on the same files.
    pub baselines: bool,
    /// SHA-256 of the program: half a run by another program would be a score of neither.
    pub program_sha256: String,
}

/// What is fixed once the answers are committed to.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Committed {
    sha256: String,
    left_out: Vec<String>,
}

/// The folder of a run.
#[derive(Debug)]
pub struct WorkFolder {
    path: PathBuf,
    /// Removed with everything in it where nobody asked to keep it.
    temporary: Option<(tempfile::TempDir, Temporary)>,
}

impl WorkFolder {
    /// Opens `path` for a run of `settings`, or a temporary folder.
    ///
    /// # Errors
    /// The folder cannot be written, or it holds a run of other settings.
    pub fn open(path: Option<&Path>, settings: &Settings) -> Result<Self> {
        let Some(path) = path else {
            let temporary = tempfile::tempdir().context("no folder for the recordings can be made")?;
            let path = temporary.path().to_owned();
            let removed = Temporary::new(&path);
            return Ok(Self { path, temporary: Some((temporary, removed)) });
        };
        fs::create_dir_all(path).with_context(|| format!("cannot make {}", path.display()))?;
        let folder = Self { path: path.to_owned(), temporary: None };
        let file = path.join("run.json");
        match read_json::<Settings>(&file)? {
            Some(found) => ensure!(
                found == *settings,
                InputError::new(
                    file.display(),
                    format!("a run of other settings: {}", serde_json::to_string(&found)?),
                    format!("{}, or another folder", serde_json::to_string(settings)?)
                )
            ),
            None => {
                let is_empty = fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_none());
                let found = "files of something else";
                ensure!(is_empty, InputError::new(path.display(), found, "an empty folder, or one of such a run"));
                write_json(&file, settings)?;
            }
        }
        Ok(folder)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it goes when the run ends.
    #[must_use]
    pub fn is_temporary(&self) -> bool {
        self.temporary.is_some()
    }

    /// Cases that an interrupted run has drawn completely, by name. A case whose files have changed is drawn again.
    ///
    /// # Errors
    /// The file of drawn cases cannot be read.
    pub fn drawn(&self) -> Result<BTreeMap<String, CommittedCase>> {
        let lines = read_lines::<CommittedCase>(&self.path.join("drawn.jsonl"))?;
        let whole = lines.into_iter().filter(|case| case.check_files(&self.path).is_ok());
        Ok(whole.map(|case| (case.case.clone(), case)).collect())
    }

    /// Notes that `case` is drawn.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note_drawn(&self, case: &CommittedCase) -> Result<()> {
        append_line(&self.path.join("drawn.jsonl"), case)
    }

    /// Commits to `answers`; `left_out` says what the run does without, and why.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn commit(&self, answers: &[CommittedCase], left_out: &[String]) -> Result<Commitment> {
        let commitment = Commitment::commit(&self.path.join("answers.jsonl"), answers)?;
        let committed = Committed { sha256: commitment.sha256().to_owned(), left_out: left_out.to_vec() };
        write_json(&self.path.join("commitment.json"), &committed)?;
        let _ = fs::remove_file(self.path.join("drawn.jsonl"));
        Ok(commitment)
    }

    /// The commitment of an interrupted run, with what it does without.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn committed(&self) -> Result<Option<(Commitment, Vec<String>)>> {
        let found: Option<Committed> = read_json(&self.path.join("commitment.json"))?;
        let made = |sha256: &str| Commitment::made(&self.path.join("answers.jsonl"), sha256);
        Ok(found.map(|found| (made(&found.sha256), found.left_out)))
    }

    /// Diagnoses that have ended, by case.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn results(&self) -> Result<BTreeMap<String, CaseResult>> {
        let lines = read_lines::<CaseResult>(&self.path.join("results.jsonl"))?;
        Ok(lines.into_iter().map(|result| (result.case.clone(), result)).collect())
    }

    /// Notes that a diagnosis has ended.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note_result(&self, result: &CaseResult) -> Result<()> {
        append_line(&self.path.join("results.jsonl"), result)
    }

    /// Removes the files of `case` where nobody asked to keep them: a thousand cases fill a disk.
    ///
    /// # Errors
    /// They cannot be removed.
    pub fn clear(&self, case: &str) -> Result<()> {
        if !self.is_temporary() {
            return Ok(());
        }
        let folder = self.path.join(case);
        fs::remove_dir_all(&folder).with_context(|| format!("cannot clear {}", folder.display()))
    }
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>> {
    if !path.exists() {
        return Ok(None);
    }
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let value = serde_json::from_str(&text);
    Ok(Some(value.map_err(|error| InputError::new(path.display(), error, "as this program wrote it"))?))
}

/// Writes the file as a whole or not at all: a run may be killed at any instant.
fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let mut file = crate::outfile::OutFile::create(path)?;
    let text = serde_json::to_string_pretty(value)? + "\n";
    file.write_all(text.as_bytes()).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

/// The whole lines of a file; a last one that was cut short by a kill is taken off.
fn read_lines<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    if whole < bytes.len() {
        let file =
            OpenOptions::new().write(true).open(path).with_context(|| format!("cannot open {}", path.display()))?;
        file.set_len(whole as u64).with_context(|| format!("cannot shorten {}", path.display()))?;
    }
    let parse = |(number, line): (usize, &[u8])| {
        let place = || format!("{}, line {}", path.display(), number + 1);
        let value = serde_json::from_slice(line);
        value.map_err(|error| InputError::new(place(), error, "as this program wrote it").into())
    };
    bytes[..whole].split(|byte| *byte == b'\n').filter(|line| !line.is_empty()).enumerate().map(parse).collect()
}

fn append_line(path: &Path, value: &impl Serialize) -> Result<()> {
    let line = serde_json::to_string(value)? + "\n";
    let place = || format!("cannot write {}", path.display());
    let mut file = OpenOptions::new().create(true).append(true).open(path).with_context(place)?;
    file.write_all(line.as_bytes()).with_context(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::commitment::Origin;
    use tempfile::TempDir;

    fn settings() -> Settings {
        let own = |text: &str| vec![text.to_owned()];
        Settings {
            seed: 1,
            cases: 2,
            sources: own("own"),
            recordings: own("none"),
            baselines: false,
            program_sha256: "p".into(),
        }
    }

    fn result(case: &str) -> CaseResult {
        CaseResult::new(case, Err("it broke".to_owned()), 1.5)
    }

    #[test]
    fn a_folder_belongs_to_one_run() {
        let home = TempDir::new().unwrap();
        let open = |settings: &Settings| WorkFolder::open(Some(home.path()), settings);
        open(&settings()).unwrap();
        open(&settings()).unwrap();
        for other in [
            Settings { seed: 2, ..settings() },
            Settings { cases: 3, ..settings() },
            Settings { sources: Vec::new(), ..settings() },
            Settings { recordings: Vec::new(), ..settings() },
            Settings { baselines: true, ..settings() },
            Settings { program_sha256: "q".into(), ..settings() },
        ] {
            assert!(open(&other).unwrap_err().to_string().contains("run.json"), "{other:?}");
        }
        let foreign = TempDir::new().unwrap();
        fs::write(foreign.path().join("thesis.tex"), "").unwrap();
        assert!(WorkFolder::open(Some(foreign.path()), &settings()).is_err());
    }

    #[test]
    fn a_line_that_was_cut_short_is_taken_off_and_written_anew() {
        let home = TempDir::new().unwrap();
        let folder = WorkFolder::open(Some(home.path()), &settings()).unwrap();
        folder.note_result(&result("a")).unwrap();
        folder.note_result(&result("b")).unwrap();
        let path = home.path().join("results.jsonl");
        let whole = fs::read_to_string(&path).unwrap();
        fs::write(&path, &whole[..whole.len() - 7]).unwrap();
        assert_eq!(folder.results().unwrap().into_keys().collect::<Vec<_>>(), ["a"]);
        folder.note_result(&result("b")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        fs::write(&path, "{}\n").unwrap();
        assert!(folder.results().unwrap_err().to_string().contains("results.jsonl, line 1"));
    }

    #[test]
    fn drawn_cases_stay_and_a_changed_one_is_drawn_again() {
        let home = TempDir::new().unwrap();
        let folder = WorkFolder::open(Some(home.path()), &settings()).unwrap();
        for name in ["a", "b"] {
            fs::create_dir(home.path().join(name)).unwrap();
            fs::write(home.path().join(name).join("rig.toml"), name).unwrap();
            folder.note_drawn(&CommittedCase::new(home.path(), name, Origin::Drawn, &name).unwrap()).unwrap();
        }
        fs::write(home.path().join("b/rig.toml"), "half").unwrap();
        let drawn = folder.drawn().unwrap();
        assert_eq!(drawn.keys().collect::<Vec<_>>(), ["a"]);
        let answers: Vec<_> = drawn.into_values().collect();
        let made = folder.commit(&answers, &["simulators".to_owned()]).unwrap();
        let (again, left_out) = folder.committed().unwrap().unwrap();
        assert_eq!((again.sha256(), left_out), (made.sha256(), vec!["simulators".to_owned()]));
        assert_eq!(again.open().unwrap().cases(), answers);
        assert!(folder.drawn().unwrap().is_empty());
    }

    #[test]
    fn files_of_a_case_go_only_where_nobody_asked_to_keep_them() {
        let home = TempDir::new().unwrap();
        let kept = WorkFolder::open(Some(home.path()), &settings()).unwrap();
        let temporary = WorkFolder::open(None, &settings()).unwrap();
        for (folder, there) in [(&kept, true), (&temporary, false)] {
            fs::create_dir(folder.path().join("a")).unwrap();
            folder.clear("a").unwrap();
            assert_eq!(folder.path().join("a").exists(), there);
        }
    }
}
