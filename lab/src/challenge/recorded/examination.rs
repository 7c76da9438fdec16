//! One specimen: diagnosed by the command that a user runs, then scored on the trials that were kept from it.

use std::path::Path;

use anyhow::Result;

use super::entry::Entry;
use super::row::{Residual, Row};
use super::unseen;
use crate::challenge::examination::diagnose;
use crate::rig::Rig;

/// Where the command leaves the improved rig file.
const MODEL: &str = "improved.toml";

/// Runs `tool diagnose` on `entry`, which lies in `folder`, and scores what it tells.
///
/// # Errors
/// The command cannot be started.
pub fn examine(tool: &Path, entry: &Entry, folder: &Path) -> Result<Row> {
    let files = entry.files();
    let arguments: Vec<&str> = files.iter().map(String::as_str).chain(["--model", MODEL]).collect();
    let (told, seconds) = diagnose(tool, folder, &arguments)?;
    let mut row = Row::score(entry, told, seconds);
    if row.failure.is_none() && !entry.unseen.is_empty() {
        match held(entry, &folder.join(MODEL)) {
            Ok([before, after]) => row.unseen = Some(Residual { before: Some(before), after: Some(after) }),
            Err(error) => row.failure = Some(format!("the trials kept back: {error:#}")),
        }
    }
    Ok(row)
}

/// What the refitted nominal law and the improved rig file leave of the trials kept back.
fn held(entry: &Entry, improved: &Path) -> Result<[f64; 2]> {
    let origin = improved.display().to_string();
    let nominal = unseen::refitted(&entry.rig, &entry.rig_file.display().to_string(), &entry.taught)?;
    unseen::left([&nominal, &Rig::read(improved)?], &origin, &entry.unseen)
}
