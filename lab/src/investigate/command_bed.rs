//! Any command of the user: it takes a reference as CSV and gives a recording.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;

use anyhow::{Context as _, Result};

use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::recording::Recording;
use crate::rig::Rig;

/// A command that is called as `COMMAND REFERENCE.csv RECORDING.csv`.
pub struct CommandBed {
    command: String,
    rig: Rig,
}

impl CommandBed {
    /// Calls `command` by the system's shell; its recordings have the columns of `rig`.
    #[must_use]
    pub fn new(command: &str, rig: &Rig) -> Self {
        Self { command: command.to_owned(), rig: rig.clone() }
    }

    /// What `path` holds, if anything.
    fn recorded(&self, path: &Path) -> Result<Recording, String> {
        Recording::read(path, &self.rig).map_err(|error| error.to_string())
    }
}

impl TestBed for CommandBed {
    fn description(&self) -> String {
        format!("the command `{}`", self.command)
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome> {
        // A recording of an earlier run is not one of this.
        if request.recording_file.exists() {
            std::fs::remove_file(request.recording_file)
                .with_context(|| format!("cannot remove {}", request.recording_file.display()))?;
        }
        let status = Command::new("sh")
            .arg("-c")
            .arg(format!("{} \"$1\" \"$2\"", self.command))
            .arg("sh")
            .args([request.reference_file, request.recording_file])
            .stdin(Stdio::null())
            // Standard output is this command's own.
            .stdout(Stdio::from(std::io::stderr()))
            .status()
            .context("cannot run a shell")?;
        let recorded = self.recorded(request.recording_file);
        let ending = match &recorded {
            // Ctrl-C reaches the command as well: what it wrote until then is kept.
            _ if request.interrupted.load(Ordering::Relaxed) => Ending::Interrupted,
            Err(error) => Ending::Failed(format!("{status}; {error}")),
            Ok(_) if !status.success() => Ending::Failed(status.to_string()),
            Ok(_) => Ending::Completed,
        };
        Ok(TrialOutcome { recording: recorded.ok(), ending })
    }
}
