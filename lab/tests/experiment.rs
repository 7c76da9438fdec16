//! The experiment that would tell two explanations apart.

use palpate_lab::diagnose::bootstrap::problem::IdentificationProblem;
use palpate_lab::diagnose::bootstrap::sampler::BootstrapSampler;
use palpate_lab::diagnose::estimation::whitener::{NoiseModel, Whitener, filtered_trials};
use palpate_lab::diagnose::experiment::{DECISIVE_CHI2, InformationRate, design, separated_by};
use palpate_lab::diagnose::model::{Model, Term};
use palpate_lab::diagnose::report::diagnosis::Experiment;
use palpate_lab::diagnose::signals::derivative_filter::DerivativeFilter;
use palpate_lab::diagnose::signals::uniform_trial::UniformTrial;
use palpate_lab::effects::find;
use palpate_lab::rig::Rig;
use palpate_lab::sensors::Figures;
use palpate_lab::simulate::simulate;

/// Sizes of a bench: lengths, forces.
#[derive(Clone, Copy)]
struct Size {
    length: f64,
    force: f64,
}

const BENCH: Size = Size { length: 1.0, force: 1.0 };

/// Recordings of a tool that taps a soft pad to 8 mm with a sine of `frequency` on top, every length and force scaled.
fn recorded(size: Size, frequency: f64) -> (IdentificationProblem, Whitener) {
    look(&pad(size, frequency))
}

fn pad(size: Size, frequency: f64) -> String {
    let Size { length, force } = size;
    format!(
        "[rig]\nname = \"pad\"\ncoordinate = \"linear\"\n\
         [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = {}\ndamping_n_s_m = {}\n\
         [sensors]\nposition_resolution_m = {}\nforce_resolution_n = {}\nforce_noise_n = {}\n\
         [reference]\nfree_depth_m = {}\ncontact_depth_m = {}\nperiod_s = 4\ncontact_s = 2\nsmoothing_s = 0.06\n\
         sine_amplitude_m = {}\nsine_frequency_hz = {frequency}\n[simulation]\nduration_s = 16\nrate_hz = 500\n",
        300.0 * force / length,
        5.0 * force / length,
        5e-6 * length,
        0.01 * force,
        0.02 * force,
        -5e-3 * length,
        8e-3 * length,
        2e-3 * length,
    )
}

/// Recordings of a drive and what it touches.
fn driven(contact: &str) -> (IdentificationProblem, Whitener) {
    look(&format!(
        "[rig]\nname = \"bench\"\ncoordinate = \"linear\"\n[drive]\nmass_kg = 0.8\nviscous_n_s_m = 4.0\n{contact}\
         [sensors]\nposition_resolution_m = 5e-6\n\
         [reference]\nfree_depth_m = -5e-3\ncontact_depth_m = 8e-3\nperiod_s = 4\ncontact_s = 2\nsmoothing_s = 0.06\n\
         sine_amplitude_m = 2e-3\nsine_frequency_hz = 4\n[simulation]\nduration_s = 16\nrate_hz = 1000\n"
    ))
}

const PAD: &str = "[contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 300\ndamping_n_s_m = 5\n";

fn look(text: &str) -> (IdentificationProblem, Whitener) {
    look_at(text, "", 1)
}

/// `count` recordings of a rig that has `effects` which its file does not know.
fn look_at(text: &str, effects: &str, count: u64) -> (IdentificationProblem, Whitener) {
    let rig = Rig::parse(text, "rig.toml").unwrap();
    let real = Rig::parse(&format!("{text}{effects}"), "rig.toml").unwrap();
    let raws: Vec<UniformTrial> = (1..=count)
        .map(|seed| {
            let recording = simulate(&real, seed, "rig.toml").unwrap().recording;
            UniformTrial::of(&recording, Figures::of(&rig, &recording), recording.period())
        })
        .collect();
    let (lens, drive_filter) = (DerivativeFilter::for_contact(&rig, &raws), DerivativeFilter::for_drive(&rig, &raws));
    let force = raws[0].figures.force.map(|force| force.noise * lens.noise()[0]);
    // A drive that is shaken by its own encoder's steps: 20 mN.
    let effort = rig.drive.map(|_| 0.02 * drive_filter.noise()[0]);
    let study = IdentificationProblem::new(&rig, "rig", BootstrapSampler::new(raws, lens, drive_filter, 1)).unwrap();
    let even =
        |effort: bool, floor: f64| NoiseModel::even(&filtered_trials(&study.sampler.trials, effort), floor.max(1e-12));
    let whitener = Whitener { force: force.map(|f| even(false, f)), effort: effort.map(|f| even(true, f)) };
    (study, whitener)
}

fn term(name: &str) -> Term {
    Term { effect: find(name).unwrap(), form: 0 }
}

