//! A fleet as a folder: a subfolder for each rig.

use std::fs;
use std::path::{Path, PathBuf};

use super::source::{Fleet, FleetRig};
use crate::error::InputError;

/// The file that states a rig, in its own folder or, for rigs of one make, once in the folder of the fleet.
const RIG_FILE: &str = "rig.toml";
/// Endings of the formats that recordings are read from.
const RECORDING_ENDINGS: [&str; 6] = ["csv", "npz", "mat", "parquet", "pq", "mcap"];
/// How recordings begin where other files of such formats lie beside them.
const TRIAL_PREFIX: &str = "trial-";

/// The rigs of `folder`, by name. Hidden folders and `out` are passed over.
///
/// # Errors
/// The folder cannot be read, or the name of a rig is no Unicode.
pub fn read(folder: &Path, out: &Path) -> Result<Fleet, InputError> {
    let shared = folder.join(RIG_FILE);
    let shared = shared.is_file().then_some(shared);
    let own_output = fs::canonicalize(out).ok();
    let mut fleet = Fleet { rigs: Vec::new(), passed_over: Vec::new() };
    for path in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
        let Some(name) = path.file_name().and_then(|name| name.to_str()).map(str::to_owned) else {
            return Err(InputError::new(path.display(), "a name that is no Unicode", "a name that a table can hold"));
        };
        if name.starts_with('.') || (own_output.is_some() && fs::canonicalize(&path).ok() == own_output) {
            continue;
        }
        let own = path.join(RIG_FILE);
        let recordings = recordings(&path)?;
        match (own.is_file(), &shared) {
            (true, _) => fleet.rigs.push(FleetRig { name, rig: own, recordings }),
            (false, Some(shared)) if !recordings.is_empty() => {
                fleet.rigs.push(FleetRig { name, rig: shared.clone(), recordings });
            }
            _ => fleet.passed_over.push(path),
        }
    }
    Ok(fleet)
}

/// The recordings in the folder of a rig, by name: those called `trial-*`, or all where none is.
fn recordings(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let ending = |path: &PathBuf| path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let is_recording = |path: &PathBuf| ending(path).is_some_and(|ending| RECORDING_ENDINGS.contains(&ending.as_str()));
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let all: Vec<PathBuf> = entries(folder)?
        .into_iter()
        .filter(|path| is_recording(path) && !name(path).starts_with('.') && path.is_file())
        .collect();
    let trials: Vec<PathBuf> = all.iter().filter(|path| name(path).starts_with(TRIAL_PREFIX)).cloned().collect();
    Ok(if trials.is_empty() { all } else { trials })
}

/// What is in `folder`, by name.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let fault = |error: std::io::Error| {
        InputError::new(folder.display(), format!("it cannot be read: {error}"), "a folder that may be read")
    };
    let mut paths = fs::read_dir(folder)
        .map_err(fault)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()
        .map_err(fault)?;
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    fn fleet(files: &[&str]) -> (TempDir, Fleet) {
        let home = TempDir::new().unwrap();
        for file in files {
            let path = home.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let fleet = read(home.path(), &home.path().join("out")).unwrap();
        (home, fleet)
    }

    /// Name, rig file and recordings of each rig, paths below the folder of the fleet.
    fn listed(files: &[&str]) -> Vec<(String, String, Vec<String>)> {
        let (home, fleet) = fleet(files);
        let below = |path: &PathBuf| path.strip_prefix(home.path()).unwrap().display().to_string();
        let of = |rig: &FleetRig| (rig.name.clone(), below(&rig.rig), rig.recordings.iter().map(below).collect());
        fleet.rigs.iter().map(of).collect()
    }

    #[test]
    fn each_subfolder_with_a_rig_file_is_a_rig_with_its_trials() {
        let found =
            listed(&["b/rig.toml", "b/trial-2.csv", "b/trial-1.csv", "b/notes.csv", "b/truth.json", "a/rig.toml"]);
        let trials = vec!["b/trial-1.csv".to_owned(), "b/trial-2.csv".to_owned()];
        assert_eq!(
            found,
            [("a".to_owned(), "a/rig.toml".to_owned(), Vec::new()), ("b".to_owned(), "b/rig.toml".to_owned(), trials),]
        );
    }

    #[test]
    fn where_nothing_is_called_a_trial_every_recording_is_one() {
        let found = listed(&["a/rig.toml", "a/monday.MCAP", "a/friday.csv", "a/.hidden.csv", "a/report.html"]);
        assert_eq!(found[0].2, ["a/friday.csv", "a/monday.MCAP"]);
    }

    #[test]
    fn rigs_of_one_make_share_the_rig_file_of_the_fleet() {
        let found = listed(&["rig.toml", "a/1.csv", "b/1.csv", "b/rig.toml", "c/notes.txt"]);
        let rigs: Vec<_> = found.iter().map(|(name, rig, _)| (name.as_str(), rig.as_str())).collect();
        assert_eq!(rigs, [("a", "rig.toml"), ("b", "b/rig.toml")]);
    }

    #[test]
    fn folders_without_a_rig_are_passed_over_and_named_hidden_ones_and_the_output_are_not() {
        let (home, fleet) = fleet(&["a/rig.toml", "b/1.csv", ".git/rig.toml", "out/rig.toml"]);
        assert_eq!(fleet.rigs.len(), 1);
        assert_eq!(fleet.passed_over, [home.path().join("b")]);
    }
}
