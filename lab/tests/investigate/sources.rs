//! Rigs of another author, put to the trial of the method: a folder whose `bed` runs what is concealed.

use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use palpate_lab::investigate::trial_of_method::row::Row;
use palpate_lab::investigate::watched_bed::Watched;
use tempfile::TempDir;

use super::design::bench;

const FRICTION: &str = "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.6\n";
const LIMITS: &str = "[limits]\nposition_min_m = -0.02\nposition_max_m = 0.02\nspeed_m_s = 0.4\neffort_n = 25.0\nforce_n = 8.0\nduration_s = 6.0\n";

/// What the author says of his rig, and something else.
const FRICTION_IS_TRUE: &str = r#"{"000": {"truth": ["coulomb_friction"]}}"#;
const NOTHING_IS_TRUE: &str = r#"{"000": {"truth": [], "also": [["gravity_load"]]}}"#;

/// The name of a folder that a shell has to be told as one word.
const SET: &str = "second author";

/// A bed that notes how it was called and moves the concealed rig its own way, whatever is commanded.
fn bed() -> String {
    let palpate = env!("CARGO_BIN_EXE_palpate");
    format!(
        "#!/bin/sh\nhome=$(dirname \"$0\")\necho \"$1|$2\" >> \"$home/calls\"\n\
         exec '{palpate}' simulate --rig \"$home/hidden.toml\" --seed \"$(wc -l < \"$home/calls\")\" --out \"$2\"\n"
    )
}

/// The rig `name` of the source below `home`, with friction that its rig file does not know.
fn write_rig(home: &Path, name: &str, bed: &str) -> PathBuf {
    let rig = home.join(SET).join(name);
    std::fs::create_dir_all(&rig).unwrap();
    bench("").write(&rig.join("rig.toml")).unwrap();
    bench(FRICTION).write(&rig.join("hidden.toml")).unwrap();
    let motion = |row: usize| format!("{},{}\n", row as f64 * 1e-3, 1e-3 * (row as f64 * 1e-3).sin());
    let rich = (0..6000).map(motion).fold("t_s,reference_m\n".to_owned(), |text, row| text + &row);
    for (file, text) in [("limits.toml", LIMITS), ("rich-1.csv", &rich), ("bed", bed)] {
        std::fs::write(rig.join(file), text).unwrap();
    }
    std::fs::set_permissions(rig.join("bed"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let hidden = rig.join("hidden.toml");
    let arguments = ["simulate", "--seed", "99", "--out", "trial-1.csv", "--rig"];
    palpate(&rig).args(arguments).arg(hidden).assert().success();
    rig
}

fn write_truth(home: &Path, truth: &str) {
    std::fs::write(home.join(SET).join("truth.json"), truth).unwrap();
}

fn palpate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("palpate").unwrap();
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

/// The command on the source below `home`, with one designed trial a rig.
fn challenge(home: &Path, out: &str) -> Command {
    let mut command = palpate(home);
    command.args(["investigate-challenge", "--cases", "0", "--source", SET, "--rounds", "1", "--out", out]);
    command
}

/// The one row of a run, and its table.
fn scored(home: &Path, out: &str) -> (Row, String) {
    let read = |name: &str| std::fs::read_to_string(home.join(out).join(name)).unwrap();
    let rows: Vec<Row> = serde_json::from_str(&read("rows.json")).unwrap();
    let [row] = rows.as_slice() else { panic!("{} rows", rows.len()) };
    (row.clone(), read("table.md"))
}

#[test]
fn a_rig_of_another_author_is_investigated_and_not_run_again() {
    let home = TempDir::new().unwrap();
    let rig = write_rig(home.path(), "000", &bed());
    write_truth(home.path(), FRICTION_IS_TRUE);
    challenge(home.path(), "out").assert().success();
    let (row, table) = scored(home.path(), "out");
    assert_eq!((row.source.as_str(), row.case.as_deref(), row.strength), (SET, Some("000"), None));
    assert_eq!(row.comparison.last().named, ["coulomb_friction"]);
    assert!(row.is_right_and_alone(&row.comparison.fixed), "{row:?}");
    assert_eq!((row.comparison.rounds.len(), row.comparison.watched), (1, Watched::Recording));
    assert!(
        table.contains("Rigs of `second author`") && table.contains("| one effect | fixed rich trials | 1 of 1"),
        "{table}"
    );

    // One designed trial and one along the author's reference, each at a place that the bed finds from wherever it is.
    let calls = std::fs::read_to_string(rig.join("calls")).unwrap();
    let calls: Vec<(&Path, &Path)> = calls
        .lines()
        .map(|call| call.split_once('|').map(|(one, other)| (Path::new(one), Path::new(other))).unwrap())
        .collect();
    let [designed, fixed] = calls.as_slice() else { panic!("{calls:?}") };
    assert!(
        designed.0.is_absolute() && designed.0.ends_with("case-second author-000/round-1/reference.csv"),
        "{calls:?}"
    );
    assert!(fixed.1.is_absolute() && fixed.1.ends_with("fixed-0/recording.csv"), "{calls:?}");
    let positions = |path: &Path| {
        let text = std::fs::read_to_string(path).unwrap();
        text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect::<Vec<f64>>()
    };
    assert_eq!(positions(fixed.0), positions(&rig.join("rich-1.csv")));

    // What is said to be true changes the score and not the answers: it is no part of what is investigated.
    write_truth(home.path(), NOTHING_IS_TRUE);
    std::fs::remove_file(rig.join("calls")).unwrap();
    challenge(home.path(), "other").assert().success();
    let (other, _) = scored(home.path(), "other");
    let answers =
        |row: &Row| (row.comparison.first.clone(), row.comparison.rounds.clone(), row.comparison.fixed.clone());
    assert_eq!(answers(&other), answers(&row));
    assert!(!other.is_right(&other.comparison.fixed));
    assert!(!home.path().join("other/case-second author-000/hidden.toml").exists());

    // A further run needs the bed no more, and holds what it finds against what is said to be true now.
    std::fs::write(rig.join("bed"), "#!/bin/sh\nexit 9\n").unwrap();
    challenge(home.path(), "out").assert().success();
    let (again, table) = scored(home.path(), "out");
    assert_eq!(again.comparison, row.comparison);
    assert!(table.contains("| nothing missing | designed trials | 0 of 1"), "{table}");
}

#[test]
fn a_bed_that_fails_is_told_by_rig_finding_and_expectation_and_is_no_score() {
    let home = TempDir::new().unwrap();
    write_rig(home.path(), "000", "#!/bin/sh\nexit 3\n");
    write_truth(home.path(), FRICTION_IS_TRUE);
    let refused = challenge(home.path(), "out").assert().code(1);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    for part in ["second author/000", "exit status: 3", "expected status 0 and a recording"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(!home.path().join("out/row-second author-000.json").exists());
}

#[test]
fn a_rig_that_cannot_be_read_is_told_before_the_first_is_run() {
    let home = TempDir::new().unwrap();
    let first = write_rig(home.path(), "000", &bed());
    let second = write_rig(home.path(), "001", &bed());
    write_truth(home.path(), r#"{"000": {"truth": []}, "001": {"truth": []}}"#);
    std::fs::remove_file(second.join("limits.toml")).unwrap();
    let refused = challenge(home.path(), "out").assert().code(1);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("001/limits.toml") && told.contains("expected"), "{told}");
    assert!(!first.join("calls").exists(), "the first was run");
}