/// The rig's own values with one effect of the given parameters.
fn model(study: &IdentificationProblem, name: &str, parameters: &[f64]) -> (Model, Vec<f64>) {
    let term = term(name);
    assert_eq!(term.parameters().len(), parameters.len(), "{name}: {:?}", term.parameters());
    (study.nominal.with(term), study.given.iter().chain(parameters).copied().collect())
}

fn experiment(
    bench: &(IdentificationProblem, Whitener),
    answer: &(Model, Vec<f64>),
    rival: &(Model, Vec<f64>),
) -> (Experiment, InformationRate) {
    let found = design(&bench.0, &bench.1, (&answer.0, &answer.1), &[(&rival.0, &rival.1)]).unwrap();
    println!("{}\n{:?}\n", found.0.text, found.1);
    found
}

/// Relaxation over 0.3 s against a delay, in recordings that show a single frequency.
fn relaxation_or_delay(size: Size) -> (Experiment, InformationRate) {
    let bench = recorded(size, 8.0);
    let answer = model(&bench.0, "stress_relaxation", &[60.0 * size.force / size.length, 0.3]);
    let rival = model(&bench.0, "channel_delay", &[1e-3]);
    experiment(&bench, &answer, &rival)
}

#[test]
fn relaxation_and_delay_are_told_apart_by_holds_or_by_two_frequencies() {
    let (experiment, worth) = relaxation_or_delay(BENCH);
    assert!(
        ["holds", "frequencies", "reversals"].iter().any(|word| experiment.text.contains(word)),
        "{}",
        experiment.text
    );
    assert!(worth.designed > 1.3 * worth.recorded, "{worth:?}");
    assert!(worth.designed * experiment.time.last().unwrap() > DECISIVE_CHI2);
    for word in ["stress_relaxation", "channel_delay", "rms", "N", "s in all"] {
        assert!(experiment.text.contains(word), "{word}: {}", experiment.text);
    }
}

#[test]
fn damping_that_grows_with_depth_is_told_from_drag_at_two_depths_or_two_speeds() {
    let bench = recorded(BENCH, 8.0);
    let answer = model(&bench.0, "hunt_crossley_damping", &[600.0]);
    let rival = model(&bench.0, "quadratic_damping", &[30.0]);
    let (experiment, worth) = experiment(&bench, &answer, &rival);
    let by = ["two depths", "two speeds", "frequencies"];
    assert!(by.iter().any(|by| experiment.text.contains(by)), "{}", experiment.text);
    assert!(worth.designed > worth.recorded, "{worth:?}");
}

#[test]
fn the_experiment_asks_nothing_of_the_rig_that_the_recordings_did_not() {
    let (experiment, _) = relaxation_or_delay(BENCH);
    let (study, _) = recorded(BENCH, 8.0);
    let recorded = &study.sampler.uniform_trials[0].position;
    let (low, high) = range(recorded);
    let (least, greatest) = range(&experiment.reference);
    // The analysis sees the recording smoothed, which takes a little off its peaks and adds nothing.
    assert!(least >= low - 1e-5 && greatest <= high + 1e-5, "{least} to {greatest} within {low} to {high}");
    assert!(greatest > 0.8 * high, "the depth that was reached is used: {greatest} of {high}");
    let period = study.sampler.contact_filter.period;
    // The smooth reference without its sensor: its rates by differences.
    let (speed, acceleration) = rates(&experiment.reference, period);
    let true_speed = 0.013 / 0.06 * (-1.0f64).exp() + 2e-3 * 8.0 * std::f64::consts::TAU;
    let true_acceleration = 0.013 / 0.06f64.powi(2) + 2e-3 * (8.0 * std::f64::consts::TAU).powi(2);
    assert!(speed <= 1.02 * true_speed, "{speed} m/s of {true_speed}");
    assert!(acceleration <= 1.02 * true_acceleration, "{acceleration} m/s^2 of {true_acceleration}");
    assert!(*experiment.time.last().unwrap() <= 2.0 * 16.0);
}

#[test]
fn the_reference_is_continuous_sampled_like_the_recording_and_comes_home() {
    let (experiment, _) = relaxation_or_delay(BENCH);
    let Experiment { time, reference, .. } = &experiment;
    assert_eq!(time.len(), reference.len());
    assert!(time.windows(2).all(|pair| (pair[1] - pair[0] - 2e-3).abs() < 1e-9));
    // The recording began at rest at -5 mm, but for the beginning of its sine.
    let (first, last) = (reference[0], reference[reference.len() - 1]);
    assert!((first + 5e-3).abs() < 2e-3 && (first - last).abs() < 1e-12, "{first} to {last}");
    let (speed, acceleration) = rates(reference, 2e-3);
    let velocity: Vec<f64> = reference.windows(2).map(|pair| (pair[1] - pair[0]) / 2e-3).collect();
    // A jump of the position would be a spike of the speed, one of the velocity a spike of the acceleration.
    assert!(velocity.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 1.0001 * acceleration * 2e-3) && speed < 0.5);
    assert!(acceleration < 15.0 && velocity[0].abs() < 1e-3 && velocity[velocity.len() - 1].abs() < 1e-3);
}

