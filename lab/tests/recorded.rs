//! The diagnosis on real recordings: whether it names what their makers know of them, and whether what it learnt foretells
//! trials that it never saw.
//!
//! The recordings are not part of this repository: `PALPATE_RECORDINGS` names the folder that holds them. Without it the
//! tests say so and pass. A few that are stable run with all other tests; every one, with a table, by
//!
//! ```text
//! palpate challenge --cases 0 --recordings all
//! ```

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use palpate_lab::challenge::challenge_score::ChallengeScore;
use palpate_lab::challenge::diagnosis_json::DiagnosisJson;
use palpate_lab::challenge::recordings::grade::{DRY, alternatives, leaves_friction_open, named};
use palpate_lab::challenge::recordings::specimen_score::{RecordingScores, SpecimenScore};
use palpate_lab::diagnose::diagnose;
use palpate_lab::recording::Recording;
use palpate_lab::recordings_folder::{ADVICE, VARIABLE, folder};
use palpate_lab::rig::Rig;
use tempfile::TempDir;

/// Says that there are none.
fn recordings() -> Option<PathBuf> {
    let found = folder();
    if found.is_none() {
        eprintln!("skipped: no recordings; {ADVICE}");
    }
    found
}

/// What `palpate diagnose --rig lab/rigs/RIG.toml FILE` tells of one recording, `None` where there are none.
fn diagnosis_of(rig: &str, file: &str) -> Option<DiagnosisJson> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs").join(rig).with_extension("toml");
    let trial = recordings()?.join(file);
    let rig = Rig::read(&path).unwrap();
    let trial = Recording::read(&trial, &rig).unwrap();
    let found = diagnose(&rig, &path.display().to_string(), &[trial], &[], 1, &|_| ()).unwrap();
    let diagnosis: DiagnosisJson = serde_json::from_value(serde_json::to_value(found.answer).unwrap()).unwrap();
    println!("{file}: {} {:?}, alternatives {:?}", diagnosis.verdict, named(&diagnosis), alternatives(&diagnosis));
    Some(diagnosis)
}

/// Asserts that `effects` are named in the recording.
fn is_named(rig: &str, file: &str, effects: &[&str]) {
    let Some(diagnosis) = diagnosis_of(rig, file) else { return };
    let found = named(&diagnosis);
    for effect in effects {
        assert!(found.contains(effect), "{file}: {effect} is not among {found:?}");
    }
}

#[test]
fn a_pendulum_that_swings_up_carries_a_weight() {
    is_named("dfki_pendulum", "dfki_pendulum/ddp.csv", &["gravity_load"]);
}

/// A gear between motor and arm lets the motor swing by some milliradians at 30 Hz, faster than any torque moves the whole; and hands push the
/// arm. Its slower motion is that of a weight, and the rest is owned.
#[test]
fn a_pendulum_behind_a_gear_that_rattles_carries_a_weight() {
    for file in ["energy_shaping.csv", "energy_shaping_1kg.csv"] {
        let Some(diagnosis) = diagnosis_of("dfki_pendulum", &format!("dfki_pendulum/{file}")) else { return };
        assert!(named(&diagnosis).iter().all(|name| ["gravity_load", "unknown"].contains(name)), "{file}");
    }
}

/// One trial with its release: two slopes leave 1.8 mN of held-out rows, a power law 2.5 mN, so either law of a spring that
/// stiffens may be the answer; the several trials of the challenge are asked for the power law.
#[test]
fn a_soft_sample_relaxes_and_stiffens() {
    let Some(diagnosis) = diagnosis_of("tissue_s230515", "tissue_indentation/s230515_P002_1.csv") else { return };
    let found = named(&diagnosis);
    let stiffens = ["nonlinear_stiffness", "layered_stiffness"].iter().any(|law| found.contains(law));
    assert!(found.contains(&"stress_relaxation") && stiffens && found.len() == 2, "{found:?}");
}

/// Names in a recording, sorted, without `unknown`.
fn names_in(diagnosis: &DiagnosisJson) -> Vec<&str> {
    let mut found = named(diagnosis);
    found.retain(|name| *name != "unknown");
    found.sort_unstable();
    found
}

/// Pressed and held, never let go: neither a slow sensor nor its zero shows, and what else bends the curve halves nothing. Some hundred rows
/// are few blocks for Vuong's statistic: a spring alone leaves six times as much and is not the simpler answer.
#[test]
fn soft_samples_that_are_never_let_go_relax_and_stiffen_and_nothing_else() {
    for file in ["s230515_P002_laser_2.csv", "s230515_P011_laser_1.csv"] {
        let file = format!("tissue_indentation/{file}");
        let Some(diagnosis) = diagnosis_of("tissue_s230515", &file) else { return };
        assert_eq!(names_in(&diagnosis), ["nonlinear_stiffness", "stress_relaxation"]);
        // The other one begins above the surface that is found.
        let is_told = diagnosis.findings.iter().any(|finding| finding.code == "relaxation_or_force_lag");
        assert!(is_told || file.contains("P011"), "that a slow sensor would show the same");
    }
}

/// A boundary near the deepest point bends the curve as a spring does that stiffens exponentially; the meat has no layers.
#[test]
fn meat_stiffens_and_has_no_layers() {
    let Some(diagnosis) = diagnosis_of("tissue_meat", "tissue_indentation/meat_230327_RDG2_1A.csv") else { return };
    assert_eq!(names_in(&diagnosis), ["nonlinear_stiffness", "stress_relaxation"]);
}

