//! The diagnosis on real recordings: whether it names what their makers know of them.
//!
//! The recordings are not part of this repository: `PALPATE_RECORDINGS` names the folder that holds them. Without it the
//! tests say so and pass. A few that are stable run with all other tests; every one, with a table, by
//!
//! ```text
//! cargo test --release -p palpate-lab --test recorded -- --ignored --nocapture
//! ```

use std::path::PathBuf;

use palpate_lab::diagnose::answer::Answer;
use palpate_lab::recordings::{ADVICE, folder};

#[path = "recorded/judged.rs"]
mod judged;
#[path = "recorded/sets.rs"]
mod sets;

use judged::{DRY, diagnosed, leaves_friction_open, line, named, rivals};
use sets::{SETS, Set};

/// Says that there are none.
fn recordings() -> Option<PathBuf> {
    let found = folder();
    if found.is_none() {
        eprintln!("skipped: no recordings; {ADVICE}");
    }
    found
}

/// The answer on one recording, `None` where there are none.
fn answer(rig: &str, file: &str) -> Option<Answer> {
    let answer = diagnosed(rig, &recordings()?.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    println!("{file}: {:?} {:?}, rivals {:?}", answer.verdict, named(&answer), rivals(&answer));
    Some(answer)
}

/// Asserts that `effects` are named in the recording.
fn is_named(rig: &str, file: &str, effects: &[&str]) {
    let Some(answer) = answer(rig, file) else { return };
    let found = named(&answer);
    for effect in effects {
        assert!(found.contains(effect), "{file}: {effect} is not among {found:?}");
    }
}

#[test]
fn a_pendulum_that_swings_up_carries_a_weight() {
    is_named("dfki_pendulum", "dfki_pendulum/ddp.csv", &["gravity_load"]);
}

#[test]
fn a_soft_sample_relaxes_and_stiffens() {
    let effects = ["stress_relaxation", "nonlinear_stiffness"];
    is_named("tissue_s230515", "tissue_indentation/s230515_P002_1.csv", &effects);
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
    let Some(answer) = answer("pneumatic_seal", "pneumatic_seal_friction/O_ring_1bar.csv") else { return };
    let claimed: Vec<_> = named(&answer).into_iter().filter(|name| DRY.contains(name)).collect();
    assert!(claimed.is_empty() || leaves_friction_open(&answer), "{claimed:?} is claimed as if it were decided");
}

#[test]
#[ignore = "many minutes"]
fn every_recording() {
    let Some(root) = recordings() else { return };
    println!(
        "| recording | verdict | named | rivals | held-out RMS refitted -> improved (floor) | known | judgement |"
    );
    println!("|---|---|---|---|---|---|---|");
    let mut seen = 0;
    for set in &SETS {
        for file in files(&root, set) {
            let name = format!("{}/{}", set.folder, file.file_stem().unwrap_or_default().to_string_lossy());
            println!("{}", line(set, &name, &diagnosed(set.rig, &file)));
            seen += 1;
        }
    }
    assert!(seen > 0, "no recording in {}", root.display());
}

/// The recordings of `set`, by name.
fn files(root: &std::path::Path, set: &Set) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(root.join(set.folder)) else { return Vec::new() };
    let belongs = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.ends_with(".csv") && set.files.iter().any(|start| name.starts_with(start))
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(belongs).collect();
    files.sort();
    files
}
