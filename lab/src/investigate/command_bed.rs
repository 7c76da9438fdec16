//! Any command of the user: it takes a reference as CSV and gives a recording.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;
use std::time::Duration;

use anyhow::{Context as _, Result};

use super::bounded_command::{self, Bounds, Ended};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::recording::Recording;
use crate::rig::Rig;

/// How long a command may take for a trial where nothing else is said, s: a simulation of the user's own can take long, and a night is lost to one that never ends.
pub const LONGEST_S: u64 = 3600;

/// How long a command that took too long has to bring its rig to rest.
const GRACE: Duration = Duration::from_secs(30);

/// A command that is called as `COMMAND REFERENCE.csv RECORDING.csv`.
pub struct CommandBed {
    command: String,
    rig: Rig,
    longest: Duration,
    grace: Duration,
}

impl CommandBed {
    /// Calls `command` by the system's shell; its recordings have the columns of `rig`, and a trial takes it so `long` at the most.
    #[must_use]
    pub fn new(command: &str, rig: &Rig, long: Duration) -> Self {
        Self { command: command.to_owned(), rig: rig.clone(), longest: long, grace: GRACE }
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
        let mut command = Command::new("sh");
        command
            .arg("-c")
            .arg(format!("{} \"$1\" \"$2\"", self.command))
            .arg("sh")
            .args([request.reference_file, request.recording_file])
            .stdin(Stdio::null())
            // Standard output is this command's own.
            .stdout(Stdio::from(std::io::stderr()));
        let bounds = Bounds { longest: self.longest, grace: self.grace, interrupted: request.interrupted };
        let ended = bounded_command::run(&mut command, &bounds).context("cannot run a shell")?;
        let recorded = self.recorded(request.recording_file);
        let ending = match (&recorded, ended) {
            // What it wrote until then is kept.
            _ if request.interrupted.load(Ordering::Relaxed) => Ending::Interrupted,
            (_, Ended::OutOfTime) => {
                Ending::Failed(format!("it took longer than {} s and was ended", self.longest.as_secs_f64()))
            }
            (Err(error), Ended::ByItself(status)) => Ending::Failed(format!("{status}; {error}")),
            (Ok(_), Ended::ByItself(status)) if !status.success() => Ending::Failed(status.to_string()),
            (Ok(_), Ended::ByItself(_)) => Ending::Completed,
        };
        Ok(TrialOutcome { recording: recorded.ok(), ending })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::experiment_design::Limits;

    /// How a trial of `command` ends that may take a tenth of a second, and as much again once it is asked to end.
    fn ending_of(command: &str) -> Ending {
        let folder = tempfile::tempdir().unwrap();
        let [reference_file, recording_file] = ["reference.csv", "recording.csv"].map(|name| folder.path().join(name));
        let short = Duration::from_millis(100);
        let mut bed = CommandBed { grace: short, ..CommandBed::new(command, &Rig::default(), short) };
        let limits = Limits {
            position: [-0.01, 0.01],
            speed: 0.1,
            effort: None,
            force: None,
            duration_s: 5.0,
            frequency_hz: 25.0,
        };
        let request = TrialRequest {
            reference: &[],
            rate_hz: 1000.0,
            limits: &limits,
            reference_file: &reference_file,
            recording_file: &recording_file,
            interrupted: &AtomicBool::new(false),
            round: 1,
        };
        bed.run(&request).unwrap().ending
    }

    /// A script that waits for a rig that never answers, for ever; and one that does not even end when it is asked to.
    #[test]
    fn a_command_that_never_ends_is_ended() {
        for command in ["f() { while :; do sleep 1; done; }; f", "trap '' INT; f() { while :; do sleep 1; done; }; f"] {
            assert_eq!(ending_of(command), Ending::Failed("it took longer than 0.1 s and was ended".to_owned()));
        }
    }
}
