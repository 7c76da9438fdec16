//! `palpate diagnose-joints` as a user runs it: two joints of one recording.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;

/// A joint's rig: its own columns of the common recording.
fn rig(joint: &str) -> String {
    format!(
        "[rig]\nname = \"{joint}\"\ncoordinate = \"rotary\"\n[columns]\nposition = \"q_{joint}\"\neffort = \"tau_{joint}\"\nload = \
         \"load_{joint}\"\n[drive]\ninertia_kg_m2 = 0.5\nviscous_n_m_s_rad = 2.0\n"
    )
}

/// Both joints are driven alike. The shoulder's known load is all that there is; the elbow's drive rubs with 1.5 N m besides, which is
/// written down as effort: the motion is prescribed, and the effort is what it takes.
fn trial(seed: u64) -> String {
    let mut text =
        "t_s,q_shoulder,tau_shoulder,load_shoulder,q_elbow,tau_elbow,load_elbow,rest_elbow,tau_carried,load_carried\n"
            .to_owned();
    let (mut state, phase) = (seed, seed as f64);
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let tones = [(0.4, 0.5), (1.3, 0.1), (3.1, 0.02)];
    let sum = |part: &dyn Fn(f64, f64, f64) -> f64| -> f64 {
        tones.iter().map(|(f, a)| part(std::f64::consts::TAU * f, *a, phase * f)).sum()
    };
    for row in 0..4000 {
        let t = row as f64 * 0.002;
        let q = sum(&|w, a, p| a * (w * t + p).sin());
        // The effort is held from row to row: that of the middle.
        let m = t + 0.001;
        let v = sum(&|w, a, p| a * w * (w * m + p).cos());
        let acceleration = sum(&|w, a, p| -a * w * w * (w * m + p).sin());
        let drive = 0.5 * acceleration + 2.0 * v;
        let load_at = |t: f64| 5.0 * sum(&|w, a, p| a * (w * t + p).sin()).cos();
        let load = load_at(m);
        let rubs = 1.5 * v.signum();
        let [one, two] = [q + 1e-5 * noise(), q + 1e-5 * noise()];
        // A load is that of its row.
        let given = load_at(t);
        // What another axis asks of the shoulder; it follows the clock, so that no law of this joint can stand for it.
        let carried = |t: f64| 2.0 * (3.0 * t + phase).sin();
        text += &format!(
            "{t},{one},{},{given},{two},{},{given},{},{},{}\n",
            drive + load,
            drive + load + rubs,
            drive + rubs,
            drive + carried(m),
            carried(t)
        );
    }
    text
}

struct Arm {
    folder: TempDir,
}

