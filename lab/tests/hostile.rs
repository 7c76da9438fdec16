//! Input and use that nobody means well with: what once aborted, hung, overwrote or printed what it should not.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;
use palpate_lab::simulate::simulate;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;

fn palpate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("palpate").expect("the command");
    command.current_dir(folder);
    command
}

/// A folder with the bench as `rig.toml`, and every `every`th row of `seconds` of it from its first contact on.
fn bench(seconds: f64, every: usize) -> (TempDir, Rig, Recording) {
    let folder = TempDir::new().expect("a folder");
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs/bench.toml")).expect("a rig");
    std::fs::write(folder.path().join("rig.toml"), &text).expect("a rig file");
    let text = text.replace("duration_s = 60.0", &format!("duration_s = {:?}", 15.0 + seconds));
    let rig = Rig::parse(&text, "rig.toml").expect("a rig");
    let trial = simulate(&rig, 1, "rig.toml").expect("a trial").recording;
    let first = trial.time.partition_point(|time| *time < 14.9);
    let column = |values: &[f64]| values[first..].iter().step_by(every).copied().collect::<Vec<_>>();
    let trial = Recording {
        time: column(&trial.time),
        position: column(&trial.position),
        force: trial.force.as_deref().map(column),
        ..Recording::default()
    };
    (folder, rig, trial)
}

fn write(folder: &TempDir, name: &str, rig: &Rig, trial: &Recording) -> PathBuf {
    let path = folder.path().join(name);
    trial.write(&path, rig).expect("a recording");
    path
}

/// The diagnosis of `trial.csv` in `folder`.
fn diagnosed(folder: &TempDir) -> Value {
    let mut command = palpate(folder.path());
    let done = command.args(["diagnose", "--rig", "rig.toml", "trial.csv", "--json", "-"]).assert().success();
    serde_json::from_slice(&done.get_output().stdout).expect("JSON")
}

fn codes(answer: &Value) -> Vec<&str> {
    let findings = answer["findings"].as_array().expect("findings");
    findings.iter().filter_map(|finding| finding["code"].as_str()).collect()
}

#[test]
fn an_hour_without_rows_makes_two_trials() {
    let (folder, rig, mut trial) = bench(6.0, 10);
    let half = trial.time.len() / 2;
    trial.time[half..].iter_mut().for_each(|time| *time += 3600.0);
    write(&folder, "trial.csv", &rig, &trial);
    let answer = diagnosed(&folder);
    assert!(codes(&answer).contains(&"pauses"), "{answer}");
    assert_eq!(answer["verdict"], "no_mismatch", "{answer}");
}

#[test]
fn a_clock_that_is_set_in_a_trial_is_survived_whatever_it_leaps_to() {
    let (folder, rig, trial) = bench(3.0, 10);
    for (first, last) in [(-1.7e9, None), (-1e300, None), (0.0, Some(1e308)), (f64::MIN, Some(f64::MAX))] {
        let mut leaps = trial.clone();
        leaps.time[0] += first;
        if let Some(last) = last {
            *leaps.time.last_mut().expect("rows") = last;
        }
        write(&folder, "trial.csv", &rig, &leaps);
        assert!(codes(&diagnosed(&folder)).contains(&"pauses"));
    }
}

#[test]
fn the_first_rows_of_a_recording_are_diagnosed_or_refused_and_never_panic() {
    let (folder, rig, trial) = bench(1.0, 1);
    for rows in [2, 31, 32, 33, 47, 64, 100, 150] {
        let mut short = trial.clone();
        short.time.truncate(rows);
        short.position.truncate(rows);
        short.force.iter_mut().for_each(|force| force.truncate(rows));
        write(&folder, "trial.csv", &rig, &short);
        let mut command = palpate(folder.path());
        command.args(["diagnose", "--rig", "rig.toml", "trial.csv"]).assert().code(i32::from(rows < 32));
    }
}

#[test]
fn a_replay_into_the_folder_of_its_input_leaves_it_as_it_is() {
    let (folder, rig, trial) = bench(1.0, 1);
    let path = write(&folder, "estimates.csv", &rig, &trial);
    let before = std::fs::read(&path).expect("a recording");
    let mut command = palpate(folder.path());
    command.args(["replay", "--rig", "rig.toml", "estimates.csv", "--out", "."]);
    command.assert().code(1).stdout("").stderr(contains("estimates.csv").and(contains("an input of this very run")));
    assert_eq!(std::fs::read(&path).expect("a recording"), before);
    assert!(!folder.path().join("replay.html").exists());
}

