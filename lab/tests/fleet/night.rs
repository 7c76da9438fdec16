//! A fleet of small rigs in a folder, and runs of `palpate diagnose-all` over it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use assert_cmd::assert::Assert;
use tempfile::TempDir;

use crate::bench::{BENCH, Case, FADES, Size, led, palpate};

/// The rigs of most tests.
pub const FLEET: [&str; 2] = ["fades", "plain"];

/// As the bench, long enough for its answer.
const SIZE: Size = BENCH;

/// A folder with `fleet`, in it a subfolder for each rig.
pub struct Night {
    folder: TempDir,
}

/// The rig file and recordings of the rig `name`: as its file says, one that fades, or one that is stiffer.
fn case(name: &str) -> &'static Case {
    static CASES: [OnceLock<Case>; 3] = [OnceLock::new(), OnceLock::new(), OnceLock::new()];
    let (at, stiffness, effects) = match name {
        "plain" => (0, 300.0, ""),
        "fades" => (1, 300.0, FADES),
        _ => (2, 330.0, ""),
    };
    CASES[at].get_or_init(|| Case::new(&led(SIZE, 300.0, 0), |trial| led(SIZE, stiffness, trial), effects))
}

impl Night {
    pub fn new(rigs: &[&str]) -> Self {
        let night = Self { folder: TempDir::new().unwrap() };
        rigs.iter().for_each(|rig| night.replace(rig, rig));
        night
    }

    /// Puts the files of the rig `source` into the folder of `rig`.
    pub fn replace(&self, rig: &str, source: &str) {
        let folder = self.path("fleet").join(rig);
        fs::create_dir_all(&folder).unwrap();
        for file in ["rig.toml", "trial-1.csv", "trial-2.csv"] {
            fs::copy(case(source).path(file), folder.join(file)).unwrap();
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// `palpate diagnose-all fleet --out OUT` in the folder.
    pub fn run(&self, out: &str, rest: &[&str]) -> Assert {
        self.command("fleet", out, rest)
    }

    /// The same of another source.
    pub fn command(&self, source: &str, out: &str, rest: &[&str]) -> Assert {
        palpate().current_dir(&self.folder).args(["diagnose-all", source, "--out", out]).args(rest).assert()
    }

    /// `palpate diagnose` of one rig of the fleet.
    pub fn diagnose(&self, rig: &str, json: &str) {
        let [file, one, two] = ["rig.toml", "trial-1.csv", "trial-2.csv"].map(|name| format!("fleet/{rig}/{name}"));
        palpate()
            .current_dir(&self.folder)
            .args(["diagnose", "--rig", &file, &one, &two, "--json", json])
            .assert()
            .success();
    }
}

/// The rows of a table, cells by their columns.
pub fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}
