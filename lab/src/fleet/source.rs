//! The rigs of a fleet, as a folder or a manifest lists them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::{folder, manifest};
use crate::error::InputError;

/// A rig and its recordings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FleetRig {
    /// Its name, which is also that of its folder below the output.
    pub name: String,
    /// The rig file: the simulation.
    pub rig: PathBuf,
    /// The recordings, one file a trial.
    pub recordings: Vec<PathBuf>,
}

/// The rigs of a fleet, and what was passed over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fleet {
    /// In the order of the source.
    pub rigs: Vec<FleetRig>,
    /// Subfolders without a rig file.
    pub passed_over: Vec<PathBuf>,
}

/// The rigs that `source` lists: a folder with a subfolder for each rig, or a manifest in TOML or CSV. `out` is passed over.
///
/// Whether the files are there and what they hold is seen when a rig is diagnosed.
///
/// # Errors
/// There is no such folder or manifest, it lists no rig, or two of the same name.
pub fn read(source: &Path, out: &Path) -> Result<Fleet, InputError> {
    let fleet = if source.is_dir() {
        folder::read(source, out)?
    } else {
        Fleet { rigs: manifest::read(source)?, passed_over: Vec::new() }
    };
    if fleet.rigs.is_empty() {
        let expected = "a subfolder with rig.toml and recordings for each rig, or a manifest that lists them";
        return Err(InputError::new(source.display(), "no rig", expected));
    }
    let mut names = BTreeSet::new();
    match fleet.rigs.iter().find(|rig| !names.insert(rig.name.as_str())) {
        Some(twice) => Err(InputError::new(source.display(), format!("two rigs of the name {:?}", twice.name), "one")),
        None => Ok(fleet),
    }
}
