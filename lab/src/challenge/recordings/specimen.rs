//! A specimen: what is written for the diagnosis, what is kept from it, and what is sealed.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use serde::Serialize;

use super::known_physics::{RECORDING_SETS, RecordingSet, Split};
use super::stroke_split;
use crate::qemu_bench::project;
use crate::recording::Recording;
use crate::rig::Rig;

/// A specimen, some of whose trials are trained on while others are held out.
#[derive(Debug)]
pub struct Specimen {
    /// "tissue_indentation/meat_FF".
    pub name: String,
    /// What is known of it.
    pub set: &'static RecordingSet,
    /// The linear rig.
    pub rig: Rig,
    /// Its file.
    pub rig_file: PathBuf,
    /// Trials that the diagnosis sees.
    pub training: Vec<Recording>,
    /// Those that it does not.
    pub held_out: Vec<Recording>,
    /// Why there are none of those.
    pub no_split_reason: Option<&'static str>,
}

/// The answer as it is sealed.
#[derive(Debug, Serialize)]
pub struct SealedAnswer<'a> {
    recording: &'a str,
    #[serde(rename = "has")]
    stated: &'a [&'a str],
    #[serde(rename = "may")]
    allowed: &'a [&'a str],
    #[serde(rename = "beyond")]
    has_unlisted_physics: bool,
    friction_is_open: bool,
    #[serde(rename = "says")]
    description: &'a str,
    #[serde(rename = "taught")]
    training: Vec<&'a str>,
    #[serde(rename = "unseen")]
    held_out: Vec<&'a str>,
}

/// Names of the files that `trials` are of.
#[must_use]
pub fn names(trials: &[Recording]) -> Vec<&str> {
    trials.iter().map(|trial| trial.name.as_str()).collect()
}

impl Specimen {
    /// What is known of it, and which trials are kept back.
    #[must_use]
    pub fn sealed(&self) -> SealedAnswer<'_> {
        SealedAnswer {
            recording: &self.name,
            stated: self.set.stated,
            allowed: self.set.allowed,
            has_unlisted_physics: self.set.has_unlisted_physics,
            friction_is_open: self.set.friction_is_open,
            description: self.set.description,
            training: names(&self.training),
            held_out: names(&self.held_out),
        }
    }

    /// Names of the files that a diagnosis of it is given.
    #[must_use]
    pub fn files(&self) -> Vec<String> {
        (1..=self.training.len()).map(|number| format!("trial-{number}.csv")).collect()
    }

    /// Makes `folder`, and writes the rig file and the training trials to it, and nothing else.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let rig = folder.join("rig.toml");
        std::fs::copy(&self.rig_file, &rig).with_context(|| format!("cannot write {}", rig.display()))?;
        let files = self.files();
        files.iter().zip(&self.training).try_for_each(|(file, trial)| trial.write(&folder.join(file), &self.rig))?;
        Ok(())
    }
}

/// The specimens in the folder `root` whose name begins with one of `wanted`, all where that is empty, in the order of
/// [`RECORDING_SETS`].
///
/// # Errors
/// A rig file or recording that cannot be read.
pub fn all(root: &Path, wanted: &[String]) -> Result<Vec<Specimen>> {
    let rigs = project()?.join("lab").join("rigs");
    let mut entries = Vec::new();
    for set in &RECORDING_SETS {
        let rig_file = rigs.join(set.rig).with_extension("toml");
        let rig = Rig::read(&rig_file)?;
        for (name, files) in specimens(root, set) {
            let name = format!("{}/{name}", set.folder);
            if !wanted.is_empty() && !wanted.iter().any(|start| name.starts_with(start.as_str())) {
                continue;
            }
            let trials = files.iter().map(|file| Recording::read(file, &rig)).collect::<Result<Vec<_>, _>>()?;
            let (training, held_out, no_split_reason) = split_trials(set.split, trials);
            entries.push(Specimen {
                name,
                set,
                rig: rig.clone(),
                rig_file: rig_file.clone(),
                training,
                held_out,
                no_split_reason,
            });
        }
    }
    Ok(entries)
}

/// Name and files of each specimen of `set`, by name.
fn specimens(root: &Path, set: &RecordingSet) -> Vec<(String, Vec<PathBuf>)> {
    let Ok(listed) = std::fs::read_dir(root.join(set.folder)) else { return Vec::new() };
    let belongs = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.ends_with(".csv") && set.files.iter().any(|start| name.starts_with(start))
    };
    let mut files: Vec<PathBuf> = listed.flatten().map(|entry| entry.path()).filter(belongs).collect();
    files.sort();
    let stem = |file: &PathBuf| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    match set.split {
        Split::Trials(_) if files.is_empty() => Vec::new(),
        Split::Trials(name) => vec![(name.to_owned(), files)],
        Split::Strokes | Split::Whole(_) => files.into_iter().map(|file| (stem(&file), vec![file])).collect(),
    }
}

/// Training trials, those held out, and why there are none of these.
fn split_trials(split: Split, trials: Vec<Recording>) -> (Vec<Recording>, Vec<Recording>, Option<&'static str>) {
    match split {
        Split::Whole(why) => (trials, Vec::new(), Some(why)),
        Split::Strokes => match trials.first().and_then(stroke_split::split_at_turn) {
            Some([first, second]) => (vec![first], vec![second], None),
            None => (trials, Vec::new(), Some("no turn about the middle of its time")),
        },
        Split::Trials(_) => {
            let (even, odd): (Vec<_>, Vec<_>) = trials.into_iter().enumerate().partition(|(at, _)| at % 2 == 0);
            let plain = |numbered: Vec<(usize, Recording)>| numbered.into_iter().map(|(_, trial)| trial).collect();
            let whole = odd.is_empty().then_some("one trial");
            (plain(even), plain(odd), whole)
        }
    }
}
