//! The folder of one rig: what its diagnosis wrote, and of which inputs that is the answer.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};

use super::source::FleetRig;
use crate::challenge::commitment::hash;
use crate::challenge::diagnosis_json::DiagnosisJson;
use crate::challenge::run_diagnosis::read_answer;
use crate::error::InputError;
use crate::investigate::record::write;

/// The folder of the rigs in the output.
pub const RIGS: &str = "rigs";
/// The diagnosis, as `palpate diagnose --json` writes it.
pub const ANSWER: &str = "diagnosis.json";
/// What a diagnosis leaves beside its `run.json`: as the options of `palpate diagnose` call it, and its file.
pub const OUTPUTS: [(&str, &str); 3] = [("--json", ANSWER), ("--report", "report.html"), ("--model", "improved.toml")];
/// Written last: where it is, the diagnosis is whole.
const RUN: &str = "run.json";
const SCHEMA: &str = "palpate.fleet-run/1";

/// Everything that decides what a diagnosis answers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inputs {
    /// Name and SHA-256 of the rig file, then of the recordings.
    pub files: Vec<(String, String)>,
    /// Seed of what is drawn at random.
    pub seed: u64,
}

/// Of which inputs the answer in a folder is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Run {
    schema: String,
    inputs: Inputs,
    /// Of the program: the next one may answer otherwise.
    program_sha256: String,
    /// Of the answer itself: a damaged one is none.
    diagnosis_sha256: String,
}

/// The folder of one rig.
#[derive(Debug, Clone)]
pub struct RigFolder {
    path: PathBuf,
}

impl Inputs {
    /// Those of `rig`.
    ///
    /// # Errors
    /// There is no recording, or a file cannot be read.
    pub fn of(rig: &FleetRig, seed: u64) -> Result<Self, InputError> {
        if rig.recordings.is_empty() {
            let place = rig.rig.parent().unwrap_or(Path::new("")).display();
            return Err(InputError::new(place, "no recording", "a trial of this rig beside its rig file"));
        }
        let hashed = |path: &PathBuf| {
            let bytes = fs::read(path).map_err(|error| {
                let found = match error.kind() {
                    std::io::ErrorKind::NotFound => "no such file".to_owned(),
                    _ => format!("it cannot be read: {error}"),
                };
                InputError::new(path.display(), found, "a rig file or recording")
            })?;
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            Ok((name, hash(&bytes)))
        };
        let files = std::iter::once(&rig.rig).chain(&rig.recordings).map(hashed).collect::<Result<_, _>>()?;
        Ok(Self { files, seed })
    }

    /// One SHA-256 over all of them.
    #[must_use]
    pub fn sha256(&self) -> String {
        let lines = self.files.iter().map(|(name, sha256)| format!("{sha256}  {name}\n"));
        hash(format!("seed {}\n{}", self.seed, lines.collect::<String>()).as_bytes())
    }
}

impl RigFolder {
    /// That of the rig `name` in the output `out`.
    #[must_use]
    pub fn new(out: &Path, name: &str) -> Self {
        Self { path: out.join(RIGS).join(name) }
    }

    /// The path of `file` in it.
    #[must_use]
    pub fn file(&self, file: &str) -> PathBuf {
        self.path.join(file)
    }

    /// The answer that is there of just these `inputs`, by the program of `program_sha256`.
    #[must_use]
    pub fn answer_of(&self, inputs: &Inputs, program_sha256: &str) -> Option<DiagnosisJson> {
        let run: Run = serde_json::from_slice(&fs::read(self.file(RUN)).ok()?).ok()?;
        let expected = Run {
            schema: SCHEMA.to_owned(),
            inputs: inputs.clone(),
            program_sha256: program_sha256.to_owned(),
            diagnosis_sha256: hash(&fs::read(self.file(ANSWER)).ok()?),
        };
        let is_whole = OUTPUTS.iter().all(|(_, file)| self.file(file).is_file());
        if run == expected && is_whole { read_answer(&self.file(ANSWER)).ok() } else { None }
    }

