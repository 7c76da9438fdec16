//! Drives whose law is known, identified from what their encoders show.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution as _, StandardNormal};

use super::*;
use crate::diagnose::drive::named::named;
use crate::diagnose::drive::term::Term;
use crate::diagnose::drive::testing::{TestDrive, TestLink, known_load, nominal, search_over, with_dry_friction};

fn identified(drive: &TestDrive, inertia: f64, viscous: f64, seed: u64) -> Outcome {
    let trials = vec![drive.trial(6.0, seed), drive.trial(6.0, seed + 1)];
    identify(trials, &nominal(inertia, viscous), 1, &|_| {}).expect("a drive that moves")
}

#[test]
fn a_drive_with_nothing_missing_is_left_alone_and_its_noise_is_known() {
    let outcome = identified(&TestDrive::PLAIN, 0.8, 4.0, 11);
    assert_eq!(outcome.verdict, Verdict::NoMismatch);
    assert!(outcome.named.is_empty() && outcome.alternatives.is_empty());
    let left = rms(&outcome.missing[1]);
    // Both are root mean squares of 12 000 rows in a band of some hertz: a tenth is three deviations.
    assert!((left / outcome.expected_noise - 1.0).abs() < 0.2, "{left} {}", outcome.expected_noise);
}

/// An arm with a weight of 3.6 N m that is swung up by a torque of +-0.9 N m with its speed, as an energy-shaping controller does, 200 rows
/// a second; its encoder rings at 30 Hz where something strikes it, now and then.
fn swung_arm(seed: u64) -> DriveTrial {
    const STEPS: usize = 50;
    const PERIOD_S: f64 = 5e-3;
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let (mut angle, mut speed) = (0.1, 0.0);
    let (mut ring, mut ring_speed) = (0.0, 0.0);
    let (mut time, mut position, mut torque) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..1600 {
        let effort: f64 = if speed < 0.0 { -0.9 } else { 0.9 };
        let strikes = rng.random::<f64>() < 0.02;
        ring_speed += if strikes { 2.0 * rng.random::<f64>() - 1.0 } else { 0.0 };
        ring_speed -= PERIOD_S * ((TAU * 30.0f64).powi(2) * ring + 10.0 * ring_speed);
        ring += PERIOD_S * ring_speed;
        time.push(PERIOD_S * f64::from(row));
        position.push(angle + ring);
        torque.push(effort);
        for _ in 0..STEPS {
            speed += PERIOD_S / STEPS as f64 * (effort - 3.6 * f64::sin(angle) - 0.05 * speed) / 0.18;
            angle += PERIOD_S / STEPS as f64 * speed;
        }
    }
    DriveTrial::new(format!("arm-{seed}.csv"), time, &position, torque, None, 1)
}

#[test]
fn of_an_encoder_that_rings_the_slower_motion_shows_the_weight() {
    let arm = NominalDrive { is_rotary: true, resolution: 3e-3, ..nominal(0.18, 0.05) };
    let outcome = identify(vec![swung_arm(1), swung_arm(2)], &arm, 1, &|_| {}).expect("a drive that moves");
    assert_eq!(outcome.chosen.model.names(), ["gravity_load"]);
    assert_eq!(outcome.verdict, Verdict::PartlyExplained);
    // The rings reach some 5 mrad.
    assert!(outcome.coarser_step.is_some_and(|step| step > 5e-3 && step < 0.063), "{:?}", outcome.coarser_step);
    let weight = outcome.chosen.model.values_of(0).start;
    let [low, high] = outcome.intervals[weight];
    assert!(low < 3.6 && 3.6 < high && high - low < 0.36, "{low} {high}");
}

#[test]
fn noise_of_the_recorded_effort_is_no_physics() {
    let outcome = identified(&TestDrive { effort_noise: 0.3, ..TestDrive::PLAIN }, 0.8, 4.0, 51);
    assert_eq!(outcome.verdict, Verdict::NoMismatch);
    // It is there: more than encoder and force sensor leave.
    assert!(rms(&outcome.missing[1]) > 1.5 * outcome.expected_noise);
}

