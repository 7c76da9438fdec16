//! What is written: the same each time, and of use to the other commands.

use std::fs;

use crate::bench::{BENCH, Case, FADES, fit, late, names, palpate};

const OUT: [&str; 3] = ["json", "html", "toml"];

/// Diagnoses both trials into files named `name`.
fn write(case: &Case, name: &str) -> [Vec<u8>; 3] {
    let place = OUT.map(|kind| format!("{name}.{kind}"));
    let [json, report, model] = &place;
    let arguments = ["--rig", "rig.toml", "trial-1.csv", "trial-2.csv", "--json", json, "--report", report, "--model"];
    let said = case.command(&arguments).arg(model).assert().success().get_output().clone();
    let [out, error] = [said.stdout, said.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(out.starts_with("The simulation leaves out") && out.contains("branch_stiffness = "), "{out}");
    assert!(place.iter().all(|file| error.contains(&format!("wrote {file}"))), "{error}");
    place.map(|name| without_date(fs::read(case.path(&name)).unwrap()))
}

/// A page tells when it was made, and nothing else of the clock.
fn without_date(bytes: Vec<u8>) -> Vec<u8> {
    let text = String::from_utf8(bytes).unwrap();
    let Some((head, rest)) = text.split_once("<dt>date</dt><dd>") else { return text.into_bytes() };
    let (date, tail) = rest.split_once("</dd>").unwrap();
    assert!(date.len() == 20 && date.ends_with('Z'), "{date}");
    format!("{head}{tail}").into_bytes()
}

#[test]
fn the_same_input_gives_the_same_bytes_and_the_model_knows_what_was_missing() {
    let case = Case::led(BENCH, FADES);
    let first = write(&case, "first");
    assert!(first == write(&case, "second"), "two runs differ");
    let model = String::from_utf8(first[2].clone()).unwrap();
    for word in ["[[effect]]", "stress_relaxation", "branch_stiffness_n_m", "branch_stiffness_ci95_n_m"] {
        assert!(model.contains(word), "{model} lacks {word}");
    }
    let arguments = ["simulate", "--rig", "rig.toml", "--model", "first.toml", "--out", "run.csv"];
    palpate().current_dir(&case.folder).args(arguments).assert().success();
    // What is known is not missing.
    let again = case.found(&["--rig", "first.toml", "trial-1.csv", "trial-2.csv"]);
    assert!(again["verdict"] == "no_mismatch" || again["verdict"] == "parameters", "{again:#}");
    assert_eq!(again["physics"], serde_json::json!([]));
}

#[test]
fn the_order_of_trials_changes_nothing_and_a_simulation_is_what_is_held_against_them() {
    let case = Case::led(BENCH, FADES);
    let arguments = ["--rig", "rig.toml", "trial-2.csv", "trial-1.csv", "--simulation", "trial-2.csv", "trial-1.csv"];
    let answer = case.found(&arguments);
    names(&answer, "stress_relaxation");
    // The recording itself: no mismatch at all as given.
    assert!(fit(&answer, "as_given") < 1e-9 * fit(&answer, "noise_floor"), "{}", answer["fit"]);
    assert!(fit(&answer, "refitted") > 3.0 * fit(&answer, "noise_floor"));
}

#[test]
fn where_there_are_rivals_an_experiment_is_written() {
    let (answer, trajectory) = late();
    assert!(!answer["rivals"].as_array().unwrap().is_empty());
    let mut rows = csv::Reader::from_reader(trajectory.as_bytes());
    assert_eq!(rows.headers().unwrap(), vec!["t_s", "reference_m"]);
    let rows: Vec<(f64, f64)> = rows.deserialize().map(Result::unwrap).collect();
    assert!(rows.len() > 100 && rows.windows(2).all(|pair| pair[0].0 < pair[1].0));
    // Nowhere that the recordings have not been: -3 - 2 mm to 8 + 2 mm, and a tenth.
    assert!(rows.iter().all(|(_, x)| (-0.006..0.011).contains(x)));
}
