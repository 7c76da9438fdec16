//! Trials through the drive image in QEMU, with a simulated rig in its loop. They are left out where the tools are absent.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use palpate_lab::experiment_design::Limits;
use palpate_lab::investigate::drive_bed::DriveBed;
use palpate_lab::investigate::emulated_drive_bed::{EmulatedDriveBed, LinkFault};
use palpate_lab::investigate::monitor::{Quantity, hold_against};
use palpate_lab::investigate::record::{Investigation, Setup};
use palpate_lab::investigate::session::Session;
use palpate_lab::investigate::test_bed::{Ending, TestBed as _, TrialOutcome, TrialRequest};
use palpate_lab::qemu_drive::{ClockMode, DriveImage};
use palpate_lab::simulate::simulate;
use palpate_lab::tools::{Leave, MissingTools};

use super::design::{LIMITS, bench};

/// One emulator at a time: two would be late for each other.
static ONE: Mutex<()> = Mutex::new(());

fn image() -> Option<DriveImage> {
    match DriveImage::prepare(Leave::Look) {
        Ok(image) => Some(image),
        Err(error) if error.is::<MissingTools>() && std::env::var_os("PALPATE_DEVICE").is_none() => {
            eprintln!("left out: {error}");
            None
        }
        Err(error) => panic!("{error:#}"),
    }
}

/// The bench with `effects` as a bed.
fn bed(effects: &str, faults: Vec<LinkFault>) -> Option<EmulatedDriveBed> {
    let folder = tempfile::tempdir().unwrap();
    let hidden = folder.path().join("hidden.toml");
    bench(effects).write(&hidden).unwrap();
    Some(EmulatedDriveBed::new(&hidden, &bench(""), 1, image()?, faults).unwrap())
}

/// A press from 5 mm before the surface to `depth` within half a second, held for a quarter.
fn press(depth: f64) -> Vec<f64> {
    (0..750).map(|row| -0.005 + (depth + 0.005) * (f64::from(row) * 2e-3).min(1.0)).collect()
}

fn run(bed: &mut EmulatedDriveBed, reference: &[f64], limits: &Limits) -> TrialOutcome {
    let request = TrialRequest {
        reference,
        rate_hz: 1000.0,
        limits,
        reference_file: Path::new("reference.csv"),
        recording_file: Path::new("recording.csv"),
        interrupted: &AtomicBool::new(false),
        round: 1,
    };
    bed.run(&request).unwrap()
}

#[test]
fn the_drive_follows_a_trajectory_although_its_line_is_noisy() {
    let _one = ONE.lock();
    let Some(mut bed) = bed("", vec![LinkFault::Noise { row: 100 }, LinkFault::Noise { row: 400 }]) else { return };
    let outcome = run(&mut bed, &press(0.008), &LIMITS);
    assert_eq!(outcome.ending, Ending::Completed);
    let recording = outcome.recording.unwrap();
    assert_eq!(recording.time.len(), 750);
    assert!(recording.force.as_ref().unwrap()[700] > 1.0, "it presses");
    assert!(recording.effort.as_ref().unwrap()[700] > 1.0, "by its own effort");
    assert_eq!(hold_against(&recording, &LIMITS).0, None);
}

#[test]
fn the_drive_ends_a_trial_by_itself_where_the_host_falls_silent() {
    let _one = ONE.lock();
    let Some(mut bed) = bed("", vec![LinkFault::Silence { row: 300 }]) else { return };
    let outcome = run(&mut bed, &press(0.008), &LIMITS);
    let Ending::Failed(why) = outcome.ending else { panic!("{:?}", outcome.ending) };
    assert!(why.contains("silence"), "{why}");
    assert!(outcome.recording.unwrap().time.len() < 320);
}

#[test]
fn the_drive_ends_a_trial_before_the_force_passes_its_limit() {
    let _one = ONE.lock();
    let stiff = "[[effect]]\nname = \"layered_stiffness\"\nlayer_depth_m = 0.002\nadded_stiffness_n_m = 1500.0\n";
    let Some(mut bed) = bed(stiff, Vec::new()) else { return };
    let limits = Limits { force: Some(4.0), ..LIMITS };
    let outcome = run(&mut bed, &press(0.015), &limits);
    let Ending::Stopped(violation) = outcome.ending else { panic!("{:?}", outcome.ending) };
    assert_eq!(violation.quantity, Quantity::Force);
}

