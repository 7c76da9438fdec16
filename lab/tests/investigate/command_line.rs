//! The command from end to end.

use std::path::Path;

use assert_cmd::Command;
use palpate_lab::investigate::record::{Investigation, Outcome};
use palpate_lab::investigate::test_bed::Ending;
use tempfile::TempDir;

use super::design::bench;

const FRICTION: &str = "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.6\n";
const LIMITS: &str = "[limits]\nposition_min_m = -0.02\nposition_max_m = 0.02\nspeed_m_s = 0.4\neffort_n = 25.0\nforce_n = 8.0\nduration_s = 10.0\n";

fn palpate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("palpate").unwrap();
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

/// A folder with a rig, the same with friction, and a recording of the latter.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    bench("").write(&folder.path().join("rig.toml")).unwrap();
    bench(FRICTION).write(&folder.path().join("hidden.toml")).unwrap();
    std::fs::write(folder.path().join("limits.toml"), LIMITS).unwrap();
    palpate(folder.path()).args(["simulate", "--rig", "hidden.toml", "--out", "trial.csv"]).assert().success();
    folder
}

fn investigate(folder: &Path, on: &str, rounds: &str) -> Command {
    let mut command = palpate(folder);
    command.args(["investigate", "--rig", "rig.toml", "trial.csv", "--on", on, "--limits", "limits.toml"]);
    command.args(["--rounds", rounds, "--out", "out"]);
    command
}

fn record(folder: &Path) -> Investigation {
    serde_json::from_str(&std::fs::read_to_string(folder.join("out/investigation.json")).unwrap()).unwrap()
}

#[test]
fn a_simulated_rig_is_investigated_resumed_and_not_mistaken_for_another() {
    let folder = folder();
    investigate(folder.path(), "sim:hidden.toml", "1").assert().success();
    let first = record(folder.path());
    assert_eq!(first.rounds.len(), 2);
    assert_eq!(first.last_state().unwrap().physics, ["coulomb_friction"]);
    assert!(first.rounds[1].trial.as_ref().unwrap().used_limits.iter().all(|share| *share < 1.0));
    for file in
        ["improved.toml", "report.html", "round-1/reference.csv", "round-1/recording.csv", "round-1/diagnosis.json"]
    {
        assert!(std::fs::metadata(folder.path().join("out").join(file)).unwrap().len() > 100, "{file}");
    }
    let recorded = std::fs::read(folder.path().join("out/round-1/recording.csv")).unwrap();
    investigate(folder.path(), "sim:hidden.toml", "2").assert().success();
    let second = record(folder.path());
    assert_eq!(second.rounds[1].trial, first.rounds[1].trial);
    assert!(second.outcome.is_some());
    assert_eq!(std::fs::read(folder.path().join("out/round-1/recording.csv")).unwrap(), recorded);
    let other = investigate(folder.path(), "sim:rig.toml", "2").assert().code(1);
    assert!(String::from_utf8_lossy(&other.get_output().stderr).contains("investigation of other inputs"));
}

/// The first trial confirms that nothing is missing. Of the list it could not show all that short recordings hide, and a second looks for the rest; the answer stays.
#[test]
fn where_nothing_is_missing_a_second_trial_looks_for_what_the_first_could_not_show() {
    let folder = folder();
    palpate(folder.path()).args(["simulate", "--rig", "rig.toml", "--out", "trial.csv"]).assert().success();
    investigate(folder.path(), "sim:rig.toml", "3").assert().success();
    let found = record(folder.path());
    let named = found.rounds.iter().map(|round| round.state.as_ref().unwrap().physics.len()).sum::<usize>();
    assert_eq!((found.outcome, named), (Some(Outcome::Decided), 0));
    assert!(found.rounds.len() > 2, "{}", found.rounds.len());
    let why = &found.rounds[2].trial.as_ref().unwrap().why;
    assert!(why.contains("listed effects could still be hidden"), "{why}");
}

#[test]
fn a_command_that_gives_no_recording_ends_it_after_two_rounds_and_what_is_known_stays() {
    let folder = folder();
    investigate(folder.path(), "false", "5").assert().success();
    let found = record(folder.path());
    assert_eq!((found.outcome, found.rounds.len()), (Some(Outcome::BedFailed), 3));
    assert!(matches!(found.rounds[1].trial.as_ref().unwrap().ending, Ending::Failed(_)));
    assert_eq!(found.last_state().unwrap().physics, ["coulomb_friction"]);
}

#[cfg(unix)]
#[test]
fn half_a_recording_of_a_command_is_taken_and_told() {
    let folder = folder();
    // A bed that gives what was given, cut after four of its eight seconds.
    std::fs::write(folder.path().join("bed.sh"), "head -n 4001 trial.csv > \"$2\"\n").unwrap();
    investigate(folder.path(), "sh bed.sh", "1").assert().success();
    let found = record(folder.path());
    let trial = found.rounds[1].trial.as_ref().unwrap();
    assert!(trial.is_used && trial.faults.iter().any(|fault| fault.contains("only the first")), "{trial:?}");
}

#[test]
fn limits_that_cannot_be_are_refused_by_file_and_key() {
    let folder = folder();
    std::fs::write(folder.path().join("limits.toml"), LIMITS.replace("0.4", "-0.4")).unwrap();
    let refused = investigate(folder.path(), "sim:hidden.toml", "1").assert().code(1);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("limits.toml") && told.contains("speed"), "{told}");
}
