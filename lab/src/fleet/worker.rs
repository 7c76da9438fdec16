//! The diagnosis of one rig of a fleet: the command that a user runs, in a process of its own.

use std::path::Path;

use anyhow::{Context as _, Result};

use super::rig_folder::{ANSWER, Inputs, OUTPUTS, RigFolder};
use super::source::FleetRig;
use crate::challenge::commitment::hash;
use crate::challenge::diagnosis_json::DiagnosisJson;
use crate::challenge::run_diagnosis::run_command;
use crate::own_program::{self, OwnProgram};

/// Says on how many threads a diagnosis works.
const THREADS: &str = "RAYON_NUM_THREADS";

/// Diagnoses rigs, one at each call; calls may run at the same time.
#[derive(Debug, Clone)]
pub struct Worker {
    program: OwnProgram,
    program_sha256: String,
    seed: u64,
    threads: usize,
}

/// What came of one rig.
#[derive(Debug, Clone)]
pub struct RigResult {
    /// Its name.
    pub name: String,
    /// One SHA-256 over rig file, recordings and seed; empty where they cannot be read.
    pub inputs_sha256: String,
    /// The diagnosis, or why there is none.
    pub diagnosis: Result<DiagnosisJson, String>,
    /// Whether an earlier run had done it already.
    pub is_earlier: bool,
}

impl Worker {
    /// A worker by this program; `threads` are those of each diagnosis, whose answer does not depend on them.
    ///
    /// # Errors
    /// The program cannot be found or read.
    pub fn new(seed: u64, threads: usize) -> Result<Self> {
        let program = own_program::find()?;
        let bytes = std::fs::read(&program.file).with_context(|| format!("cannot read {}", program.file.display()))?;
        Ok(Self { program_sha256: hash(&bytes), program, seed, threads })
    }

    /// Diagnoses `rig` into its folder below `out`, unless an answer of the same inputs is there. Whatever goes wrong is the
    /// result of this rig.
    #[must_use]
    pub fn diagnose(&self, rig: &FleetRig, out: &Path) -> RigResult {
        let inputs = match Inputs::of(rig, self.seed) {
            Ok(inputs) => inputs,
            Err(error) => return RigResult::failed(rig, String::new(), error.to_string()),
        };
        let (inputs_sha256, folder) = (inputs.sha256(), RigFolder::new(out, &rig.name));
        if let Some(diagnosis) = folder.answer_of(&inputs, &self.program_sha256) {
            return RigResult { name: rig.name.clone(), inputs_sha256, diagnosis: Ok(diagnosis), is_earlier: true };
        }
        match self.diagnose_anew(rig, &folder, inputs) {
            Ok(diagnosis) => {
                RigResult { name: rig.name.clone(), inputs_sha256, diagnosis: Ok(diagnosis), is_earlier: false }
            }
            Err(error) => RigResult::failed(rig, inputs_sha256, format!("{error:#}")),
        }
    }

    fn diagnose_anew(&self, rig: &FleetRig, folder: &RigFolder, inputs: Inputs) -> Result<DiagnosisJson> {
        folder.clear()?;
        let mut command = self.program.command();
        command.args(["diagnose", "--seed", &self.seed.to_string(), "--rig"]).arg(&rig.rig);
        for (option, file) in OUTPUTS {
            command.arg(option).arg(folder.file(file));
        }
        command.arg("--").args(&rig.recordings);
        if std::env::var_os(THREADS).is_none() {
            command.env(THREADS, self.threads.to_string());
        }
        let (answer, _) = run_command(&mut command, &folder.file(ANSWER))?;
        let diagnosis = answer.map_err(|error| anyhow::Error::msg(shortened(&error).to_owned()))?;
        folder.note_done(inputs, &self.program_sha256)?;
        Ok(diagnosis)
    }
}

impl RigResult {
    fn failed(rig: &FleetRig, inputs_sha256: String, error: String) -> Self {
        // A row is a line, for people and for programs that read lines.
        let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
        Self { name: rig.name.clone(), inputs_sha256, diagnosis: Err(error), is_earlier: false }
    }

    /// For people who watch a run.
    #[must_use]
    pub fn line(&self) -> String {
        let outcome = match &self.diagnosis {
            Err(error) => format!("failed: {error}"),
            Ok(diagnosis) if diagnosis.physics.is_empty() || diagnosis.verdict == "unknown" => {
                diagnosis.verdict.clone()
            }
            Ok(diagnosis) => format!("{}: {}", diagnosis.verdict, diagnosis.names().join(", ")),
        };
        format!("{}: {outcome}{}", self.name, if self.is_earlier { " (done before)" } else { "" })
    }
}

/// What a command that refuses its input says of itself is known here.
fn shortened(error: &str) -> &str {
    error.strip_prefix("exit status: 1: palpate: ").unwrap_or(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_input_is_told_without_the_command_that_refused_it() {
        assert_eq!(shortened("exit status: 1: palpate: a.csv:2: found x"), "a.csv:2: found x");
        assert_eq!(shortened("signal: 9 (SIGKILL): no message"), "signal: 9 (SIGKILL): no message");
    }

    #[test]
    fn an_error_is_one_line() {
        let rig = FleetRig { name: "a".to_owned(), rig: "rig.toml".into(), recordings: Vec::new() };
        let result = RigResult::failed(&rig, String::new(), "one\n  two\t three".to_owned());
        assert_eq!(result.line(), "a: failed: one two three");
    }
}
