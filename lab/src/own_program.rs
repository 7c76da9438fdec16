//! How this program is started again, for work that gets a process of its own.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

use anyhow::{Context as _, Result};

/// The command of this program, and the file that holds its code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnProgram {
    /// The program and the arguments before its own: `python -m palpate`, say.
    pub command: Vec<OsString>,
    /// The file that answers come from: where it changes, they may.
    pub file: PathBuf,
}

static DECLARED: OnceLock<OwnProgram> = OnceLock::new();

/// Declares how this program is started, where its executable is that of an interpreter. The first declaration stays.
pub fn declare(program: OwnProgram) {
    let _ = DECLARED.set(program);
}

/// What was declared, or the executable of this process.
///
/// # Errors
/// The system does not say what this process runs.
pub fn find() -> Result<OwnProgram> {
    if let Some(declared) = DECLARED.get() {
        return Ok(declared.clone());
    }
    let file = std::env::current_exe().context("this program cannot find itself")?;
    Ok(OwnProgram { command: vec![file.clone().into_os_string()], file })
}

impl OwnProgram {
    /// A command that runs this program.
    #[must_use]
    pub fn command(&self) -> Command {
        let (program, arguments) = self
            .command
            .split_first()
            .map_or((self.file.as_os_str(), &[][..]), |(program, rest)| (program.as_os_str(), rest));
        let mut command = Command::new(program);
        command.args(arguments);
        command
    }
}
