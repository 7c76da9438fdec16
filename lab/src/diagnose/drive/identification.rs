//! From trials to the law of their drive.

use std::f64::consts::TAU;

use super::criteria::{COARSER, LOWEST_BAND_HZ, MOST_COARSE};
use super::denoised::denoised;
use super::fit::Fit;
use super::held_out::rms;
use super::judgement::judged;
use super::law::{DriveLaw, Side};
use super::likelihood::Data;
use super::model::index;
use super::nominal::{NominalDrive, encoder_variance, missing_under, nominal_fit, punctual_and_lagged, scales};
use super::outcome::Outcome;
use super::outside_force::outside_forces;
use super::selection::{Chosen, Search};
use super::trial::DriveTrial;
use crate::diagnose::verdict::Verdict;

/// Identifies the drive of `trials`; `None` where they show no motion or are too short.
///
/// Where the encoder moves from row to row as no force on the inertia could move it (the nominal law leaves more than the whole effort),
/// and no law is found, it is not on the body that the law moves: between them is what rattles or bends. The slower motion is looked at
/// then, as if the encoder were coarser by steps, until that shows a law; the rest stays unknown.
#[must_use]
pub fn identify(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    let first = identify_between_pushes(trials, rig, seed, say)?;
    let scales = first.chosen.model.scales;
    if !first.named.is_empty() || first.verdict != Verdict::Unknown || rms(&first.missing[1]) < scales.effort {
        return Some(first);
    }
    let range = if rig.is_rotary { scales.travel.min(TAU) } else { scales.travel };
    let mut step = (12.0 * encoder_variance(&first.trials, &scales)).sqrt() * COARSER.value();
    while step < MOST_COARSE * range {
        say("the drive: its slower motion");
        let coarser = NominalDrive { resolution: step, ..rig.clone() };
        let found = identify_between_pushes(first.trials.clone(), &coarser, seed, say);
        if let Some(found) = found.filter(is_law_of_slower_motion) {
            return Some(Outcome { verdict: Verdict::PartlyExplained, coarser_step: Some(step), ..found });
        }
        step *= COARSER.value();
    }
    Some(first)
}

/// Whether it is a law of the motion that a coarser encoder shows: not one of how quickly a force comes or passes on, of which that shows
/// nothing.
fn is_law_of_slower_motion(found: &Outcome) -> bool {
    let model = &found.chosen.model;
    let is_quick = model.has_link() || model.has("effort_lag");
    !found.named.is_empty() && !is_quick && rms(&found.missing[2]) < rms(&found.missing[1])
}

/// The same of the motion as the encoder shows it. Where no law does and a force from outside comes and goes, the law of the rest is looked
/// for. Where that explains all of the recordings, nothing came from outside: to a rigid drive, by which such stretches are found, a
/// resonance that is passed looks like a push.
fn identify_between_pushes(
    trials: Vec<DriveTrial>,
    rig: &NominalDrive,
    seed: u64,
    say: &dyn Fn(&str),
) -> Option<Outcome> {
    let first = identify_as_they_are(trials, rig, seed, say)?;
    if !matches!(first.verdict, Verdict::Unknown | Verdict::PartlyExplained) {
        return Some(first);
    }
    let values = &first.chosen.values;
    let law = DriveLaw {
        effort_averaging: first.chosen.model.law(values).effort_averaging,
        ..DriveLaw::nominal(rig.inertia, rig.viscous, values[index::DELAY])
    };
    let missing = missing_under(&first.trials, rig)?;
    let stretches = outside_forces(&first.trials, &missing, &law, &first.chosen.model.scales);
    if stretches.is_empty() {
        return Some(first);
    }
    say("the drive: without the stretches in which something else pushes");
    let quiet = first.trials.iter().enumerate().map(|(number, trial)| {
        let own = stretches.iter().filter(|stretch| stretch.trial == number);
        trial.without(&own.map(|stretch| [stretch.start_s, stretch.end_s]).collect::<Vec<_>>())
    });
    let Some(second) = identify_as_they_are(quiet.collect(), rig, seed, say).filter(|found| !found.named.is_empty())
    else {
        return Some(first);
    };
    let whole = identify_by(first.trials, rig, seed, say, &|search| search.fitted(&second.chosen));
    Some(match whole {
        Some(whole) if whole.verdict == Verdict::Explained => whole,
        _ => Outcome { verdict: Verdict::PartlyExplained, outside_forces: stretches, ..second },
    })
}

