//! The bed of another author's rig: an executable that runs a reference, and may tell what really happened beside what was recorded.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context as _, Result, bail};

use crate::error::InputError;
use crate::experiment_design::Limits;
use crate::investigate::command_bed::{CommandBed, LONGEST_S};
use crate::investigate::monitor::hold_against;
use crate::investigate::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::investigate::watched_bed::{Watched, WatchedBed};
use crate::recording::Recording;
use crate::rig::{Columns, Coordinate, Rig};

/// An executable that is called as `bed REFERENCE.csv RECORDING.csv`.
pub struct SourceBed {
    command: CommandBed,
    /// Names it in errors.
    place: String,
    coordinate: Coordinate,
    rich: Vec<Vec<f64>>,
    next: usize,
    used: [f64; 4],
    watched: Watched,
    seconds: f64,
}

impl SourceBed {
    /// The executable at the absolute path `bed`, whose recordings have the columns of `rig`, with the references `rich` of fixed trials.
    ///
    /// # Errors
    /// The path is no text.
    pub fn new(bed: &Path, rig: &Rig, rich: Vec<Vec<f64>>) -> Result<Self> {
        let place = bed.display().to_string();
        let path =
            bed.to_str().with_context(|| InputError::new(&place, "a path that is no text", "a path in UTF-8"))?;
        Ok(Self {
            command: CommandBed::new(&quoted(path), rig, Duration::from_secs(LONGEST_S)),
            place,
            coordinate: rig.coordinate,
            rich,
            next: 0,
            used: [0.0; 4],
            watched: Watched::TrueMotion,
            seconds: 0.0,
        })
    }

    /// The independent monitor: what happened in a trial, as far as it is told, against the limits.
    fn watch(&mut self, recording: &Recording, true_motion: Option<&Recording>, limits: &Limits) {
        if true_motion.is_none() {
            self.watched = Watched::Recording;
        }
        let happened = true_motion.unwrap_or(recording);
        let (_, mut shares) = hold_against(happened, limits);
        // A true speed needs no mean over a span, which what sensors show does.
        let speeds = true_motion.and_then(|motion| motion.velocity.as_ref());
        shares[1] = speeds.into_iter().flatten().fold(shares[1], |most, speed| most.max(speed.abs() / limits.speed));
        self.used.iter_mut().zip(shares).for_each(|(used, share)| *used = used.max(share));
        self.seconds += happened.time.len() as f64 / happened.rate();
    }
}

impl TestBed for SourceBed {
    fn description(&self) -> String {
        self.command.description()
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome> {
        let told = true_motion_file(request.recording_file);
        // What an earlier run told is not of this one.
        if told.exists() {
            std::fs::remove_file(&told).with_context(|| format!("cannot remove {}", told.display()))?;
        }
        let outcome = self.command.run(request)?;
        let recording = match (&outcome.recording, &outcome.ending) {
            (Some(recording), Ending::Completed | Ending::Stopped(_) | Ending::Interrupted) => recording,
            (_, ending) => {
                let why = if let Ending::Failed(why) = ending { why } else { "no recording" };
                let expected = format!("status 0 and a recording at {}", request.recording_file.display());
                bail!(InputError::new(&self.place, why, expected));
            }
        };
        let happened = told.exists().then(|| Recording::read(&told, &true_motion_rig(self.coordinate))).transpose();
        let happened = happened.with_context(|| format!("{}: what really happened", self.place))?;
        self.watch(recording, happened.as_ref(), request.limits);
        Ok(outcome)
    }
}

impl WatchedBed for SourceBed {
    fn used(&self) -> [f64; 4] {
        self.used
    }

