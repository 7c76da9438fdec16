//! The files that a replay leaves behind.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};

use super::{Options, Place, Plan, Replayed, Written};
use crate::error::InputError;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::page::{self, Method, Page, Summary, Trial, Units, neighbour};
use crate::rig::{Coordinate, Rig};

/// The page's name in its folder.
pub const REPLAY_PAGE: &str = "replay.html";

/// Names that the page of a diagnosis beside it is looked for under.
const DIAGNOSIS_PAGES: [&str; 3] = ["report.html", "diagnosis.html", "diagnose.html"];

/// What a trial leaves behind while it is replayed.
pub struct Sink {
    /// Its `estimates.csv`.
    pub file: OutFile,
    /// Names the units in the columns.
    pub coordinate: Coordinate,
    /// How many trials share the page.
    pub trials: usize,
}

impl Sink {
    /// Rows that the page draws at most of a trial that is replayed as `plan` says.
    #[must_use]
    pub fn page_rows(&self, plan: &Plan) -> usize {
        page::budget(self.trials, plan.methods.len())
    }
}

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

    /// Where each trial writes, in their order.
    #[must_use]
    pub fn sinks(&mut self, coordinate: Coordinate) -> Vec<Sink> {
        let files = std::mem::take(&mut self.estimates);
        let trials = files.len();
        files.into_iter().map(|file| Sink { file, coordinate, trials }).collect()
    }

    /// Puts what was replayed in its place, the page last; returns the files.
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
        let (stiffness, damping) = rig.contact.map_or((f64::NAN, f64::NAN), |c| (c.stiffness, c.damping));
        let mut trials = Vec::with_capacity(replayed.len());
        for one in replayed {
            let Some(Written { file, drawn }) = one.written else { continue };
            file.commit()?;
            trials.push(Trial {
                name: one.name,
                units: units(rig.coordinate),
                nominal_stiffness: stiffness,
                nominal_damping: damping,
                methods: one.summaries.into_iter().map(method).collect(),
                drawn,
                notices: one.notices,
            });
        }
        let page = Page {
            rig: rig.name.clone(),
            ran_on: match place {
                Place::Host => "host".to_owned(),
                Place::Qemu => "Cortex-M4F under QEMU".to_owned(),
            },
            settings: options.in_words(),
            diagnosis: neighbour::beside(&self.folder.join(REPLAY_PAGE), &DIAGNOSIS_PAGES, "palpate diagnose"),
            trials,
        };
        page.write(&mut self.page).map_err(|error| self.page.fault(&error))?;
        self.page.commit()?;
        Ok(self.paths)
    }
}

fn method((method, summary): (palpate::Method, Option<Summary>)) -> Method {
    Method { name: method.name(), title: method.title(), summary }
}

fn units(coordinate: Coordinate) -> Units {
    Units {
        position: coordinate.position_unit(),
        force: coordinate.force_unit(),
        stiffness: coordinate.stiffness_unit(),
        damping: coordinate.damping_unit(),
    }
}
