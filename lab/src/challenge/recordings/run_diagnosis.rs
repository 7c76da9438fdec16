//! One specimen: diagnosed by the command that a user runs, then scored on the trials that were kept from it.

use std::path::Path;

use anyhow::Result;

use super::held_out;
use super::specimen::Specimen;
use super::specimen_score::{ResidualPair, SpecimenScore};
use crate::challenge::run_diagnosis::run_diagnosis;
use crate::rig::Rig;

/// Where the command leaves the improved rig file.
const MODEL: &str = "improved.toml";

/// Runs `tool diagnose` on `entry`, which lies in `folder`, and scores what it tells.
///
/// # Errors
/// The command cannot be started.
pub fn diagnose_specimen(tool: &Path, entry: &Specimen, folder: &Path) -> Result<SpecimenScore> {
    let files = entry.files();
    let arguments: Vec<&str> = files.iter().map(String::as_str).chain(["--model", MODEL]).collect();
    let (diagnosis, seconds) = run_diagnosis(tool, folder, &arguments)?;
    let mut row = SpecimenScore::score(entry, diagnosis, seconds);
    if row.failure.is_none() && !entry.held_out.is_empty() {
        match held_out_rms(entry, &folder.join(MODEL)) {
            Ok([before, after]) => row.held_out = Some(ResidualPair { before: Some(before), after: Some(after) }),
            Err(error) => row.failure = Some(format!("the trials kept back: {error:#}")),
        }
    }
    Ok(row)
}

/// What the refitted nominal law and the improved rig file leave of the trials kept back.
fn held_out_rms(entry: &Specimen, improved: &Path) -> Result<[f64; 2]> {
    let origin = improved.display().to_string();
    let nominal = held_out::refitted(&entry.rig, &entry.rig_file.display().to_string(), &entry.training)?;
    held_out::left([&nominal, &Rig::read(improved)?], &origin, &entry.held_out)
}