/// A current behind a filter: its noise is louder in the band of the motion than its rows' differences show, and as loud at rest.
#[test]
fn noise_of_the_effort_that_remembers_is_no_physics() {
    let filtered = TestDrive { effort_noise: 0.05, effort_memory: 0.8, rests: true, ..TestDrive::PLAIN };
    let outcome = identified(&filtered, 0.8, 4.0, 53);
    assert_eq!((outcome.verdict, outcome.named.len()), (Verdict::NoMismatch, 0));
}

/// The same density whether the encoder's rows are thinned or not, and of two trials their mean.
#[test]
fn the_noise_of_the_recorded_effort_has_its_density() {
    let noisy = TestDrive { effort_noise: 0.3, ..TestDrive::PLAIN }.trial(4.0, 7);
    let (time, effort) = (noisy.source_time.clone(), noisy.effort.clone());
    let thinned = DriveTrial::new("thinned.csv".into(), time, &noisy.position, effort, None, 3);
    let density = |trials: &[DriveTrial]| Data { trials, least_encoder_variance: 0.0 }.effort_noise_density();
    // A median of 4000 squares that overlap: some hundredths.
    for trials in [[noisy.clone()], [thinned]] {
        let density = density(&trials);
        assert!((density / (0.3f64.powi(2) * 1e-3) - 1.0).abs() < 0.1, "{density}");
    }
    let quiet = TestDrive::PLAIN.trial(4.0, 8);
    let [one, other, both] =
        [vec![noisy.clone()], vec![quiet.clone()], vec![noisy, quiet]].map(|trials| density(&trials));
    assert!((2.0 * both / (one + other) - 1.0).abs() < 1e-12, "{both} of {one} and {other}");
}

#[test]
fn a_lag_of_two_rows_is_no_late_recording() {
    let outcome = identified(&TestDrive { effort_lag_s: 2e-3, ..TestDrive::PLAIN }, 0.75, 5.0, 81);
    assert_eq!(outcome.chosen.model.names(), ["effort_lag"]);
    let lag = outcome.chosen.values[outcome.chosen.model.values_of(0).start];
    assert!((lag / 2e-3 - 1.0).abs() < 0.02, "{lag}");
}

/// Beside dry friction, whose law has a delay of some rows at first: an effort that lags is told from one that is recorded three rows before it acts.
#[test]
fn beside_friction_a_lag_of_three_rows_is_no_late_recording() {
    const ROWS: usize = 3;
    let rubs = TestDrive { coulomb: 0.4, ..TestDrive::PLAIN };
    let lagged = TestDrive { effort_lag_s: ROWS as f64 * 1e-3, ..rubs };
    let late = |seed: u64| {
        let DriveTrial { source_time, position, effort, .. } = rubs.trial(6.0, seed);
        let kept = effort.len() - ROWS;
        let [time, position] = [source_time, position].map(|column| column[..kept].to_vec());
        DriveTrial::new(format!("late-{seed}.csv"), time, &position, effort[ROWS..].to_vec(), None, 1)
    };
    let is_lagged = |trials: [DriveTrial; 2]| {
        let search = search_over(&trials, &rubs);
        let fit = with_dry_friction(&search);
        assert!(fit.values[index::DELAY] > 2e-3, "{}", fit.values[index::DELAY]);
        search.is_lagged(&fit)
    };
    assert!(is_lagged([lagged.trial(6.0, 83), lagged.trial(6.0, 84)]));
    assert!(!is_lagged([late(85), late(86)]));
}