#[test]
fn no_place_is_written_twice() {
    let (folder, rig, trial) = bench(1.0, 1);
    write(&folder, "trial.csv", &rig, &trial);
    let diagnose = ["diagnose", "--rig", "rig.toml", "trial.csv", "--json", "x", "--report", "./x"];
    for arguments in [
        diagnose.as_slice(),
        &["challenge", "--from", "no.json", "--json", "x", "--report", "./x"],
        &["profile", "--json", "x", "--listing", "./x"],
    ] {
        let assert = palpate(folder.path()).args(arguments).assert().code(2).stdout("");
        assert.stderr(contains("x, which --json writes"));
        assert!(!folder.path().join("x").exists());
    }
    // A device takes what it is given.
    #[cfg(unix)]
    {
        let mut command = palpate(folder.path());
        command.args(["diagnose", "--rig", "rig.toml", "trial.csv", "--json", "/dev/null", "--report", "/dev/null"]);
        command.assert().success();
    }
}

#[test]
fn no_control_character_of_a_file_or_its_name_reaches_the_terminal() {
    let (folder, rig, trial) = bench(1.0, 1);
    std::fs::write(folder.path().join("field.csv"), "t_s,position_m,force_N\n0,0,0\n1,\u{1b}[31mred,0\n")
        .expect("a file");
    std::fs::write(folder.path().join("column.csv"), "t_s,po\u{1b}[31msition_m,force_N\n0,0,0\n1,0,0\n")
        .expect("a file");
    let mut commands = vec![
        vec!["replay", "--rig", "rig.toml", "field.csv"],
        vec!["replay", "--rig", "rig.toml", "column.csv"],
        vec!["look", "column.csv"],
        vec!["look", "column.csv", "--rig-template"],
    ];
    // Other systems do not have such names.
    if cfg!(unix) {
        write(&folder, "a\u{1b}[31mb.csv", &rig, &trial);
        commands.push(vec!["replay", "--rig", "rig.toml", "a\u{1b}[31mb.csv", "--out", "out"]);
        commands.push(vec!["diagnose", "--rig", "rig.toml", "a\u{1b}[31mb.csv", "--model", "m\u{1b}[31m.toml"]);
        commands.push(vec!["diagnose", "--rig", "rig.toml", "no\u{1b}[31m.csv"]);
    }
    for arguments in commands {
        let done = palpate(folder.path()).args(&arguments).output().expect("it runs");
        for said in [&done.stdout, &done.stderr] {
            assert!(!said.contains(&0x1b), "{arguments:?}: {}", String::from_utf8_lossy(said));
        }
        assert_ne!(done.status.code(), Some(101), "{arguments:?}");
    }
}

#[test]
fn no_time_is_too_long_to_listen_for() {
    let folder = TempDir::new().expect("a folder");
    let listen = |seconds: &str| {
        palpate(folder.path()).args(["listen", "--port", "no-such-port", "--for", seconds]).assert().stdout("")
    };
    listen("1e300").code(1).stderr(contains("no-such-port"));
    listen("inf").code(1).stderr(contains("no-such-port"));
    listen("-0.5").code(2).stderr(contains("--for"));
    listen("nan").code(2).stderr(contains("--for"));
}

#[test]
fn a_calibration_with_a_slip_of_the_pen_is_refused_by_its_key() {
    let folder = TempDir::new().expect("a folder");
    let example = palpate(folder.path()).args(["calibrate", "--example"]).output().expect("it runs").stdout;
    let example = String::from_utf8(example).expect("text");
    for (text, key) in [
        (format!("force_limits = 3.0\n{example}"), "force_limits"),
        (example.replace("max_speed = 2.0", "max_speed = 1e30"), "max_speed"),
        (example.replace("travel = [-0.04, 0.04]", "travel = [-1e9, 1e9]"), "travel"),
    ] {
        std::fs::write(folder.path().join("cal.toml"), text).expect("a file");
        let mut command = palpate(folder.path());
        command.args(["calibrate", "cal.toml", "--out", "cal.bin"]).assert().code(1).stderr(contains(key));
        assert!(!folder.path().join("cal.bin").exists());
    }
}

/// A signal while a diagnosis runs: it ends with the status of an interruption, and the files that it had begun are gone.
#[cfg(unix)]
#[test]
fn a_signal_leaves_no_temporary_file_behind() {
    let (folder, rig, trial) = bench(30.0, 1);
    write(&folder, "trial.csv", &rig, &trial);
    let begun = || {
        let files = std::fs::read_dir(folder.path()).expect("a folder").flatten();
        files.filter(|file| file.file_name().to_string_lossy().starts_with(".palpate-")).count()
    };
    for signal in ["-INT", "-TERM"] {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_palpate"));
        command.current_dir(&folder).args(["diagnose", "--rig", "rig.toml", "trial.csv", "--json", "out.json"]);
        let mut child = command.stderr(std::process::Stdio::null()).spawn().expect("it runs");
        while begun() == 0 {
            assert!(child.try_wait().expect("a process").is_none(), "it ended before it began");
            std::thread::yield_now();
        }
        std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
        assert_eq!(child.wait().expect("it ends").code(), Some(130), "{signal}");
        assert_eq!(begun(), 0, "{signal}");
        assert!(!folder.path().join("out.json").exists());
    }
}
