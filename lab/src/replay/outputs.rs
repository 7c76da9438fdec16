//! The files that a replay leaves behind.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};

use super::{Options, Place, Replayed, estimates};
use crate::error::InputError;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::page::{Page, Trial, Units, neighbour};
use crate::rig::{Coordinate, Rig};

/// The page's name in its folder.
pub const REPLAY_PAGE: &str = "replay.html";

/// Names that the page of a diagnosis beside it is looked for under.
const DIAGNOSIS_PAGES: [&str; 3] = ["report.html", "diagnosis.html", "diagnose.html"];

/// The output files, opened before the work so that a place that cannot be written shows at once.
pub struct Outputs {
    estimates: Vec<OutFile>,
    page: OutFile,
    folder: PathBuf,
    /// Every file, for the reader.
    paths: Vec<PathBuf>,
}

impl Outputs {
    /// Makes the folders and opens the files: `estimates.csv` in `folder` itself for one trial, in a folder each for
    /// several, and `replay.html`.
    ///
    /// # Errors
    /// The place cannot be written, or is a file that is read.
    pub fn open(folder: &Path, rig: &Path, trials: &[PathBuf]) -> Result<Self> {
        let make = |folder: &Path| {
            let what = || InputError::new(folder.display(), "a folder that cannot be made", "a writable place");
            std::fs::create_dir_all(folder).with_context(what)
        };
        make(folder)?;
        let mut places = Vec::new();
        for (k, trial) in trials.iter().enumerate() {
            let place = match trials.len() {
                1 => folder.to_path_buf(),
                // The number keeps trials of one name in different folders apart.
                _ => folder.join(format!("{:02}-{}", k + 1, trial.file_stem().unwrap_or_default().display())),
            };
            make(&place)?;
            places.push(place.join("estimates.csv"));
        }
        let page = folder.join(REPLAY_PAGE);
        let inputs: Vec<&Path> = trials.iter().map(PathBuf::as_path).chain([rig]).collect();
        let outputs: Vec<_> = places.iter().chain([&page]).map(|place| ("--out", place.as_path())).collect();
        output_paths::check(&inputs, &outputs)?;
        let estimates = places.iter().map(|place| OutFile::create(place)).collect::<Result<_, _>>()?;
        let paths = places.into_iter().chain([page.clone()]).collect();
        Ok(Self { estimates, page: OutFile::create(&page)?, folder: folder.to_owned(), paths })
    }

    /// Writes what was replayed, whole or not at all; returns the files.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn write(
        mut self,
        rig: &Rig,
        replayed: Vec<Replayed>,
        options: &Options,
        place: Place,
    ) -> Result<Vec<PathBuf>> {
        for (file, replayed) in self.estimates.into_iter().zip(&replayed) {
            estimates::write(file, rig.coordinate, replayed)?;
        }
        let diagnosis = neighbour::beside(&self.folder.join(REPLAY_PAGE), &DIAGNOSIS_PAGES, "palpate diagnose");
        let page = Page { diagnosis, ..page(rig, replayed, options, place) };
        page.write(&mut self.page).map_err(|error| self.page.fault(&error))?;
        self.page.commit()?;
        Ok(self.paths)
    }
}

fn page(rig: &Rig, replayed: Vec<Replayed>, options: &Options, place: Place) -> Page {
    let (stiffness, damping) = rig.contact.map_or((f64::NAN, f64::NAN), |c| (c.stiffness, c.damping));
    Page {
        rig: rig.name.clone(),
        ran_on: match place {
            Place::Host => "host".to_owned(),
            Place::Qemu => "Cortex-M4F under QEMU".to_owned(),
        },
        settings: options.in_words(),
        diagnosis: None,
        trials: replayed.into_iter().map(|one| trial(one, units(rig.coordinate), stiffness, damping)).collect(),
    }
}

fn trial(replayed: Replayed, units: Units, nominal_stiffness: f64, nominal_damping: f64) -> Trial {
    let (notices, contact) = (replayed.notices(), replayed.trace.contact());
    let Replayed { recording, plan, trace } = replayed;
    Trial {
        name: recording.name,
        units,
        nominal_stiffness,
        nominal_damping,
        time: recording.time,
        contact,
        methods: trace.into_methods(&plan.samples),
        penetration: plan.samples.iter().map(|sample| sample.position).collect(),
        force: plan.samples.iter().map(|sample| sample.force).collect(),
        notices,
    }
}

fn units(coordinate: Coordinate) -> Units {
    Units {
        position: coordinate.position_unit(),
        force: coordinate.force_unit(),
        stiffness: coordinate.stiffness_unit(),
        damping: coordinate.damping_unit(),
    }
}
