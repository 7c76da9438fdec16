//! `palpate sweep-thresholds` as a user runs it.

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;

fn palpate() -> Command {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
}

#[test]
fn the_list_has_every_threshold_with_value_unit_origin_and_meaning() {
    let list = palpate().args(["sweep-thresholds", "--list"]).assert().success();
    list.stdout(contains("contact.LEAST_GAIN = 10 (nats; derived)").and(contains("drive.LINK_PART = 0.3 (1; chosen)")));
}

#[test]
fn a_sweep_of_one_threshold_answers_thrice_and_a_second_run_asks_nothing() {
    // The one case of this seed has no effort, so that only the contact is identified.
    let folder = tempfile::tempdir().unwrap();
    let sweep = || {
        let mut command = palpate();
        let out = folder.path().to_str().unwrap();
        command.args([
            "sweep-thresholds",
            "--cases",
            "1",
            "--seed",
            "16",
            "--only",
            "contact.LEAST_VUONG",
            "--out",
            out,
        ]);
        command
    };
    let row = contains("| `contact.LEAST_VUONG` | 1.6 deviations | cited | 1 |");
    sweep().assert().success().stdout(row.clone());
    let answers = std::fs::read_to_string(folder.path().join("answers.jsonl")).unwrap();
    assert_eq!(answers.lines().count(), 3, "{answers}");
    sweep().assert().success().stdout(row);
    assert_eq!(std::fs::read_to_string(folder.path().join("answers.jsonl")).unwrap(), answers);
}

#[test]
fn a_varied_diagnosis_answers_by_the_varied_threshold() {
    // The relaxing bench of the README takes nearly all of its mismatch: a share ten times as large takes more than there is.
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let bench = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs/bench.toml");
    relaxing_trial(&bench, &at("trial.csv"));
    let diagnose = |varied: &[&str]| {
        let mut command = palpate();
        command.arg("diagnose").arg("--rig").arg(&bench).arg(at("trial.csv")).args(varied);
        command.assert()
    };
    diagnose(&[]).success().stdout(contains("stress_relaxation"));
    diagnose(&["--vary", "contact.LEAST_SHARE=10"]).success().stdout(contains("stress_relaxation").not());
    diagnose(&["--vary", "contact.LEAST"])
        .code(2)
        .stderr(contains("--vary: found contact.LEAST, expected NAME=FACTOR"));
}

#[test]
fn within_its_margins_a_threshold_changes_nothing_of_the_answer() {
    // The same bench. One threshold is moved at a time, to just within what the first diagnosis says of it.
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let bench = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs/bench.toml");
    relaxing_trial(&bench, &at("trial.csv"));
    let answer = |more: &[&str]| {
        let mut command = palpate();
        command.arg("diagnose").arg("--rig").arg(&bench).arg(at("trial.csv")).args(["--json", "-"]).args(more);
        let out = command.output().unwrap();
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        let mut answer: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
        // What says when and by which command it was made.
        answer.as_object_mut().unwrap().remove("run");
        answer
    };
    let margins = at("margins.json");
    let plain = answer(&["--margins", margins.to_str().unwrap()]);
    let margins: std::collections::BTreeMap<String, serde_json::Value> =
        serde_json::from_str(&std::fs::read_to_string(margins).unwrap()).unwrap();
    // Every number that decides here, compared with from both sides.
    let known = |name: &str| (margins[name]["below"].as_f64().unwrap(), margins[name]["above"].as_f64());
    let mut moved = 0;
    for name in ["contact.LEAST_SHARE", "contact.LEAST_VUONG", "contact.LEAST_GAIN", "contact.LEAST_HELD_OUT_SHARE"] {
        let (below, above) = known(name);
        for factor in [(below > 0.0 && below < 1.0).then_some(below * 1.001), above.map(|above| above * 0.999)] {
            let Some(factor) = factor else { continue };
            assert_eq!(answer(&["--vary", &format!("{name}={factor}")]), plain, "{name} {factor}");
            moved += 1;
        }
    }
    assert!(moved >= 4, "{moved}");
}

/// A recording of eight seconds of the README's relaxing bench at `place`.
fn relaxing_trial(bench: &std::path::Path, place: &std::path::Path) {
    let effect = "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 60.0\nrelaxation_time_s = 0.4\n";
    let short = std::fs::read_to_string(bench)
        .unwrap()
        .replace("duration_s = 60.0", "duration_s = 8.0")
        .replace("period_s = 30.0", "period_s = 4.0")
        .replace("contact_s = 15.0", "contact_s = 1.5");
    let real = place.with_extension("toml");
    std::fs::write(&real, short + effect).unwrap();
    palpate().arg("simulate").arg("--rig").arg(real).arg("--out").arg(place).assert().success();
}