impl Arm {
    fn new() -> Self {
        let folder = TempDir::new().expect("a folder");
        for joint in ["shoulder", "elbow"] {
            fs::write(folder.path().join(format!("{joint}.toml")), rig(joint)).expect("a file");
        }
        for seed in [1, 2] {
            fs::write(folder.path().join(format!("{seed}.csv")), trial(seed)).expect("a file");
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
        command.current_dir(self.folder.path()).args(words);
        command
    }
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

#[test]
fn each_joint_has_its_own_diagnosis_in_one_report() {
    let arm = Arm::new();
    let joints = ["--joint", "shoulder=shoulder.toml", "--joint", "elbow=elbow.toml"];
    let outputs = ["--json", "arm.json", "--report", "arm.html", "--models", "models"];
    let words: Vec<&str> = [&["diagnose-joints"], &joints[..], &["1.csv", "2.csv"], &outputs[..]].concat();
    arm.command(&words).assert().success().stdout(contains("joint shoulder: ").and(contains("joint elbow: ")));
    let told = json(&arm.path("arm.json"));
    assert_eq!(told["schema"], "palpate.joints/1");
    for (at, joint) in ["shoulder", "elbow"].into_iter().enumerate() {
        // By the command for one joint, which knows nothing of the other.
        let alone = format!("{joint}-alone.json");
        let rig = format!("{joint}.toml");
        arm.command(&["diagnose", "--rig", &rig, "1.csv", "2.csv", "--json", &alone]).assert().success();
        assert_eq!(told["joints"][at]["joint"], joint);
        assert_eq!(told["joints"][at]["diagnosis"], json(&arm.path(&alone)));
    }
    assert_eq!(told["joints"][0]["diagnosis"]["physics"], Value::Array(Vec::new()));
    let physics = &told["joints"][1]["diagnosis"]["physics"];
    assert_eq!((&physics[0]["name"], &physics[1]), (&Value::from("coulomb_friction"), &Value::Null));
    let level = physics[0]["parameters"][0]["value"].as_f64().expect("a level");
    // The sign turns within a row in the effort and not in the model: a hundredth.
    assert!((level - 1.5).abs() < 0.03, "{level}");
    let models = fs::read_to_string(arm.path("models/elbow.toml")).expect("a model");
    assert!(models.contains("coulomb_friction"), "{models}");
    let page = fs::read_to_string(arm.path("arm.html")).expect("a page");
    assert!(page.contains("1 of 2 joints lack physics") && page.matches("<iframe").count() == 2, "no frames");
}

#[test]
fn a_load_beside_the_effort_is_the_load_taken_from_it_beforehand() {
    let arm = Arm::new();
    let taken = rig("elbow").replace("tau_elbow", "rest_elbow").replace("load = \"load_elbow\"\n", "");
    fs::write(arm.path("taken.toml"), taken).expect("a file");
    let answer = |rig: &str| {
        arm.command(&["diagnose", "--rig", rig, "1.csv", "2.csv", "--json", "answer.json"]).assert().success();
        json(&arm.path("answer.json"))["physics"].clone()
    };
    let (beside, beforehand) = (answer("elbow.toml"), answer("taken.toml"));
    assert_eq!(beside[0]["name"], beforehand[0]["name"]);
    let level = |physics: &Value| physics[0]["parameters"][0]["value"].as_f64().expect("a level");
    // The load's factor is one value more, which takes a part of the other: a tenth of the level's half-width, which is
    // 1.9e-3 N m.
    assert!((level(&beside) - level(&beforehand)).abs() < 1.9e-4, "{beside} and {beforehand}");
}

#[test]
fn a_load_that_is_wrong_by_more_than_a_model_is_ends_at_its_end_and_says_so() {
    let arm = Arm::new();
    let finding = |rig: &str| {
        arm.command(&["diagnose", "--rig", rig, "1.csv", "2.csv", "--json", "answer.json"]).assert().success();
        let answer = json(&arm.path("answer.json"));
        let findings = answer["findings"].as_array().expect("findings").clone();
        findings.into_iter().find(|finding| finding["code"] == "load_scale_at_end")
    };
    assert_eq!(finding("shoulder.toml"), None);
    // What is carried weighs 1.6 times what the rig file says: 15 % more is tried.
    let carries = rig("shoulder").replace("tau_shoulder", "tau_carried").replace("load_shoulder", "load_carried");
    fs::write(arm.path("carries.toml"), carries.replace("[drive]", "[drive]\nload_scale = 0.625")).expect("a file");
    let found = finding("carries.toml").expect("the finding");
    assert!(found["text"].as_str().expect("a text").contains("times 1.15"), "{found}");
}

#[test]
fn what_is_wrong_with_a_joint_is_said() {
    let arm = Arm::new();
    let fails = |words: &[&str], code: i32, says: &[&str]| {
        let assert = arm.command(&[&["diagnose-joints"], words].concat()).assert().code(code).stdout("");
        says.iter().fold(assert, |assert, word| assert.stderr(contains(*word)));
    };
    fails(&["--joint", "elbow", "1.csv"], 2, &["elbow=elbow.toml"]);
    fails(&["--joint", "a=elbow.toml", "--joint", "a=shoulder.toml", "1.csv"], 2, &["--joint", "a twice"]);
    fails(&["--joint", "a/b=elbow.toml", "1.csv", "--models", "m"], 2, &["a/b", "slashes"]);
    fails(&["--joint", "a=none.toml", "1.csv"], 1, &["none.toml", "no such file"]);
    fs::write(arm.path("wrist.toml"), rig("wrist")).expect("a file");
    fails(&["--joint", "wrist=wrist.toml", "1.csv"], 1, &["1.csv", "q_wrist"]);
    fails(
        &["--joint", "a=elbow.toml", "1.csv", "2.csv", "--simulation", "1.csv"],
        2,
        &["--simulation", "1 files", "2 in all"],
    );
    fails(&["--joint", "a=elbow.toml", "1.csv", "--json", "1.csv"], 1, &["1.csv", "an input of this very run"]);
}
