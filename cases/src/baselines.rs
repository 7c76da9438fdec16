//! Baselines: PySINDy and SysIdentPy, each a script in `cases/baselines`, on the same files as the diagnosis.

use std::path::Path;
use std::process::Stdio;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::python::Python;

/// A published identification package.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// Sparse regression on a library of physical terms.
    Pysindy,
    /// Polynomial models by forward regression and an information criterion.
    Sysidentpy,
}

/// Its result on one case.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
pub struct BaselineResult {
    /// Effects of the list that its terms stand for.
    pub named: Vec<String>,
    /// RMS of what its model leaves of force readings that it did not see.
    pub held_out: f64,
    /// RMS of what the refitted nominal law leaves of the same.
    pub refitted: f64,
    /// Of both.
    pub unit: String,
    /// What it took, without the start of Python, s.
    pub seconds: f64,
}

impl Baseline {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Pysindy, Self::Sysidentpy];

    /// As its script is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pysindy => "pysindy",
            Self::Sysidentpy => "sysidentpy",
        }
    }

    /// Runs it on the case in `folder`.
    ///
    /// # Errors
    /// Its script fails, or does not answer as agreed.
    pub fn run(self, python: &Python, folder: &Path) -> Result<BaselineResult> {
        let mut command = python.command(&python.script(self.name())?);
        let output = command.arg(folder).stdin(Stdio::null()).output();
        let output = output.with_context(|| format!("cannot run {}", python.interpreter().display()))?;
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
        ensure!(output.status.success(), "{} failed on {}: {last}", self.name(), folder.display());
        serde_json::from_slice(&output.stdout).with_context(|| format!("{} does not answer as agreed", self.name()))
    }
}
