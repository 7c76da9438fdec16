//! `palpate` as a user drives it, with good and with broken input.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

fn palpate() -> Command {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
}

/// `palpate replay` against the bench's rig.
fn replay() -> Command {
    let mut command = palpate();
    command.args(["replay", "--rig"]).arg(bench_rig());
    command
}

fn bench_rig() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs").join("bench.toml")
}

/// A folder of its own, and in it a trial of `seconds` at 1 kHz: a wall of 300 N/m and 5 N s/m, tapped at 10 Hz.
fn with_trial(seconds: f64) -> (TempDir, PathBuf) {
    let folder = TempDir::new().expect("a folder");
    let mut text = String::from("t_s,position_m,force_N\n");
    for k in 0..(seconds * 1e3) as u32 {
        let t = f64::from(k) * 1e-3;
        let phase = 62.831_853 * t;
        let (x, v) = (0.010 + 0.003 * phase.sin(), 0.003 * 62.831_853 * phase.cos());
        writeln!(text, "{t:.3},{x:.7},{:.4}", 300.0 * x + 5.0 * v).expect("a string takes it");
    }
    let path = folder.path().join("trial.csv");
    fs::write(&path, text).expect("a file");
    (folder, path)
}

/// The columns of a CSV file by name.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(path).expect("estimates");
    let headers = reader.headers().expect("a header").clone();
    let at = headers.iter().position(|header| header == name).unwrap_or_else(|| panic!("{name} is not in {headers:?}"));
    reader.records().map(|row| row.expect("a row")[at].parse().expect("a number")).collect()
}

/// Replays `text` as a trial, expecting exit status 1 and a message with all of `words`.
fn refuses(text: &[u8], words: &[&str]) {
    let folder = TempDir::new().expect("a folder");
    let trial = folder.path().join("trial.csv");
    fs::write(&trial, text).expect("a file");
    let out = folder.path().join("out");
    let mut command = replay();
    command.arg(&trial).arg("--out").arg(&out);
    let assert = command.assert().code(1).stdout("");
    let assert = words.iter().fold(assert, |assert, word| assert.stderr(contains(*word)));
    assert.stderr(contains("panicked").not());
    assert!(!out.join("estimates.csv").exists() && !out.join("replay.html").exists(), "no output of a refused file");
}

#[test]
fn replay_writes_the_columns_of_the_contract_and_finds_the_wall() {
    let (folder, trial) = with_trial(1.5);
    let out = folder.path().join("out");
    palpate()
        .args(["replay", "--method", "bls,newton_blmf,ewrls", "--out"])
        .arg(&out)
        .arg("--rig")
        .arg(bench_rig())
        .arg(&trial)
        .assert()
        .success()
        .stdout(contains("newton_blmf"));
    let estimates = out.join("estimates.csv");
    let header = fs::read_to_string(&estimates).expect("estimates");
    let expected = "t_s,contact,bls_stiffness_n_m,bls_damping_n_s_m,bls_innovation_n,newton_blmf_stiffness_n_m,\
                    newton_blmf_damping_n_s_m,newton_blmf_innovation_n,ewrls_stiffness_n_m,ewrls_damping_n_s_m,ewrls_innovation_n,";
    assert!(header.starts_with(expected), "{}", header.lines().next().unwrap_or_default());
    let (contact, stiffness) = (column(&estimates, "contact"), column(&estimates, "bls_stiffness_n_m"));
    assert_eq!(contact.len(), 1500);
    assert!(contact.iter().all(|c| *c == 1.0), "the trial never leaves the wall");
    // Positions are written to 1e-7 m of 10 mm and forces to 1e-4 N of 3 N: a tenth of a per mille is ten times that.
    assert!(stiffness[400..].iter().all(|k| (k / 300.0 - 1.0).abs() < 1e-4));
    // The trapezoidal rule leaves (2 pi 10 Hz 1 ms)^2 / 12 = 0.33 per mille of B.
    let damping = column(&estimates, "bls_damping_n_s_m");
    assert!(damping[400..].iter().all(|b| (b / 5.0 - 1.0 + 3.3e-4).abs() < 2e-4), "{}", damping[1000]);
    assert!(fs::read_to_string(out.join("replay.html")).expect("a page").contains("trial.csv"));
}