#[test]
fn a_diamond_leaves_a_dent() {
    is_named("nanoindenter", "nanoindentation/fused_silica_cycles_test1.csv", &["plastic_set"]);
}

#[test]
fn a_gel_holds_on_to_the_tip() {
    is_named("afm_creep_gel", "afm_soft_contact/creep_polymergel.csv", &["adhesion"]);
}

/// At two constant speeds a damper makes the same loop as dry friction.
#[test]
fn a_piston_at_one_speed_each_way_does_not_decide_what_kind_of_friction_it_has() {
    let Some(diagnosis) = diagnosis_of("pneumatic_seal", "pneumatic_seal_friction/O_ring_1bar.csv") else { return };
    let claimed: Vec<_> = named(&diagnosis).into_iter().filter(|name| DRY.contains(name)).collect();
    assert!(claimed.is_empty() || leaves_friction_open(&diagnosis), "{claimed:?} is claimed as if it were decided");
}

fn challenge(home: &Path, recordings: &str, root: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    if let Some(root) = root {
        command.env(VARIABLE, root);
    }
    let arguments = ["challenge", "--cases", "0", "--out", "kept", "--json", "score.json", "--report", "page.html"];
    command.current_dir(home).args(arguments).args(["--recordings", recordings]).output().unwrap()
}

/// The rows of a trial in `folder`.
fn rows(folder: &Path, file: &str) -> usize {
    fs::read_to_string(folder.join(file)).unwrap().lines().count() - 1
}

#[test]
fn three_specimens_are_sealed_diagnosed_opened_and_scored_on_trials_that_were_kept_back() {
    let Some(root) = recordings() else { return };
    let home = TempDir::new().unwrap();
    let names = "tissue_indentation/soft_P002_laser,nanoindentation/tungsten_cycles,keyswitch_press/Cherry-MX-Red";
    let output = challenge(home.path(), names, None);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    println!("{said}");
    let text = fs::read_to_string(home.path().join("score.json")).unwrap();
    let score: ChallengeScore = serde_json::from_str(&text).unwrap();
    let recorded: RecordingScores = score.recorded.unwrap();

    // Every answer and every trial kept back is sealed before any diagnosis, and the folder shows neither.
    let kept = home.path().join("kept");
    let sealed = fs::read_to_string(kept.join("answers.jsonl")).unwrap();
    assert_eq!(sealed.lines().count(), 3);
    assert!(said.find(&score.sealed_sha256).unwrap() < said.find("recorded-").unwrap(), "{said}");
    let switch = kept.join("recorded-00");
    let mut files: Vec<_> =
        fs::read_dir(&switch).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    files.sort();
    assert_eq!(files, ["diagnosis.json", "improved.toml", "rig.toml", "trial-1.csv"]);
    let [switch, diamond, soft] = recorded.rows.as_slice() else { panic!("{:?}", recorded.rows) };
    assert!(switch.no_split_reason.is_some() && switch.held_out.is_none() && switch.scored.is_empty());
    for (row, folder) in [(diamond, "recorded-01"), (soft, "recorded-02")] {
        let [[training], [scored]] = [&row.training, &row.scored].map(Vec::as_slice) else { panic!("{row:?}") };
        let source = root.join(row.recording.split('/').next().unwrap());
        assert_ne!(training, scored);
        assert_eq!(rows(&kept.join(folder), "trial-1.csv"), rows(&source, training), "{}", row.recording);
    }

    // The score is that of its rows, and the page and the terminal show them.
    let page = fs::read_to_string(home.path().join("page.html")).unwrap();
    let of = |is: fn(&SpecimenScore) -> bool| recorded.rows.iter().filter(|row| is(row)).count();
    assert_eq!((recorded.n, recorded.held_back), (3, of(|row| row.left().is_some())));
    assert_eq!(recorded.rest_owned, of(SpecimenScore::owns_rest));
    assert_eq!(recorded.named + recorded.owned + recorded.undecidable + recorded.wrong + recorded.missed, recorded.n);
    assert!(recorded.rows.iter().all(|row| page.contains(&row.recording) && said.contains(&row.words())), "{said}");

    // What was fitted to one trial predicts another: a dent that stays leaves less than half of what a spring does, and so do
    // relaxation and a power law. Nothing was fitted, so neither had to.
    assert!(diamond.named.contains(&"plastic_set".to_owned()) && diamond.left().unwrap() < 0.5, "{said}");
    assert!(soft.named.contains(&"stress_relaxation".to_owned()) && soft.left().unwrap() < 0.5, "{said}");
}

#[test]
fn absent_recordings_and_unknown_names_are_said() {
    let home = TempDir::new().unwrap();
    let nowhere = challenge(home.path(), "all", Some(&home.path().join("nowhere")));
    assert_eq!(nowhere.status.code(), Some(1));
    assert!(String::from_utf8(nowhere.stderr).unwrap().contains(VARIABLE));
    if let Some(root) = recordings() {
        // In a folder of its own: the first run left its settings in this one.
        let home = TempDir::new().unwrap();
        let unknown = challenge(home.path(), "tissue_indentation/soft,tofu", Some(&root));
        assert_eq!(unknown.status.code(), Some(2));
        assert!(String::from_utf8(unknown.stderr).unwrap().contains("tofu"));
    }
}
