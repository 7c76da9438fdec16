//! Recordings in the formats that users have, written by those formats' own tools (`formats/make.py`).

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;

use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;

const RIG: &str = "[rig]\nname = \"a\"\n";
const MCAP: &str = "[rig]\nname = \"a\"\n[columns]\nposition = \"/joint_states:elbow.position\"\n\
                    effort = \"/joint_states:elbow.effort\"\nforce = \"/wrench:force.z\"\n";

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("formats").join(name)
}

fn read(path: &Path, rig: &str) -> Result<Recording, String> {
    let rig = Rig::parse(rig, "rig.toml").expect("a rig");
    Recording::read(path, &rig).map_err(|error| error.to_string())
}

fn refuses(path: &Path, rig: &str, words: &[&str]) {
    let error = read(path, rig).expect_err("a file at fault");
    for word in words {
        assert!(error.contains(word), "\"{error}\" lacks \"{word}\"");
    }
}

/// The trial of `make.py` to the last bit but for rounding.
fn is_the_trial(recording: &Recording, rows: usize) {
    assert_eq!(recording.time.len(), rows);
    let (force, effort) = (recording.force.as_ref().expect("force"), recording.effort.as_ref().expect("effort"));
    for row in 0..rows {
        let t = recording.time[row];
        let near = |value: f64, wanted: f64| assert!((value - wanted).abs() < 1e-9, "row {row}: {value}, not {wanted}");
        near(recording.position[row], 0.01 * t);
        near(force[row], 3.0 + t);
        near(effort[row], 2.0 * t);
    }
}

#[test]
fn every_format_gives_the_same_recording() {
    for name in ["trial.npz", "trial.mat", "plain.mat", "trial.parquet"] {
        is_the_trial(&read(&file(name), RIG).unwrap_or_else(|error| panic!("{name}: {error}")), 50);
    }
    let sysid = format!("{RIG}[columns]\nposition = \"slide_pos\"\nforce = \"touch\"\neffort = \"motor\"\n");
    is_the_trial(&read(&file("sysid.npz"), &sysid).expect("the signals of MuJoCo's system identification"), 50);
}

#[test]
fn topics_with_clocks_of_their_own_are_brought_onto_that_of_the_position() {
    for name in ["trial.mcap", "lz4.mcap", "plain.mcap"] {
        let recording = read(&file(name), MCAP).unwrap_or_else(|error| panic!("{name}: {error}"));
        // The first instant is before the first force.
        is_the_trial(&recording, 49);
        assert!((recording.time[0] - 0.01).abs() < 1e-9);
    }
}

#[test]
fn the_longer_side_of_a_matrix_is_time() {
    let rig = format!("{RIG}[columns]\nposition = \"both[0]\"\neffort = \"both[1]\"\n");
    let recording = read(&file("trial.mat"), &rig).expect("a matrix of two rows");
    assert!((recording.effort.expect("effort")[10] - 0.2).abs() < 1e-12);
}

#[test]
fn a_file_cut_short_is_refused_or_read_as_far_as_it_goes() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["trial.npz", "trial.mat", "trial.parquet", "plain.mcap", "trial.mcap"] {
        let bytes = std::fs::read(file(name)).expect("a file");
        for length in (0..bytes.len()).step_by(97) {
            let path = folder.path().join(name);
            std::fs::write(&path, &bytes[..length]).expect("a file");
            // No panic. MCAP is read up to where it was cut, and of a MAT-file the arrays that are whole.
            if let Ok(recording) = read(&path, if name.ends_with("mcap") { MCAP } else { RIG }) {
                let rows = recording.time.len();
                assert!(rows == 50 || name.ends_with("mcap"), "{name} cut to {length} was read with {rows} rows");
                assert_eq!(recording.position.len(), rows);
            }
        }
    }
}