#[test]
fn the_order_of_methods_and_a_second_run_change_nothing_else() {
    let (folder, trial) = with_trial(0.5);
    let run = |name: &str, methods: &str| {
        let out = folder.path().join(name);
        replay().args(["--method", methods]).arg(&trial).arg("--out").arg(&out).assert().success();
        out.join("estimates.csv")
    };
    let (first, second) = (run("a", "sprls,blmf"), run("b", "sprls,blmf"));
    assert_eq!(fs::read(&first).expect("a file"), fs::read(&second).expect("a file"));
    let turned = run("c", "blmf,rls,sprls");
    assert_eq!(column(&first, "blmf_damping_n_s_m"), column(&turned, "blmf_damping_n_s_m"));
}

#[test]
fn several_trials_get_a_folder_each_and_one_page() {
    let (folder, trial) = with_trial(0.4);
    let out = folder.path().join("out");
    replay().args([&trial, &trial]).arg("--out").arg(&out).assert().success();
    for place in ["01-trial/estimates.csv", "02-trial/estimates.csv", "replay.html"] {
        assert!(out.join(place).is_file(), "{place}");
    }
}

#[test]
fn broken_recordings_are_refused_with_place_finding_and_expectation() {
    refuses(b"", &["trial.csv", "an empty file"]);
    refuses(b"t_s,position_m\n0,1\n1,2\n", &["trial.csv:1", "t_s, position_m", "force_N"]);
    refuses(b"t_s,position_m,force_N\n0,1,2\n0.001,abc,2\n", &["trial.csv:3", "position_m", "\"abc\"", "a number"]);
    refuses(b"t_s,position_m,force_N\n0,1,2\n0.001,1,NaN\n", &["trial.csv:3", "force_N"]);
    refuses(b"t_s,position_m,force_N\n0,1,2\n0.002,1,2\n0.001,1,2\n", &["trial.csv:4", "t_s", "0.001", "0.002"]);
    refuses(b"t_s,position_m,force_N\n0,1,2\n", &["trial.csv", "two rows"]);
    refuses(b"t_s,position_m,force_N\n0,1\n", &["trial.csv:2"]);
    refuses(b"t_s,position_m,effort_N\n0,1,1\n0.001,1,1\n", &["trial.csv", "force"]);
    refuses(b"\xff\xfe\x00\x01", &["trial.csv"]);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let (folder, trial) = with_trial(0.01);
    let absent = folder.path().join("absent.csv");
    replay().arg(&absent).assert().code(1).stderr(contains("absent.csv").and(contains("no such file")));
    let rig = folder.path().join("absent.toml");
    palpate()
        .args(["replay", "--rig"])
        .arg(&rig)
        .arg(&trial)
        .assert()
        .code(1)
        .stderr(contains("absent.toml").and(contains("no such file")));
}

#[test]
fn a_rig_without_a_contact_cannot_be_replayed() {
    let (folder, trial) = with_trial(0.01);
    let rig = folder.path().join("rig.toml");
    fs::write(&rig, "[rig]\nname = \"free\"\n[drive]\nmass_kg = 1.0\nviscous_n_s_m = 0.0\n").expect("a file");
    palpate().args(["replay", "--rig"]).arg(&rig).arg(&trial).assert().code(1).stderr(contains("[contact]"));
}

