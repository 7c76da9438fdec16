//! Where cases come from: a simulator that draws them, or a folder of another author.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use palpate_cases::SimulatorKind;

/// A value of `--source`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CaseSource {
    /// Draws cases from the seed.
    Simulator(SimulatorKind),
    /// Holds cases with a file of answers.
    Folder(PathBuf),
}

impl CaseSource {
    /// The simulators among `sources`; all where `sources` is empty.
    #[must_use]
    pub fn simulators(sources: &[Self]) -> Vec<SimulatorKind> {
        if sources.is_empty() {
            return SimulatorKind::ALL.to_vec();
        }
        let simulator = |source: &Self| match source {
            Self::Simulator(kind) => Some(*kind),
            Self::Folder(_) => None,
        };
        sources.iter().filter_map(simulator).collect()
    }
}

impl FromStr for CaseSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(kind) = SimulatorKind::ALL.into_iter().find(|kind| kind.name() == text) {
            return Ok(Self::Simulator(kind));
        }
        if Path::new(text).is_dir() {
            return Ok(Self::Folder(PathBuf::from(text)));
        }
        Err("expected own, mujoco, drake, exudyn, or a folder of cases with their answers".to_owned())
    }
}

impl fmt::Display for CaseSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulator(kind) => f.write_str(kind.name()),
            Self::Folder(folder) => write!(f, "{}", folder.display()),
        }
    }
}