#[test]
fn a_recording_that_is_late_by_part_of_a_row_is_no_lag() {
    let outcome = identified(&TestDrive { effort_late_s: 0.6e-3, ..TestDrive::PLAIN }, 0.8, 4.0, 91);
    assert_eq!(outcome.verdict, Verdict::NoMismatch);
    // Half a step of the test's own simulation, which updates the velocity first, is 20 us.
    assert!((outcome.chosen.values[index::DELAY] - 0.6e-3).abs() < 0.025e-3);
}

/// A current that is measured through a row and not set at its start: as if held, its quick parts are too small, and a weak link seems
/// to swing.
#[test]
fn an_effort_that_is_recorded_as_a_mean_about_its_row_is_no_link() {
    let averaged = TestDrive { is_averaged: true, encoder: 1e-6, ..TestDrive::PLAIN };
    let outcome = identified(&averaged, 0.8, 4.0, 95);
    assert_eq!(outcome.verdict, Verdict::NoMismatch);
    let [delay, averaging] = [index::DELAY, index::AVERAGING].map(|at| outcome.chosen.values[at]);
    assert!((delay + 0.5e-3).abs() < 0.03e-3 && (averaging - 0.25).abs() < 0.03, "{delay} {averaging}");
    let ripple = identified(&TestDrive { ripple: 0.3, ..averaged }, 0.8, 4.0, 96);
    assert_eq!(ripple.chosen.model.names(), ["cogging"]);
}

#[test]
fn a_play_of_two_hundred_encoder_steps_is_named_with_its_gap() {
    let link = TestLink { stiffness: 4e4, damping: 30.0, play: 2e-3, load_share: 0.5, friction_share: 0.0 };
    let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 61);
    assert_eq!(outcome.chosen.model.names(), ["backlash"]);
    let gap = outcome.chosen.values[outcome.chosen.model.values_of(0).start + 3];
    // A tenth of the gap is twenty steps of the encoder.
    assert!((gap / 2e-3 - 1.0).abs() < 0.1, "{gap}");
    // What it leaves is what the encoder leaves: a link is measured as a rigid law is.
    let left = rms(&outcome.missing[2]);
    assert!((left / outcome.expected_noise - 1.0).abs() < 0.3, "{left} {}", outcome.expected_noise);
}

/// The same twenty times as slow, 50 rows a second, as of a crane: its flanks swing at 3.6 Hz.
#[test]
fn a_play_of_a_slow_machine_is_named_with_its_gap() {
    const SLOWER: f64 = 20.0;
    let link = TestLink { stiffness: 4e4, damping: 30.0, play: 2e-3, load_share: 0.5, friction_share: 0.0 };
    let quick = TestDrive { link: Some(link), ..TestDrive::PLAIN };
    let slow = |seed: u64| {
        let DriveTrial { source_time, position, effort, .. } = quick.trial(6.0, seed);
        let time = source_time.iter().map(|time| SLOWER * time).collect();
        let effort = effort.iter().map(|effort| effort / SLOWER.powi(2)).collect();
        DriveTrial::new(format!("slow-{seed}.csv"), time, &position, effort, None, 1)
    };
    let outcome = identify(vec![slow(61), slow(62)], &nominal(0.75, 5.0 / SLOWER), 1, &|_| {}).expect("it moves");
    assert_eq!(outcome.chosen.model.names(), ["backlash"]);
    let gap = outcome.chosen.values[outcome.chosen.model.values_of(0).start + 3];
    // A tenth of the gap is twenty steps of the encoder.
    assert!((gap / 2e-3 - 1.0).abs() < 0.1, "{gap}");
}

