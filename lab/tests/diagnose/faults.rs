//! What cannot be diagnosed is refused with place, finding and expectation, and never by a panic.

use predicates::prelude::*;
use predicates::str::contains;

use crate::bench::{BENCH, Case, FADES, Size, rewritten};

/// A second of it: nothing here gets as far as to look at it.
fn short() -> Case {
    Case::led(Size { duration_s: 1.5, ..BENCH }, FADES)
}

/// Expects exit status `code`, all of `words`, no panic and no output file.
fn refuses(case: &Case, arguments: &[&str], code: i32, words: &[&str]) {
    let mut command = case.command(arguments);
    command.args(["--json", "out.json", "--report", "out.html", "--model", "out.toml"]);
    let assert = words.iter().fold(command.assert().code(code).stdout(""), |a, word| a.stderr(contains(*word)));
    assert.stderr(contains("panicked").not());
    let left = std::fs::read_dir(&case.folder).unwrap().map(|entry| entry.unwrap().file_name());
    let left: Vec<_> = left.filter(|name| name.to_string_lossy().contains("out")).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn files_that_are_absent_empty_or_without_a_channel() {
    let case = short();
    case.write("void.csv", "");
    case.write("header.csv", "t_s,position_m,force_N\n");
    case.write("blind.csv", "t_s,position_m\n0,0\n1,0\n");
    case.write("effort.csv", "t_s,position_m,effort_N\n0,0,1\n1,0,1\n");
    let five: String = (0..5).map(|row| format!("{row},0.00{row},0.{row}\n")).collect();
    case.write("five.csv", &("t_s,position_m,force_N\n".to_owned() + &five));
    for (file, words) in [
        ("absent.csv", ["absent.csv", "no such file"]),
        ("void.csv", ["void.csv", "an empty file"]),
        ("header.csv", ["header.csv", "no rows"]),
        ("blind.csv", ["blind.csv:1", "force_N"]),
        ("effort.csv", ["expected", ""]),
        ("five.csv", ["5 rows", "at least 32"]),
    ] {
        refuses(&case, &["--rig", "rig.toml", file], 1, &words);
        refuses(&case, &["--rig", "rig.toml", "trial-1.csv", file], 1, &words);
    }
    refuses(&case, &["--rig", "absent.toml", "trial-1.csv"], 1, &["absent.toml", "no such file"]);
    refuses(&case, &["--rig", "rig.toml"], 2, &["TRIAL.csv"]);
}

#[test]
fn simulations_that_do_not_go_with_the_trials() {
    let case = short();
    let trials = ["--rig", "rig.toml", "trial-1.csv", "trial-2.csv", "--simulation", "trial-1.csv"];
    refuses(&case, &trials, 2, &["--simulation", "1 files", "2 in all"]);
    case.write("half.csv", &rewritten(&case.path("trial-1.csv"), |row, _| row < 200));
    refuses(&case, &["--rig", "rig.toml", "trial-1.csv", "--simulation", "half.csv"], 1, &["half.csv", "as long as"]);
}

#[test]
fn a_place_that_cannot_be_written_or_is_an_input_is_told_before_the_work() {
    let case = short();
    let before = std::fs::read(case.path("trial-1.csv")).unwrap();
    let go = |place: &str| {
        let mut command = case.command(&["--rig", "rig.toml", "trial-1.csv", "--json", place, "--model", "m.toml"]);
        command.assert().code(1).stdout("").stderr(contains(place))
    };
    go("absent/out.json").stderr(contains("cannot be written"));
    go("trial-1.csv").stderr(contains("an input of this very run"));
    assert_eq!(std::fs::read(case.path("trial-1.csv")).unwrap(), before);
    assert!(!case.path("m.toml").exists());
}

#[test]
fn a_channel_that_was_never_connected_is_told_of() {
    let case = short();
    for (file, column, value, word) in
        [("still.csv", 1, 0.001, "The position column is"), ("dead.csv", 2, 0.0, "The force column is")]
    {
        let constant = rewritten(&case.path("trial-1.csv"), |_, row| {
            row[column] = value;
            true
        });
        case.write(file, &constant);
        let assert = case.command(&["--rig", "rig.toml", file]).assert().success();
        assert.stderr(contains("warning").and(contains(word)).and(contains("panicked").not()));
    }
}