#[test]
fn a_micrometre_and_a_nanonewton_are_told_apart_by_the_same_experiment() {
    let (bench, worth) = relaxation_or_delay(BENCH);
    // Lengths of 1 m become 100 um, so that the pad is pressed by 1 um; forces of 1 N become 1 nN.
    let (small, small_worth) = relaxation_or_delay(Size { length: 1e-4, force: 1e-9 });
    assert!((small_worth.designed / worth.designed - 1.0).abs() < 0.02, "{small_worth:?} against {worth:?}");
    assert_eq!(bench.time.len(), small.time.len());
    let peak = range(&bench.reference).1;
    for (small, bench) in small.reference.iter().zip(&bench.reference) {
        assert!((small / 1e-4 - bench).abs() < 1e-6 * peak, "{small} against {bench}");
    }
}

#[test]
fn what_no_motion_separates_says_so() {
    let says = |one: &str, other: &str, words: &[&str]| {
        for text in [separated_by(&term(one), &term(other)), separated_by(&term(other), &term(one))] {
            assert!(words.iter().all(|word| text.contains(word)), "{one}, {other}: {text}");
        }
    };
    says("transmission_compliance", "stress_relaxation", &["No motion", "drive's effort"]);
    says("force_gain", "nonlinear_stiffness", &["scale of stiffness", "no motion", "drive's effort"]);
    says("force_bias", "surface_motion", &["free space", "sensor"]);
    says("stress_relaxation", "channel_delay", &["hold"]);
    says("hunt_crossley_damping", "quadratic_damping", &["depth"]);
    says("tool_inertia", "environment_mass", &["free space"]);
}

#[test]
fn every_pair_of_effects_has_its_sentence() {
    let all = palpate_lab::effects::ALL;
    for one in all {
        for other in all {
            let [one, other] = [one, other].map(|effect| Term { effect, form: 0 });
            let text = separated_by(&one, &other);
            assert!(text.ends_with('.') && text.len() > 30, "{text}");
        }
    }
}

#[test]
fn two_explanations_that_are_one_are_not_separated_by_any_motion() {
    let bench = recorded(BENCH, 8.0);
    // A gain is a scale of stiffness and damping, which the rival refits and stays linear.
    let answer = model(&bench.0, "force_gain", &[0.2]);
    let rival = model(&bench.0, "nonlinear_stiffness", &[1.0, 8e-3]);
    let (experiment, worth) = experiment(&bench, &answer, &rival);
    assert!(worth.designed * experiment.time.last().unwrap() < DECISIVE_CHI2, "{worth:?}");
    assert!(experiment.text.contains("No motion") && experiment.text.contains("drive's effort"), "{}", experiment.text);
}

#[test]
fn what_two_real_recordings_leave_open_is_closed_by_the_experiment() {
    // A short relaxation beside a delay, in two glued recordings of a single frequency that never let go of the pad.
    let swung = pad(BENCH, 8.0)
        .replace("damping_n_s_m = 5\n", "damping_n_s_m = 5\nbilateral = true\n")
        .replace("free_depth_m = -0.005", "free_depth_m = 0.0079");
    let relaxes = "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 30\nrelaxation_time_s = 0.05\n";
    let bench = look_at(&swung, relaxes, 2);
    assert_eq!((bench.0.nominal.contact, bench.0.nominal.surface_shifts.len()), (Some(true), 1));
    let fitted = |name: &str, parameters: &[f64]| {
        let (model, start) = model(&bench.0, name, parameters);
        let fit = bench.0.fit(&model, &start, &bench.1);
        println!("{name}: {:?} leaves {}", fit.values, fit.energy);
        (model, fit.values, fit.energy)
    };
    let (answer, values, energy) = fitted("stress_relaxation", &[30.0, 0.05]);
    let (rival, rival_values, rival_energy) = fitted("channel_delay", &[1e-3]);
    let (experiment, worth) = experiment(&bench, &(answer, values), &(rival, rival_values));
    assert!(rival_energy - energy < 0.1 * energy, "{rival_energy} beside {energy}: they are rivals here");
    assert!(worth.designed > 5.0 * worth.recorded, "{worth:?}");
    assert!(
        ["holds", "frequencies", "reversals"].iter().any(|word| experiment.text.contains(word)),
        "{}",
        experiment.text
    );
}