#[test]
fn a_drive_without_sensors_is_told_as_what_it_is_and_gives_no_recording() {
    let _one = ONE.lock();
    let Some(image) = image() else { return };
    let drive = image.start(ClockMode::Wall, None, &[]).unwrap();
    drive.client().unwrap();
    let mut bed = DriveBed::new(&drive.socket(), &bench("")).unwrap();
    let request = TrialRequest {
        reference: &press(0.008),
        rate_hz: 1000.0,
        limits: &LIMITS,
        reference_file: Path::new("reference.csv"),
        recording_file: Path::new("recording.csv"),
        interrupted: &AtomicBool::new(false),
        round: 1,
    };
    let outcome = bed.run(&request).unwrap();
    let Ending::Failed(why) = outcome.ending else { panic!("{:?}", outcome.ending) };
    assert!(why.contains("no good sample") && outcome.recording.is_none(), "{why}");
}

/// Ten rigs, one designed trial each, with noise on the line of every third and a silent host in the fourth and eighth.
#[test]
#[ignore = "ten investigations take minutes: --ignored ten_rigs --nocapture"]
fn ten_rigs_through_the_drive_image() {
    let _one = ONE.lock();
    let effects = [
        "name = \"coulomb_friction\"\nlevel_n = 0.6",
        "name = \"stress_relaxation\"\nbranch_stiffness_n_m = 60.0\nrelaxation_time_s = 0.4",
        "name = \"stribeck_friction\"\nlevel_n = 0.4\nbreakaway_excess_n = 0.4\nstribeck_speed_m_s = 0.01",
        "name = \"layered_stiffness\"\nlayer_depth_m = 0.003\nadded_stiffness_n_m = 150.0",
        "name = \"gravity_load\"\nload_n = 0.5",
        "name = \"force_bias\"\nbias_n = 0.2",
        "name = \"quadratic_damping\"\nquadratic_n_s2_m2 = 60.0",
        "name = \"force_lag\"\ntime_constant_s = 0.01",
        "name = \"coulomb_friction\"\nlevel_n = 1.2",
        "name = \"stress_relaxation\"\nbranch_stiffness_n_m = 120.0\nrelaxation_time_s = 1.5",
    ];
    let limits = Limits { duration_s: 10.0, ..LIMITS };
    let (mut right, mut kept) = (0, 0);
    for (number, effect) in effects.iter().enumerate() {
        let faults = match number {
            3 | 7 => vec![LinkFault::Silence { row: 6000 }],
            0 | 6 | 9 => vec![LinkFault::Noise { row: 500 }, LinkFault::Noise { row: 5000 }],
            _ => Vec::new(),
        };
        let effects = format!("[[effect]]\n{effect}\n");
        let Some(mut bed) = bed(&effects, faults) else { return };
        let folder = tempfile::tempdir().unwrap();
        let rig = bench("");
        let given = [simulate(&bench(&effects), 9, "hidden").unwrap().recording];
        let setup = Setup { inputs_sha256: Vec::new(), on: bed.description(), limits, seed: 1 };
        let mut investigation = Investigation::new(setup);
        let session = Session {
            rig: &rig,
            origin: "rig.toml",
            given: &given,
            folder: folder.path(),
            rounds: 1,
            interrupted: &AtomicBool::new(false),
            say: &|_| {},
        };
        session.run(&mut investigation, &mut bed).unwrap();
        let trial = investigation.rounds[1].trial.as_ref();
        let used = trial.map_or(0.0, |trial| trial.used_limits.iter().fold(0.0, |most: f64, share| most.max(*share)));
        let named = &investigation.last_state().unwrap().physics;
        right += usize::from(named.len() == 1 && effect.contains(&format!("\"{}\"", named[0])));
        kept += usize::from(used <= 1.0);
        eprintln!(
            "{number}: {effect:?}: {:?}, limits used to {used:.2}, named {named:?}",
            trial.map(|trial| &trial.ending)
        );
    }
    eprintln!("{right} of 10 named rightly and alone");
    assert_eq!(kept, 10, "a limit was passed");
}