    /// Makes the folder, without what an earlier diagnosis left: the answer of other inputs must not pass for that of these.
    ///
    /// # Errors
    /// The folder cannot be made, or a file in it not be removed.
    pub fn clear(&self) -> Result<()> {
        fs::create_dir_all(&self.path).with_context(|| format!("cannot make {}", self.path.display()))?;
        for file in std::iter::once(RUN).chain(OUTPUTS.iter().map(|(_, file)| *file)) {
            let path = self.file(file);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(error).with_context(|| format!("cannot remove {}", path.display()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Notes that the diagnosis in it is whole, and of which inputs it is.
    ///
    /// # Errors
    /// An output is missing, or the note cannot be written.
    pub fn note_done(&self, inputs: Inputs, program_sha256: &str) -> Result<()> {
        for (_, file) in OUTPUTS {
            ensure!(self.file(file).is_file(), "{}: was not written", self.file(file).display());
        }
        let answer = self.file(ANSWER);
        let bytes = fs::read(&answer).with_context(|| format!("cannot read {}", answer.display()))?;
        let run = Run {
            schema: SCHEMA.to_owned(),
            inputs,
            program_sha256: program_sha256.to_owned(),
            diagnosis_sha256: hash(&bytes),
        };
        let text = serde_json::to_string_pretty(&run).context("a run cannot be written as JSON")? + "\n";
        write(&self.file(RUN), text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANSWER: &str = r#"{"schema": "palpate.diagnosis/1", "verdict": "no_mismatch", "rivals": [], "physics": [],
        "fit": {"unit": "N", "noise_floor": 1.0, "refitted": 1.0, "improved": 1.0}}"#;

    fn inputs(seed: u64, sha256: &str) -> Inputs {
        Inputs { files: vec![("rig.toml".to_owned(), sha256.to_owned())], seed }
    }

    #[test]
    fn an_answer_is_that_of_its_inputs_seed_and_program_alone() {
        let home = tempfile::tempdir().unwrap();
        let folder = RigFolder::new(home.path(), "a");
        folder.clear().unwrap();
        for (_, file) in OUTPUTS {
            fs::write(folder.file(file), ANSWER).unwrap();
        }
        assert!(folder.answer_of(&inputs(1, "x"), "p").is_none(), "nothing is noted yet");
        folder.note_done(inputs(1, "x"), "p").unwrap();
        assert_eq!(folder.answer_of(&inputs(1, "x"), "p").unwrap().verdict, "no_mismatch");
        for (other, program) in [(inputs(2, "x"), "p"), (inputs(1, "y"), "p"), (inputs(1, "x"), "q")] {
            assert!(folder.answer_of(&other, program).is_none(), "{other:?} {program}");
        }
        fs::write(folder.file("diagnosis.json"), ANSWER.replace("no_mismatch", "explained")).unwrap();
        assert!(folder.answer_of(&inputs(1, "x"), "p").is_none(), "the answer was changed");
        fs::write(folder.file("diagnosis.json"), ANSWER).unwrap();
        fs::remove_file(folder.file("report.html")).unwrap();
        assert!(folder.answer_of(&inputs(1, "x"), "p").is_none(), "the report is gone");
        assert!(folder.note_done(inputs(1, "x"), "p").is_err(), "the report is gone");
        folder.clear().unwrap();
        assert_eq!(fs::read_dir(home.path().join("rigs/a")).unwrap().count(), 0);
    }

    #[test]
    fn inputs_are_told_apart_by_name_content_order_and_seed() {
        let pair = |files: [(&str, &str); 2], seed| {
            Inputs { files: files.map(|(name, hash)| (name.to_owned(), hash.to_owned())).to_vec(), seed }.sha256()
        };
        let one = pair([("a", "1"), ("b", "2")], 1);
        assert_eq!(one, pair([("a", "1"), ("b", "2")], 1));
        let others = [
            pair([("b", "2"), ("a", "1")], 1),
            pair([("a", "2"), ("b", "1")], 1),
            pair([("a", "1"), ("b", "3")], 1),
            pair([("a", "1"), ("b", "2")], 2),
        ];
        assert!(others.iter().all(|other| *other != one));
    }
}