#[test]
fn another_format_than_the_ending_says_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let copied = |from: &str, to: &str| {
        let path = folder.path().join(to);
        std::fs::copy(file(from), &path).expect("a copy");
        path
    };
    refuses(&copied("trial.npz", "a.csv"), RIG, &["a.csv", "a NPZ file", "CSV"]);
    refuses(&copied("trial.parquet", "b.npz"), RIG, &["a Parquet file", "NPZ"]);
    refuses(&copied("make.py", "c.mcap"), RIG, &["text", "MCAP"]);
    // Without an ending the content decides.
    is_the_trial(&read(&copied("trial.npz", "recording"), RIG).expect("an archive"), 50);
    let hdf5 = folder.path().join("new.mat");
    std::fs::write(&hdf5, b"MATLAB 7.3 MAT-file, Platform: GLNXA64").expect("a file");
    refuses(&hdf5, RIG, &["7.3", "-v7"]);
}

#[test]
fn what_is_wrong_with_a_channel_is_said() {
    refuses(&file("object.npz"), RIG, &["force_N", "object array"]);
    refuses(&file("unequal.npz"), RIG, &["force_N", "49 values", "50"]);
    refuses(&file("nan.npz"), RIG, &["force_N, value 8", "no number"]);
    refuses(&file("zstd.parquet"), RIG, &["zstd", "Snappy"]);
    let text = format!("{RIG}[columns]\neffort = \"note\"\n");
    refuses(&file("trial.parquet"), &text, &["note", "text"]);
    let absent = MCAP.replace("elbow.position", "knee.position");
    refuses(&file("trial.mcap"), &absent, &["/joint_states:knee.position", "/joint_states:elbow.position"]);
    let unread = MCAP.replace("/joint_states:elbow.position", "/note");
    refuses(&file("trial.mcap"), &unread, &["/note", "std_msgs/msg/String"]);
}

#[test]
fn the_command_says_it_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let archive = folder.path().join("archive.csv");
    std::fs::copy(file("trial.npz"), &archive).expect("a copy");
    let drive = "[drive]\nmass_kg = 1.0\nviscous_n_s_m = 3.0\n";
    let absent = MCAP.replace("elbow.position", "knee.position");
    let faults: [(&Path, &str, &[&str]); 6] = [
        (&archive, RIG, &["archive.csv", "a NPZ file", "CSV"]),
        (&file("trial.mcap"), &absent, &["trial.mcap", "/joint_states:knee.position", "/joint_states:elbow.position"]),
        (&file("unequal.npz"), RIG, &["unequal.npz", "force_N", "49 values", "50"]),
        (&file("object.npz"), RIG, &["object.npz", "force_N", "object array"]),
        (&file("nan.npz"), RIG, &["nan.npz", "force_N, value 8", "no number"]),
        (&file("zstd.parquet"), RIG, &["zstd.parquet", "zstd", "Snappy"]),
    ];
    for (recording, rig, words) in faults {
        let place = folder.path().join("rig.toml");
        std::fs::write(&place, format!("{rig}{drive}")).expect("a rig");
        let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
        let assert = command.args(["diagnose", "--rig"]).arg(&place).arg(recording).assert().code(1).stdout("");
        words.iter().fold(assert, |assert, word| assert.stderr(contains(*word)));
    }
}

fn look(name: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    command.arg("look").arg(file(name));
    command
}

#[test]
fn look_lists_rates_ranges_and_what_is_not_read() {
    look("trial.mcap").assert().success().stdout(
        contains("MCAP file")
            .and(contains("/joint_states:elbow.position"))
            .and(contains("100.00"))
            .and(contains("std_msgs/msg/String")),
    );
    look("trial.npz").assert().success().stdout(
        // Values, rate, least and greatest, as they are read at once.
        contains("time in t_s").and(contains("t_s                50      100.00             0          0.49\n")),
    );
    look("nan.npz").assert().success().stdout(contains("1 values are no finite number"));
    look("nothing.npz").assert().code(1).stderr(contains("no such file"));
}

#[test]
fn the_template_of_every_format_is_a_rig_file_that_reads_the_file() {
    for name in ["trial.npz", "sysid.npz", "trial.mat", "trial.parquet", "trial.mcap"] {
        let output = look(name).arg("--rig-template").output().expect("palpate");
        let text = String::from_utf8(output.stdout).expect("text");
        let recording = read(&file(name), &text).unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
        assert!(recording.time.len() >= 49, "{name}");
    }
}