#[test]
fn a_wrong_option_is_the_command_lines_fault() {
    let (_folder, trial) = with_trial(0.05);
    for (option, value, word) in [
        ("--method", "kalman", "newton_blmf"),
        ("--window", "1", "2..=2048"),
        ("--window", "4096", "2..=2048"),
        ("--forgetting", "1.5", "--forgetting: found 1.5"),
        ("--forgetting", "nan", "--forgetting: found NaN"),
        ("--initial-covariance", "-3", "--initial-covariance"),
        ("--sprls-beta", "-1", "--sprls-beta"),
        ("--velocity-cutoff", "900", "at most 400"),
        ("--velocity", "fast", "matched"),
        ("--on", "moon", "qemu"),
    ] {
        let option = format!("{option}={value}");
        replay().arg(&trial).arg(&option).assert().code(2).stderr(contains(word));
    }
    replay().assert().code(2);
    palpate().arg("divine").assert().code(2);
}

#[test]
fn a_place_that_cannot_be_written_is_told_before_the_work() {
    let (folder, trial) = with_trial(0.05);
    let file = folder.path().join("file");
    fs::write(&file, "in the way").expect("a file");
    replay().arg(&trial).arg("--out").arg(file.join("out")).assert().code(1).stderr(contains("out"));
    assert_eq!(fs::read_to_string(&file).expect("still there"), "in the way");
}

#[test]
fn ten_samples_a_second_lower_the_filter_and_say_so() {
    let folder = TempDir::new().expect("a folder");
    let trial = folder.path().join("slow.csv");
    let mut text = String::from("t_s,position_m,force_N\n");
    for k in 0..400 {
        let t = f64::from(k) * 0.1;
        let x = 0.005 + 0.002 * (0.5 * t).sin();
        writeln!(text, "{t:.1},{x:.8},{:.6}", 300.0 * x + 5.0 * 0.001 * (0.5 * t).cos()).expect("a string takes it");
    }
    fs::write(&trial, text).expect("a file");
    let mut command = replay();
    command.args(["--method", "bls", "--window", "100"]).arg(&trial);
    command.assert().success().stderr(contains("lowered from 20 to 2.0000 Hz")).stdout(contains("bls"));
    replay().args(["--velocity-cutoff", "20"]).arg(&trial).assert().code(2);
}

#[test]
fn a_million_rows_come_through() {
    let (folder, trial) = with_trial(1000.0);
    let out = folder.path().join("out");
    replay().args(["--method", "ewrls"]).arg(&trial).arg("--out").arg(&out).assert().success();
    assert_eq!(column(&out.join("estimates.csv"), "t_s").len(), 1_000_000);
}

#[test]
fn what_is_simulated_is_replayed_to_the_rigs_own_figures() {
    let folder = TempDir::new().expect("a folder");
    let trial = folder.path().join("trial.csv");
    palpate().args(["simulate", "--seed", "3", "--rig"]).arg(bench_rig()).arg("--out").arg(&trial).assert().success();
    let out = folder.path().join("out");
    replay().args(["--method", "bls"]).arg(&trial).arg("--out").arg(&out).assert().success();
    let known: Vec<(f64, f64)> = column(&out.join("estimates.csv"), "bls_stiffness_n_m")
        .into_iter()
        .zip(column(&out.join("estimates.csv"), "bls_stiffness_ci95_n_m"))
        .zip(column(&out.join("estimates.csv"), "contact"))
        .filter(|((_, half_width), contact)| *contact == 1.0 && *half_width < 5.0)
        .map(|(figures, _)| figures)
        .collect();
    let covered = known.iter().filter(|(k, half_width)| (k - 300.0).abs() <= *half_width).count();
    assert!(known.len() > 20_000, "{} of 30 000 samples in contact are known to 5 N/m", known.len());
    assert!(covered as f64 > 0.9 * known.len() as f64, "{covered} of {} intervals of 95 % hold 300 N/m", known.len());
}