#[test]
fn a_tool_that_weighs_is_told_from_a_pad_that_does_by_quick_motion_in_free_space() {
    let bench = recorded(BENCH, 8.0);
    let answer = model(&bench.0, "tool_inertia", &[0.05]);
    let rival = model(&bench.0, "environment_mass", &[0.05]);
    let (experiment, worth) = experiment(&bench, &answer, &rival);
    assert!(experiment.text.contains("free space"), "{}", experiment.text);
    assert!(worth.designed > worth.recorded, "{worth:?}");
}

#[test]
fn friction_that_falls_with_speed_is_told_from_one_that_does_not_by_reversals_in_free_space() {
    let bench = driven("");
    let answer = model(&bench.0, "stribeck_friction", &start(&bench.0, "stribeck_friction"));
    let rival = model(&bench.0, "coulomb_friction", &start(&bench.0, "coulomb_friction"));
    let (experiment, worth) = experiment(&bench, &answer, &rival);
    assert!(experiment.text.contains("reversals in free space"), "{}", experiment.text);
    assert!(experiment.text.contains("drive's balance"), "{}", experiment.text);
    assert!(worth.designed > 10.0 * worth.recorded, "{worth:?}");
    // Coulomb's law is Stribeck's without the excess: only if it is Stribeck's can anything be seen.
    let (other_way, _) = self::experiment(&bench, &rival, &answer);
    assert!(other_way.text.contains("reversals in free space"), "{}", other_way.text);
    assert!(other_way.text.contains("too little to see"), "{}", other_way.text);
}

#[test]
fn against_two_rivals_the_closer_one_counts_and_both_are_spoken_of() {
    let bench = recorded(BENCH, 8.0);
    let answer = model(&bench.0, "stress_relaxation", &[20.0, 0.03]);
    let delay = model(&bench.0, "channel_delay", &[1e-3]);
    let mass = model(&bench.0, "tool_inertia", &[0.02]);
    let rivals = [(&delay.0, delay.1.as_slice()), (&mass.0, mass.1.as_slice())];
    let (both, worth) = design(&bench.0, &bench.1, (&answer.0, &answer.1), &rivals).unwrap();
    println!("{}\n{worth:?}", both.text);
    assert!(both.text.contains("channel_delay") && both.text.contains("tool_inertia"), "{}", both.text);
    let one = experiment(&bench, &answer, &delay).1;
    assert!(worth.designed <= 1.01 * one.designed, "{worth:?} against {one:?}");
    assert!(worth.designed > worth.recorded);
}

#[test]
fn every_effect_has_an_experiment_against_its_neighbour_within_what_the_rig_bore() {
    let bench = driven(PAD);
    let (low, high) = range(&bench.0.sampler.uniform_trials[0].position);
    let scene = bench.0.excitation_stats(&bench.0.nominal, &bench.0.given);
    let models: Vec<_> = palpate_lab::effects::ALL
        .into_iter()
        .filter(|effect| !effect.starts(0, &scene).is_empty())
        .map(|effect| model(&bench.0, effect.spec().name, &start(&bench.0, effect.spec().name)))
        .collect();
    for pair in models.chunks_exact(2) {
        println!("{:?} against {:?}", pair[0].0.terms, pair[1].0.terms);
        let Some((experiment, worth)) =
            design(&bench.0, &bench.1, (&pair[0].0, &pair[0].1), &[(&pair[1].0, &pair[1].1)])
        else {
            panic!("none");
        };
        println!("{}\n{worth:?} {} s\n", experiment.text, experiment.time.last().unwrap());
        let (least, greatest) = range(&experiment.reference);
        assert!(least >= low - 1e-5 && greatest <= high + 1e-5, "{least} to {greatest}");
        assert!(worth.designed.is_finite() && *experiment.time.last().unwrap() <= 32.0);
        assert!(experiment.text.is_ascii() || !experiment.text.contains("unknown"), "{}", experiment.text);
    }
}

#[test]
fn without_a_rival_there_is_nothing_to_design() {
    let bench = recorded(BENCH, 8.0);
    let answer = model(&bench.0, "channel_delay", &[1e-3]);
    assert!(design(&bench.0, &bench.1, (&answer.0, &answer.1), &[]).is_none());
}

/// Where the search for an effect begins.
fn start(study: &IdentificationProblem, name: &str) -> Vec<f64> {
    let scene = study.excitation_stats(&study.nominal, &study.given);
    find(name).unwrap().starts(0, &scene)[0].values.clone()
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

/// Greatest speed and acceleration by differences.
fn rates(reference: &[f64], period: f64) -> (f64, f64) {
    let speed = reference.windows(2).map(|pair| (pair[1] - pair[0]).abs() / period).fold(0.0, f64::max);
    let bend = |row: &[f64]| (row[2] - 2.0 * row[1] + row[0]).abs() / (period * period);
    (speed, reference.windows(3).map(bend).fold(0.0, f64::max))
}