/// How the refitted nominal law stands before trials.
pub struct NominalStanding {
    /// ln of their likelihood under it, nats.
    pub log_likelihood: f64,
    /// Force that it does not explain in the common band, N or N m in root mean square.
    pub unexplained: f64,
}

/// How the refitted nominal law stands before `trials`; `None` where they show no motion.
#[must_use]
pub fn nominal_standing(trials: &[DriveTrial], rig: &NominalDrive) -> Option<NominalStanding> {
    let scales = scales(trials, rig)?;
    let variance = encoder_variance(trials, &scales);
    let data = Data { trials, least_encoder_variance: 0.3 * variance };
    let search = search_from(data, rig, nominal_fit(&data, rig, scales, variance)?);
    let unexplained = search.unexplained(&search.nominal);
    Some(NominalStanding { log_likelihood: search.nominal.log_likelihood, unexplained })
}

fn identify_as_they_are(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    identify_by(trials, rig, seed, say, &|search| search.run(say))
}

/// Identifies the drive of `trials` by the law that is `chosen` for them.
fn identify_by(
    trials: Vec<DriveTrial>,
    rig: &NominalDrive,
    seed: u64,
    say: &dyn Fn(&str),
    chosen: &dyn Fn(&Search<'_>) -> Chosen,
) -> Option<Outcome> {
    let scales = scales(&trials, rig)?;
    let encoder_variance = encoder_variance(&trials, &scales);
    say("the drive: nominal values");
    let as_recorded = Data { trials: &trials, least_encoder_variance: 0.3 * encoder_variance };
    let nominal = nominal_fit(&as_recorded, rig, scales, encoder_variance)?;
    let denoised = denoised(&as_recorded, &nominal);
    let data = denoised.as_ref().map_or(as_recorded, |trials| Data { trials, ..as_recorded });
    let nominal = if denoised.is_some() { nominal_fit(&data, rig, scales, encoder_variance)? } else { nominal };
    // A recording may be late by some rows. Where a lag of the drive is worth its value beside a punctual recording, it is the lag.
    let lag = punctual_and_lagged(&data, rig, &nominal, encoder_variance).and_then(|[punctual, lagged]| {
        // It was found already: however little of the effort it is, it is looked for.
        let search = Search { is_asked: true, ..search_from(data, rig, punctual) };
        search.is_worth(&lagged, &search.nominal).then_some(search)
    });
    let search = lag.unwrap_or_else(|| search_from(data, rig, nominal));
    let chosen = chosen(&search);
    say("the drive: what is left");
    let mut outcome = judged(&search, chosen, seed);
    outcome.trials = denoised.unwrap_or(trials);
    Some(outcome)
}

fn search_from<'a>(data: Data<'a>, rig: &NominalDrive, nominal: Fit) -> Search<'a> {
    let scales = nominal.model.scales;
    let crossing = nominal.noise.crossing_hz(scales.period_s, nominal.values[index::INERTIA]);
    let band_hz = crossing.clamp(LOWEST_BAND_HZ.value().min(0.1 / scales.period_s), 0.4 / scales.period_s);
    let sides = rig.encoder.map_or(vec![Side::Motor, Side::Load], |side| vec![side]);
    Search { data, scales, nominal, band_hz, sides, is_asked: false, effort_noise_density: data.effort_noise_density() }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha12Rng;

    use super::*;
    use crate::diagnose::drive::testing::{TestDrive, TestLink, nominal};

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
        let load: Vec<f64> = trial.source_time.iter().map(|time| 2.0 * (3.0 * time + seed as f64).sin()).collect();
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
        // Nothing was seen of it: all that is believed of it stays possible.
        assert_eq!(outcome.intervals[at], [0.85, 1.15]);
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
}