/// A gear that swings at 25 Hz on its flanks: a search with a louder disturbance ends at another gap, or in a lag of the effort.
#[test]
fn a_play_with_soft_flanks_is_named_with_its_gap_and_its_stiffness() {
    let link = TestLink { stiffness: 4700.0, damping: 2.2, play: 3e-3, load_share: 0.55, friction_share: 0.4 };
    let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.82, 4.3, 63);
    assert_eq!(outcome.chosen.model.names(), ["backlash"]);
    let own = outcome.chosen.model.values_of(0);
    let values = &outcome.chosen.values[own];
    // Three hundred times the encoder's step, seen some forty times: a hundredth is far beyond its noise.
    assert!((values[3] / 3e-3 - 1.0).abs() < 0.01 && (values[0] / 4700.0 - 1.0).abs() < 0.02, "{values:?}");
}

#[test]
fn a_weak_link_is_told_with_the_friction_of_its_load() {
    let link = TestLink { stiffness: 1200.0, damping: 1.3, play: 0.0, load_share: 0.4, friction_share: 0.7 };
    let outcome = identified(&TestDrive { link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 62);
    assert_eq!(outcome.chosen.model.names(), ["transmission_compliance"]);
    let own = outcome.chosen.model.values_of(0);
    let (values, ends) = (&outcome.chosen.values[own.clone()], &outcome.intervals[own]);
    for (at, truth) in [(0, 1200.0), (2, 0.4), (3, 0.7)] {
        // The test's own simulation, in 25 steps a row that update the velocity first, is late by half of one: a thousandth.
        let [low, high] = ends[at];
        assert!(low < 1.002 * truth && truth < 1.002 * high, "{at}: {values:?} {ends:?}");
        assert!((values[at] / truth - 1.0).abs() < 0.05, "{at}: {values:?}");
    }
}

#[test]
fn friction_and_a_link_that_hide_each_other_are_named_together() {
    let link = TestLink { stiffness: 1200.0, damping: 1.3, play: 0.0, load_share: 0.5, friction_share: 0.0 };
    let outcome = identified(&TestDrive { coulomb: 0.4, link: Some(link), ..TestDrive::PLAIN }, 0.75, 5.0, 71);
    assert_eq!(outcome.chosen.model.names(), ["coulomb_friction", "transmission_compliance"]);
}

#[test]
fn wrong_values_are_no_physics() {
    let outcome = identified(&TestDrive::PLAIN, 1.0, 7.0, 21);
    assert_eq!(outcome.verdict, Verdict::Parameters);
    assert!(outcome.named.is_empty());
    assert!((outcome.chosen.values[index::INERTIA] - 0.8).abs() < 2e-3);
    assert!((outcome.chosen.values[index::VISCOUS] - 4.0).abs() < 2e-2);
}

/// What a rigid-body model explains, of which the effort has to bear `factor`.
fn loaded(drive: &TestDrive, factor: f64, seed: u64) -> DriveTrial {
    let mut trial = drive.trial(6.0, seed);
    let load: Vec<f64> = trial.source_time.iter().map(|time| known_load(*time, seed)).collect();
    trial.effort.iter_mut().zip(&load).for_each(|(effort, load)| *effort += factor * load);
    DriveTrial { load: Some(load), ..trial }
}

#[test]
fn a_load_that_is_off_by_some_hundredths_is_a_value_and_no_physics() {
    let identified = |drive: &TestDrive, factor: f64| {
        identify(vec![loaded(drive, factor, 1), loaded(drive, factor, 2)], &nominal(0.8, 4.0), 1, &|_| {})
            .expect("it moves")
    };
    let scale = |outcome: &Outcome| outcome.chosen.values[outcome.chosen.model.load_scale().expect("a load")];
    let off = identified(&TestDrive::PLAIN, 1.06);
    assert_eq!((off.verdict, off.named.len()), (Verdict::Parameters, 0));
    // The load of the test is held from row to row and the model's is straight: half a row of 3 rad/s, 3e-3 N of 2 N.
    assert!((scale(&off) - 1.06).abs() < 3e-3, "{}", scale(&off));
    let right = identified(&TestDrive { coulomb: 0.4, ..TestDrive::PLAIN }, 1.0);
    assert_eq!(right.chosen.model.names(), ["coulomb_friction"]);
    assert!((scale(&right) - 1.0).abs() < 3e-3, "{}", scale(&right));
}

#[test]
fn a_load_that_never_acts_leaves_its_factor_where_it_is_believed() {
    let still = |trial: DriveTrial| DriveTrial { load: Some(vec![0.0; trial.effort.len()]), ..trial };
    let trials = [1, 2].map(|seed| still(TestDrive::PLAIN.trial(6.0, seed)));
    let outcome = identify(trials.to_vec(), &nominal(0.8, 4.0), 1, &|_| {}).expect("it moves");
    let at = outcome.chosen.model.load_scale().expect("a load");
    assert_eq!((outcome.verdict, outcome.chosen.values[at]), (Verdict::NoMismatch, 1.0));
    // Nothing was seen of it: all that is believed of it stays possible, 1.96 deviations of a twentieth.
    for (end, believed) in outcome.intervals[at].iter().zip([0.902, 1.098]) {
        assert!((end - believed).abs() < 1e-4, "{:?}", outcome.intervals[at]);
    }
}

/// A gear that bears a load of which the rig's model tells, through zero and back: it rubs by a fifth of it either way.
#[test]
fn friction_that_grows_with_a_load_that_is_given_is_named_with_its_share() {
    let geared = TestDrive { geared: 0.2, ..TestDrive::PLAIN };
    let trials = [1, 2].map(|seed| loaded(&geared, 1.0, seed)).to_vec();
    let outcome = identify(trials, &nominal(0.75, 5.0), 1, &|_| {}).expect("it moves");
    assert_eq!((outcome.verdict, outcome.chosen.model.names()), (Verdict::Explained, vec!["load_dependent_friction"]));
    let at = outcome.named[0].at;
    let share = outcome.chosen.values[outcome.chosen.model.values_of(at).start];
    // Of 0.4 N at most some hundredths are told as of a friction of one level.
    assert!((share - 0.2).abs() < 0.005, "{share}");
}

/// Iron that saturates: at 5 N of 6 N it gives 0.68 of what is commanded.
#[test]
fn an_effort_that_nears_its_limit_is_saturated_smoothly() {
    let outcome = identified(&TestDrive { iron: 6.0, ..TestDrive::PLAIN }, 0.75, 5.0, 37);
    assert_eq!(outcome.verdict, Verdict::Explained);
    assert_eq!(outcome.chosen.model.terms, [Term::SmoothLimit]);
    let limit = outcome.chosen.values[outcome.chosen.model.values_of(0).start];
    assert!((limit / 6.0 - 1.0).abs() < 0.03, "{limit}");
}

/// A ripple and its third harmonic, as of a magnet's pitch and its teeth: one drive has one cogging.
#[test]
fn a_ripple_and_its_harmonic_are_one_cogging_of_two_pitches() {
    let outcome = identified(&TestDrive { ripple: 0.3, third_ripple: 0.2, ..TestDrive::PLAIN }, 0.75, 5.0, 39);
    assert_eq!((outcome.verdict, outcome.named.len()), (Verdict::Explained, 1));
    assert_eq!(outcome.chosen.model.terms, [Term::Ripples(2)]);
    let own = &outcome.chosen.values[outcome.chosen.model.values_of(0)];
    let pitches = [own[2], own[5]].map(|wavenumber| TAU / wavenumber);
    let sizes = [own[0].hypot(own[1]), own[3].hypot(own[4])];
    for (found, truth) in pitches.iter().zip([5e-3, 5e-3 / 3.0]).chain(sizes.iter().zip([0.3, 0.2])) {
        assert!((found / truth - 1.0).abs() < 0.05, "{pitches:?} {sizes:?}");
    }
}

/// Dry friction leaves ten times as much, and a white force as much again as the ripple: of all that is missing that is no tenth, and of the rest a half. Its line stands out
/// of the orders around it.
#[test]
fn a_small_ripple_beside_friction_is_told_by_its_line() {
    let drive = TestDrive { third_ripple: 0.04, coulomb: 0.8, disturbance: 2e-5, ..TestDrive::PLAIN };
    let outcome = identified(&drive, 0.75, 5.0, 40);
    assert_eq!(outcome.chosen.model.names(), ["cogging", "coulomb_friction"]);
    let plain = identified(&TestDrive { third_ripple: 0.0, ..drive }, 0.75, 5.0, 40);
    assert_eq!(plain.chosen.model.names(), ["coulomb_friction"]);
}

/// While its sides are apart the motor is not seen at all, and the load that is seen flies on.
#[test]
fn a_play_that_is_seen_from_its_load_is_named_with_its_gap() {
    let link = TestLink { stiffness: 4e4, damping: 30.0, play: 1e-3, load_share: 0.5, friction_share: 0.7 };
    let drive = TestDrive { link: Some(link), sees_load: true, encoder: 1e-6, ..TestDrive::PLAIN };
    let rig = NominalDrive { encoder: Some(Side::Load), resolution: 1e-6, ..nominal(0.75, 5.0) };
    let trials = vec![drive.trial(6.0, 65), drive.trial(6.0, 66)];
    let outcome = identify(trials, &rig, 1, &|_| {}).expect("it moves");
    assert_eq!(outcome.chosen.model.names(), ["backlash"]);
    // The motor's inertia times the gap is what the load shows, 0.4 kg mm.
    let law = outcome.chosen.model.law(&outcome.chosen.values);
    let link = law.link.expect("a play");
    let shown = law.inertia * (1.0 - link.load_share) * link.play;
    assert!((shown / 0.4e-3 - 1.0).abs() < 0.05, "{shown} {link:?}");
    let told = named(&outcome.chosen, &outcome.intervals, outcome.named[0].at).expect("an effect");
    let [low, high] = told.intervals[0];
    assert!(low < 1e-3 && 1e-3 < high && high > 1.5 * low, "{low} {high}");
}

#[test]
fn dry_friction_is_named_alone_with_its_level_and_an_interval_that_holds_it() {
    let outcome = identified(&TestDrive { coulomb: 0.4, ..TestDrive::PLAIN }, 0.75, 5.0, 31);
    assert_eq!(outcome.verdict, Verdict::Explained);
    assert_eq!(outcome.chosen.model.names(), ["coulomb_friction"]);
    let at = outcome.chosen.model.values_of(0).start;
    let (level, [low, high]) = (outcome.chosen.values[at], outcome.intervals[at]);
    assert!((level - 0.4).abs() < 0.01, "{level}");
    // The interval is widened by what the halves disagree about: it holds the truth and is no wider than a twentieth.
    assert!(low - 0.004 <= 0.4 && 0.4 <= high + 0.004 && high - low < 0.04, "{low} {high}");
    let [_, refitted, improved] = [0, 1, 2].map(|of| rms(&outcome.missing[of]));
    assert!(improved < 1.3 * outcome.expected_noise && refitted > 1.5 * improved, "{refitted} {improved}");
}

/// A bristle of thirty encoder steps: with friction that is there at once three times what the encoder leaves is left.
#[test]
fn friction_that_builds_up_over_a_way_is_dry_friction_and_nothing_else() {
    let outcome = identified(&TestDrive { coulomb: 0.4, presliding: 1.5e-4, ..TestDrive::PLAIN }, 0.75, 5.0, 33);
    assert_eq!((outcome.verdict, outcome.chosen.model.names()), (Verdict::Explained, vec!["coulomb_friction"]));
    let level = outcome.chosen.values[outcome.chosen.model.values_of(0).start];
    // Four chords follow the exponential to a thirtieth of the friction, on the way of a turn alone.
    assert!((level - 0.4).abs() < 0.01, "{level}");
    let left = rms(&outcome.missing[2]);
    assert!(left < 1.3 * outcome.expected_noise, "{left} {}", outcome.expected_noise);
}

#[test]
fn friction_by_the_root_of_the_speed_stands_for_itself() {
    let outcome = identified(&TestDrive { root: 0.4, ..TestDrive::PLAIN }, 0.75, 5.0, 34);
    assert_eq!(outcome.chosen.model.names(), ["sublinear_friction"]);
    let own = outcome.chosen.model.values_of(0);
    assert!((outcome.chosen.values[own.start + 1] - 0.5).abs() < 0.03, "{:?}", outcome.chosen.values);
}

#[test]
fn a_white_force_is_unknown_and_nothing_is_named_for_it() {
    let outcome = identified(&TestDrive { disturbance: 0.05, ..TestDrive::PLAIN }, 0.8, 4.0, 41);
    assert!(outcome.named.is_empty(), "{:?}", outcome.chosen.model.names());
    assert_eq!(outcome.verdict, Verdict::Unknown);
}

#[test]
fn recordings_that_do_not_move_say_nothing() {
    let still = DriveTrial::new(
        "still.csv".to_owned(),
        (0..500).map(|row| 1e-3 * f64::from(row)).collect(),
        &[0.1; 500],
        vec![1.0; 500],
        None,
        1,
    );
    assert!(identify(vec![still], &nominal(0.8, 4.0), 1, &|_| {}).is_none());
}

/// A spring of 120 N/m that returns a slide, and a damper that brakes one way twice as much: neither is on the list, and each can look like what is.
#[test]
fn what_depends_on_something_else_than_a_name_says_is_unknown() {
    let told = |drive: &TestDrive| {
        let trials = vec![drive.trial(3.0, 91), drive.trial(3.0, 92)];
        identify(trials, &nominal(0.8, 4.0), 1, &|_| {}).expect("a drive that moves")
    };
    let spring = told(&TestDrive { spring: 120.0, ..TestDrive::PLAIN });
    assert_eq!(spring.chosen.model.names(), ["gravity_load"]);
    assert_eq!(spring.verdict, Verdict::PartlyExplained);
    let damper = told(&TestDrive { one_way: 1.0, ..TestDrive::PLAIN });
    assert!(damper.named.is_empty(), "{:?}", damper.chosen.model.names());
    assert_eq!(damper.verdict, Verdict::Unknown);
}

#[test]
fn a_name_that_was_found_to_be_something_else_is_not_taken_up_from_a_part_of_the_recordings() {
    let rivalled = ["effort_saturation"];
    assert!(has_none(&["gravity_load"], &rivalled) && has_none(&["effort_saturation"], &[]));
    assert!(!has_none(&["effort_saturation", "gravity_load"], &rivalled));
}

/// An arm of 0.2 kg m^2 behind a gear: a weight of 12 N m where it is level, 1.5 N m of dry friction and a tenth of the weight besides. Its
/// controller keeps the speed, and `texture` of the friction, N m, that comes and goes within a twentieth of a second, is answered by its torque.
#[derive(Clone, Copy)]
struct GearedArm {
    load_coefficient: f64,
    texture: f64,
}

impl GearedArm {
    const INERTIA: f64 = 0.2;
    const WEIGHT: f64 = 12.0;
    const COULOMB: f64 = 1.5;

    /// 8 s at 500 Hz along `reference`, its noise drawn from `seed`.
    fn trial(&self, seed: u64, reference: impl Fn(f64) -> f64) -> DriveTrial {
        const PERIOD_S: f64 = 2e-3;
        const STEPS: usize = 20;
        const ROWS: usize = 4000;
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let step = PERIOD_S / STEPS as f64;
        let (mut angle, mut speed) = (reference(0.0), (reference(step) - reference(0.0)) / step);
        let (mut integral, mut texture) = (Self::WEIGHT * angle.cos(), 0.0);
        let (mut time, mut position, mut torque) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..ROWS {
            let t = PERIOD_S * row as f64;
            let wanted = (reference(t + PERIOD_S) - reference(t)) / PERIOD_S;
            let late = 20.0 * (reference(t) - angle) + wanted - speed;
            integral += 1500.0 * late * PERIOD_S;
            let effort = 40.0 * late + integral;
            time.push(t);
            position.push(angle + 2e-5 * normal());
            torque.push(effort);
            let kept = (-PERIOD_S / 0.05f64).exp();
            texture = kept * texture + (1.0 - kept * kept).sqrt() * self.texture * normal();
            for _ in 0..STEPS {
                let weight = Self::WEIGHT * angle.cos();
                let holds = (Self::COULOMB + self.load_coefficient * weight.abs() + texture).max(0.0);
                let free = speed + step / Self::INERTIA * (effort - weight - 0.3 * speed);
                let held = step * holds / Self::INERTIA;
                speed = if free.abs() <= held { 0.0 } else { free - held * free.signum() };
                angle += step * speed;
            }
        }
        DriveTrial::new(format!("arm-{seed}.csv"), time, &position, torque, None, 1)
    }
}

/// Weight and friction are those of a robot's shoulder that swings about the level: friction is more where the weight is.
#[test]
fn friction_grows_with_the_weight_that_the_axis_carries() {
    let names = |load_coefficient: f64| {
        let arm = GearedArm { load_coefficient, texture: 0.0 };
        let swing = |t: f64| 1.2 * (1.3 * t).sin() + 0.2 * (4.1 * t).cos();
        let rig = NominalDrive { is_rotary: true, resolution: 1e-5, ..nominal(GearedArm::INERTIA, 0.3) };
        identify(vec![arm.trial(1, swing), arm.trial(2, swing)], &rig, 1, &|_| {}).expect("a drive that moves")
    };
    let outcome = names(0.1);
    let mut found = outcome.chosen.model.names();
    found.sort_unstable();
    assert_eq!(found, ["coulomb_friction", "gravity_load", "load_dependent_friction"]);
    let at = outcome.chosen.model.terms.iter().position(|term| *term == Term::LoadFriction).expect("it is there");
    let own = outcome.chosen.model.values_of(at).start;
    let [low, high] = outcome.intervals[own];
    assert!((outcome.chosen.values[own] - 0.1).abs() < 0.005 && low < 0.1 && 0.1 < high, "{low} {high}");
    let mut found = names(0.0).chosen.model.names();
    found.sort_unstable();
    assert_eq!(found, ["coulomb_friction", "gravity_load"]);
}

/// Passes at one speed each: nothing accelerates but by what the friction's texture leaves to the controller.
#[test]
fn where_the_motion_does_not_tell_the_inertia_that_of_the_rig_file_holds() {
    let arm = GearedArm { load_coefficient: 0.0, texture: 0.3 };
    let pass = |speed: f64| move |t: f64| speed * (t - 4.0);
    let rig = NominalDrive { is_rotary: true, resolution: 1e-5, ..nominal(GearedArm::INERTIA, 0.3) };
    let trials = [0.3, -0.3, 0.15, -0.15].iter().zip(1..).map(|(speed, seed)| arm.trial(seed, pass(*speed)));
    let outcome = identify(trials.collect(), &rig, 1, &|_| {}).expect("a drive that moves");
    let mut found = outcome.chosen.model.names();
    found.sort_unstable();
    assert_eq!(found, ["coulomb_friction", "gravity_load"]);
    // It is held, and told to be known no better than before.
    assert_eq!(outcome.chosen.values[index::INERTIA], GearedArm::INERTIA);
    let [low, high] = outcome.intervals[index::INERTIA];
    assert!(low < 0.5 * GearedArm::INERTIA && high > 2.0 * GearedArm::INERTIA);
}