    fn watched(&self) -> Watched {
        self.watched
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn rich_reference(&mut self) -> Vec<f64> {
        let reference = self.rich[self.next % self.rich.len()].clone();
        self.next += 1;
        reference
    }
}

/// Where a bed may tell what really happened: `recording-true.csv` beside `recording.csv`.
fn true_motion_file(recording: &Path) -> PathBuf {
    let stem = recording.file_stem().unwrap_or_default().to_string_lossy();
    recording.with_file_name(format!("{stem}-true.csv"))
}

/// A rig whose recordings are true motions: the names of their columns hold whatever the author's rig file calls those of a recording.
fn true_motion_rig(coordinate: Coordinate) -> Rig {
    let [position, velocity, force, effort] = match coordinate {
        Coordinate::Linear => ["position_m", "speed_m_s", "force_N", "effort_N"],
        Coordinate::Rotary => ["position_rad", "speed_rad_s", "torque_Nm", "effort_Nm"],
    }
    .map(|name| Some(name.to_owned()));
    let columns = Columns { position, velocity, force, effort, ..Columns::default() };
    Rig { coordinate, columns, ..Rig::default() }
}

/// `path` as one word of a shell.
fn quoted(path: &str) -> String {
    format!("'{}'", path.replace('\'', r"'\''"))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;
    use std::sync::atomic::AtomicBool;

    use super::*;

    const LIMITS: Limits = Limits {
        position: [-0.01, 0.01],
        speed: 0.1,
        effort: Some(4.0),
        force: Some(2.0),
        duration_s: 10.0,
        frequency_hz: 20.0,
    };

    const RECORDED: &str = "t_s,position_m,effort_N\\n0.0,0.001,1.0\\n0.001,0.002,1.0\\n";

    /// Runs a bed of the shell `script`, which lies in a folder with a space and a quotation mark in its name.
    fn run(script: &str) -> (Result<TrialOutcome>, SourceBed) {
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path().join("the author's rigs");
        std::fs::create_dir(&home).unwrap();
        let path = home.join("bed");
        std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        let (reference_file, recording_file) = (home.join("reference.csv"), home.join("recording.csv"));
        std::fs::write(&reference_file, "t_s,reference_m\n").unwrap();
        std::fs::write(home.join("recording-true.csv"), "of an earlier run").unwrap();
        let mut bed = SourceBed::new(&path, &Rig::default(), vec![vec![0.1], vec![0.2]]).unwrap();
        let request = TrialRequest {
            reference: &[0.0, 0.0],
            rate_hz: 1000.0,
            limits: &LIMITS,
            reference_file: &reference_file,
            recording_file: &recording_file,
            interrupted: &AtomicBool::new(false),
            round: 1,
        };
        (bed.run(&request), bed)
    }

    #[test]
    fn where_the_bed_tells_nothing_more_the_recording_is_held_against_the_limits() {
        let (outcome, bed) = run(&format!("test -f \"$1\" && printf '{RECORDED}' > \"$2\""));
        assert_eq!(outcome.unwrap().recording.unwrap().position, [0.001, 0.002]);
        assert_eq!((bed.watched(), bed.used()), (Watched::Recording, [0.2, 0.0, 0.0, 0.25]));
        assert!((bed.seconds() - 0.002).abs() < 1e-12);
    }

    #[test]
    fn what_really_happened_is_held_against_the_limits_and_not_what_was_recorded() {
        let told = "t_s,position_m,speed_m_s,force_N,effort_N\\n0.0,0.0,-0.15,0.0,0.0\\n0.001,-0.005,0.0,1.0,2.0\\n";
        let (outcome, bed) = run(&format!("printf '{RECORDED}' > \"$2\"; printf '{told}' > \"${{2%.csv}}-true.csv\""));
        assert_eq!(outcome.unwrap().recording.unwrap().position, [0.001, 0.002]);
        assert_eq!(bed.watched(), Watched::TrueMotion);
        for (share, expected) in bed.used().into_iter().zip([0.5, 1.5, 0.5, 0.5]) {
            assert!((share - expected).abs() < 1e-12, "{:?}", bed.used());
        }
    }

    #[test]
    fn a_bed_that_fails_is_told_by_its_path_and_what_it_did() {
        let told = |script: &str| format!("{:#}", run(script).0.unwrap_err());
        let silent = told("true");
        assert!(silent.contains("the author's rigs/bed") && silent.contains("no such file"), "{silent}");
        assert!(silent.contains("expected status 0 and a recording"), "{silent}");
        let failed = told(&format!("printf '{RECORDED}' > \"$2\"; exit 3"));
        assert!(failed.contains("exit status: 3"), "{failed}");
        let lacking = told(&format!("printf '{RECORDED}' | tee \"$2\" > \"${{2%.csv}}-true.csv\""));
        assert!(lacking.contains("recording-true.csv") && lacking.contains("speed_m_s"), "{lacking}");
    }

    #[test]
    fn rich_references_come_in_order_and_then_from_the_first_again() {
        let (_, mut bed) = run("true");
        let all: Vec<f64> = (0..3).map(|_| bed.rich_reference()[0]).collect();
        assert_eq!(all, [0.1, 0.2, 0.1]);
    }
}