/// Where nothing is missing, the drive's law and that of the diagnosis give one stiffness and one damping of one recording, and the pages
/// link to one another.
#[test]
fn replay_and_diagnosis_of_one_recording_agree_within_their_intervals() {
    let folder = TempDir::new().expect("a folder");
    let text = fs::read_to_string(bench_rig()).expect("a rig").replace("duration_s = 60.0", "duration_s = 9.0");
    fs::write(folder.path().join("rig.toml"), text.replace("period_s = 30.0", "period_s = 16.0")).expect("a rig file");
    let run = |arguments: &[&str]| {
        let done = palpate().current_dir(&folder).args(arguments).assert().success();
        String::from_utf8(done.get_output().stdout.clone()).expect("text")
    };
    run(&["simulate", "--rig", "rig.toml", "--seed", "3", "--out", "trial.csv"]);
    let shown = run(&["replay", "--rig", "rig.toml", "trial.csv", "--out", "."]);
    let diagnosis = run(&["diagnose", "--rig", "rig.toml", "trial.csv", "--json", "-", "--report", "report.html"]);
    let diagnosis: serde_json::Value = serde_json::from_str(&diagnosis).expect("JSON");
    assert_eq!(diagnosis["physics"].as_array().map(Vec::len), Some(0), "{diagnosis}");
    // "trial.csv cusum_rls 300.0 ± 1.5 4.992 ± 0.049 0.62"
    let row = shown.lines().find(|line| line.contains("cusum_rls")).expect("the recommended law");
    let numbers: Vec<f64> = row.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    for (key, [value, half_width]) in
        [("stiffness_n_m", [numbers[0], numbers[1]]), ("damping_n_s_m", [numbers[2], numbers[3]])]
    {
        let nominal = diagnosis["nominal"].as_array().expect("nominal values");
        let found = nominal.iter().find(|value| value["name"] == key).unwrap_or_else(|| panic!("{key}: {diagnosis}"));
        let [low, high] = [0, 1].map(|end| found["ci95"][end].as_f64().expect("an end"));
        assert!(
            low <= value + half_width && value - half_width <= high,
            "{key}: replay {value} ± {half_width}, diagnosis {low} to {high}"
        );
    }
    let page = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a page");
    assert!(page("report.html").contains("<a href=\"replay.html\">"));
    run(&["replay", "--rig", "rig.toml", "trial.csv", "--out", "."]);
    assert!(page("replay.html").contains("<a href=\"report.html\">"));
    // One contact from the second second on, however it bounces at its start.
    assert!(page("replay.html").contains("in contact (one touch)"), "touches");
}

#[test]
fn a_simulated_trial_has_the_column_names_of_its_rig() {
    let folder = TempDir::new().expect("a folder");
    let (rig, trial) = (folder.path().join("rig.toml"), folder.path().join("trial.csv"));
    let bench = fs::read_to_string(bench_rig()).expect("a rig");
    fs::write(&rig, bench + "\n[columns]\nforce = \"load, measured\"\n").expect("a file");
    palpate().args(["simulate", "--rig"]).arg(&rig).arg("--out").arg(&trial).assert().success();
    let header = fs::read_to_string(&trial).expect("a trial");
    assert!(header.starts_with("t_s,position_m,\"load, measured\",effort_N,"), "{:?}", header.lines().next());
    palpate().args(["replay", "--rig"]).arg(&rig).arg(&trial).assert().success();
}

#[test]
fn a_contact_that_is_no_spring_and_damper_is_told() {
    let folder = TempDir::new().expect("a folder");
    let trial = folder.path().join("odd.csv");
    let mut text = String::from("t_s,position_m,force_N\n");
    for k in 0..1500 {
        let phase = 62.831_853e-3 * f64::from(k);
        let (x, v) = (0.010 + 0.003 * phase.sin(), 0.003 * 62.831_853 * phase.cos());
        writeln!(text, "{:.3},{x:.7},{:.4}", f64::from(k) * 1e-3, 300.0 * x - 5.0 * v).expect("a string takes it");
    }
    fs::write(&trial, text).expect("a file");
    let mut command = replay();
    command.args(["--method", "bls"]).arg(&trial);
    command.assert().success().stderr(contains("bls: for most of the contact K or B is negative"));
    let (_folder, sound) = with_trial(1.5);
    let mut command = replay();
    command.args(["--method", "bls"]).arg(&sound);
    command.assert().success().stderr(contains("negative").not());
}
