//! A simulated bed: what it leaves of a trial that cannot be run to its end.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use palpate_lab::experiment_design::Limits;
use palpate_lab::investigate::monitor::{Quantity, hold_against};
use palpate_lab::investigate::simulated_bed::SimulatedBed;
use palpate_lab::investigate::test_bed::{Ending, TestBed as _, TrialOutcome, TrialRequest};

use super::design::{LIMITS, bench};

/// A press from 5 mm before the surface to `depth` within a second, held for a second.
fn press(depth: f64) -> Vec<f64> {
    (0..2000).map(|row| -0.005 + (depth + 0.005) * (f64::from(row) * 1e-3).min(1.0)).collect()
}

fn run(effects: &str, reference: &[f64], limits: &Limits, interrupted: bool) -> TrialOutcome {
    let folder = tempfile::tempdir().unwrap();
    let hidden = folder.path().join("hidden.toml");
    bench(effects).write(&hidden).unwrap();
    let mut bed = SimulatedBed::new(&hidden, &bench(""), 1).unwrap();
    let request = TrialRequest {
        reference,
        rate_hz: 1000.0,
        limits,
        reference_file: Path::new("reference.csv"),
        recording_file: Path::new("recording.csv"),
        interrupted: &AtomicBool::new(interrupted),
        round: 1,
    };
    bed.run(&request).unwrap()
}

#[test]
fn a_trial_within_the_limits_is_run_to_its_end() {
    let outcome = run("", &press(0.008), &LIMITS, false);
    assert_eq!(outcome.ending, Ending::Completed);
    assert_eq!(outcome.recording.unwrap().time.len(), 2000);
}

#[test]
fn a_contact_that_is_stiffer_than_anybody_knew_is_left_before_the_limit_is_reached() {
    let stiff = "[[effect]]\nname = \"layered_stiffness\"\nlayer_depth_m = 0.003\nadded_stiffness_n_m = 3000.0\n";
    let limits = Limits { force: Some(4.0), ..LIMITS };
    let outcome = run(stiff, &press(0.015), &limits, false);
    let Ending::Stopped(violation) = outcome.ending else { panic!("{:?}", outcome.ending) };
    assert_eq!(violation.quantity, Quantity::Force);
    let recording = outcome.recording.unwrap();
    assert!(recording.time.len() < 2000 && recording.time.len() > 200);
    assert_eq!(hold_against(&recording, &limits).0, None);
}

#[test]
fn the_drive_limits_its_effort() {
    let limits = Limits { effort: Some(2.0), force: Some(40.0), ..LIMITS };
    let recording = run("", &press(0.019), &limits, false).recording.unwrap();
    let most = recording.effort.unwrap().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    assert!((most - 2.0).abs() < 1e-9, "{most}");
}

#[test]
fn whoever_interrupts_gets_what_was_recorded() {
    let outcome = run("", &press(0.008), &LIMITS, true);
    assert_eq!(outcome.ending, Ending::Interrupted);
    assert!(outcome.recording.is_some());
}
