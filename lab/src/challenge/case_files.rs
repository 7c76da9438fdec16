//! The files of a case, read as `palpate diagnose --rig rig.toml trial-1.csv trial-2.csv` reads them.

use std::path::Path;

use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::Rig;

/// A case as it lies in its folder.
pub struct CaseFiles {
    /// The rig file.
    pub rig: Rig,
    /// Its name, for errors.
    pub origin: String,
    /// Both trials.
    pub trials: Vec<Recording>,
}

/// Reads the case in `folder`.
///
/// # Errors
/// A file at fault.
pub fn read(folder: &Path) -> Result<CaseFiles, InputError> {
    let path = folder.join("rig.toml");
    let rig = Rig::read(&path)?;
    let trial = |name| Recording::read(&folder.join(name), &rig);
    let trials = ["trial-1.csv", "trial-2.csv"].map(trial).into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(CaseFiles { origin: path.display().to_string(), trials, rig })
}
