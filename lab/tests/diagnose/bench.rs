//! A small test bed: a tool that is led against a pad, two trials of five seconds, three contacts each.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A pad that fades, clearly above the floor.
pub const FADES: &str =
    "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 60\nrelaxation_time_s = 0.3\n";

/// The units of the bench in SI, and its clock.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    pub metre: f64,
    pub newton: f64,
    /// Seconds of a bench second: all that the pad and the tool do takes so much longer.
    pub second: f64,
    pub rate_hz: f64,
    /// Bench seconds.
    pub duration_s: f64,
    /// Step of the position sensor, in bench metres.
    pub count: f64,
}

/// Millimetres and newtons.
pub const BENCH: Size = Size { metre: 1.0, newton: 1.0, second: 1.0, rate_hz: 400.0, duration_s: 5.0, count: 5e-6 };

/// A rig that touches a pad of `stiffness`, led along one of two references.
pub fn led(size: Size, stiffness: f64, trial: usize) -> String {
    let (l, f, t) = (size.metre, size.newton, size.second);
    let (depth, contact, sine) = [(0.008, 1.1, 3.0), (0.007, 1.0, 7.3)][trial];
    format!(
        "[rig]\nname = \"bench\"\ncoordinate = \"linear\"\n\
         [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = {:e}\ndamping_n_s_m = {:e}\n\
         [sensors]\nposition_resolution_m = {:e}\nforce_resolution_n = {:e}\nforce_noise_n = {:e}\n\
         [reference]\nfree_depth_m = {:e}\ncontact_depth_m = {:e}\nperiod_s = {}\ncontact_s = {}\n\
         smoothing_s = {}\nsine_amplitude_m = {:e}\nsine_frequency_hz = {}\n\
         [simulation]\nduration_s = {}\nrate_hz = {}\n",
        stiffness * f / l,
        5.0 * f * t / l,
        size.count * l,
        0.005 * f,
        0.01 * f,
        -0.003 * l,
        depth * l,
        1.6 * t,
        contact * t,
        0.05 * t,
        0.002 * l,
        sine / t,
        size.duration_s * t,
        size.rate_hz
    )
}

/// A drive that touches nothing.
pub fn driven(trial: usize) -> String {
    let all = led(BENCH, 300.0, trial);
    let (head, tail) = (all.find("[contact]").unwrap(), all.find("[reference]").unwrap());
    format!(
        "{}[drive]\nmass_kg = 0.45\nviscous_n_s_m = 2.0\n[sensors]\nposition_resolution_m = 5e-6\n\
         [control]\nproportional_n_m = 775\nderivative_n_s_m = 10\nrate_hz = 1000\n{}",
        &all[..head],
        &all[tail..]
    )
}

pub fn palpate() -> Command {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
}

/// A folder with the rig as its owner knows it and two recordings of the real one.
pub struct Case {
    pub folder: TempDir,
}

impl Case {
    /// `known` is the rig file; `truth` gives the real rig of each trial, to which `table` is added.
    pub fn new(known: &str, truth: impl Fn(usize) -> String, table: &str) -> Self {
        let case = Self { folder: TempDir::new().unwrap() };
        case.write("rig.toml", known);
        for trial in 0..2 {
            case.write("truth.toml", &(truth(trial) + table));
            let (seed, out) = ((trial + 1).to_string(), format!("trial-{}.csv", trial + 1));
            let arguments = ["simulate", "--rig", "truth.toml", "--seed", &seed, "--out", &out];
            palpate().current_dir(&case.folder).args(arguments).assert().success();
        }
        fs::remove_file(case.path("truth.toml")).unwrap();
        case
    }

    /// The led bench with `table` in the real one.
    pub fn led(size: Size, table: &str) -> Self {
        Self::new(&led(size, 300.0, 0), |trial| led(size, 300.0, trial), table)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Adds `more` to each row of `column` in both trials.
    pub fn shift(&self, column: &str, more: f64) {
        for name in ["trial-1.csv", "trial-2.csv"] {
            let text = fs::read_to_string(self.path(name)).unwrap();
            let (header, rows) = text.split_once('\n').unwrap();
            let at = header.split(',').position(|name| name == column).unwrap();
            let shifted = rows.lines().map(|row| {
                let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
                cells[at] = (cells[at].parse::<f64>().unwrap() + more).to_string();
                cells.join(",")
            });
            self.write(name, &format!("{header}\n{}\n", shifted.collect::<Vec<_>>().join("\n")));
        }
    }

    /// `palpate diagnose` in the folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = palpate();
        command.current_dir(&self.folder).arg("diagnose").args(arguments);
        command
    }

    /// What comes out for both trials, with more `arguments`.
    pub fn diagnose(&self, arguments: &[&str]) -> Value {
        self.found(&[&["--rig", "rig.toml", "trial-1.csv", "trial-2.csv"], arguments].concat())
    }

    /// What comes out on standard output, which is JSON and nothing else.
    pub fn found(&self, arguments: &[&str]) -> Value {
        let output = self.command(arguments).args(["--json", "-"]).assert().success().get_output().stdout.clone();
        serde_json::from_slice(&output).unwrap()
    }

    /// Rewrites the rows of each recording, `change` being told the header's columns as they stand.
    pub fn rewrite(&self, change: impl Fn(usize, &mut Vec<f64>) -> bool) {
        for name in ["trial-1.csv", "trial-2.csv"] {
            self.write(name, &rewritten(&self.path(name), &change));
        }
    }
}

/// A force that is written down 2 ms late, for which a slow sensor would do as well: physics, a rival, locations and an experiment,
/// diagnosed once for all tests.
pub fn late() -> &'static (Value, String) {
    static LATE: OnceLock<(Value, String)> = OnceLock::new();
    LATE.get_or_init(|| {
        let case = Case::led(BENCH, "[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.002\n");
        let answer = case.diagnose(&["--experiment", "next.csv"]);
        (answer, fs::read_to_string(case.path("next.csv")).unwrap())
    })
}

/// The recording at `path` with each row changed, or left out where `change` says no.
pub fn rewritten(path: &Path, change: impl Fn(usize, &mut Vec<f64>) -> bool) -> String {
    let text = fs::read_to_string(path).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let mut out = format!("{header}\n");
    for (at, row) in rows.lines().enumerate() {
        let mut values: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        if change(at, &mut values) {
            out += &(values.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n");
        }
    }
    out
}

/// A number of the answer's fit.
pub fn fit(answer: &Value, key: &str) -> f64 {
    answer["fit"][key].as_f64().unwrap()
}

/// Whether the answer is what it should be where `name` alone is missing.
pub fn names(answer: &Value, name: &str) {
    assert_eq!((&answer["verdict"], &answer["physics"][0]["name"]), (&"explained".into(), &name.into()), "{answer:#}");
    assert_eq!(answer["physics"].as_array().unwrap().len(), 1);
}
