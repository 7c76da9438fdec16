//! What is estimated of the sensors, against signals whose sensor is known and over the real recordings.

use std::path::{Path, PathBuf};

use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;
use palpate_lab::sensors::{Figures, quantum, white_noise};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const LINEAR: &str = "[rig]\nname = \"a\"\ncoordinate = \"linear\"\n";
const ROTARY: &str = "[rig]\nname = \"a\"\ncoordinate = \"rotary\"\n";

fn rig(text: &str) -> Rig {
    Rig::parse(text, "rig.toml").unwrap()
}

fn normal(count: usize, seed: u64) -> Vec<f64> {
    let mut chance = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| StandardNormal.sample(&mut chance)).collect()
}

fn clock(count: usize, rate: f64) -> Vec<f64> {
    (0..count).map(|row| row as f64 / rate).collect()
}

/// Scales from nanonewtons at 50 kHz to ten kilonewtons at 10 Hz.
const SCALES: [(f64, f64); 4] = [(1e-9, 5e4), (1.0, 1e3), (1e-6, 10.0), (1e4, 10.0)];

fn near(found: f64, expected: f64, relative: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= relative, "{what}: {found:e} against {expected:e}, {:.1} % off", 100.0 * error);
}

#[test]
fn noise_is_measured_beneath_motion_onsets_and_spikes_at_any_scale() {
    let count = 4000;
    for (force, rate) in SCALES {
        let time = clock(count, rate);
        let noise = normal(count, 3);
        let mut values: Vec<f64> = (0..count)
            .map(|row| {
                let phase = row as f64 / count as f64;
                // Forty cycles, then an onset at half time: a hundred and a thousand times the noise.
                let slow = 100.0 * (40.0 * std::f64::consts::TAU * phase).sin();
                force * (noise[row] + slow + if row > count / 2 { 1000.0 } else { 0.0 })
            })
            .collect();
        for row in (0..count).step_by(500) {
            values[row] += 1e4 * force;
        }
        // 4000 samples through a filter that leaves about a third of them independent: 2 %; the median of blocks adds as much.
        near(white_noise(&time, &values), force, 0.06, "noise");
    }
}

#[test]
fn noise_does_not_mind_an_uneven_clock() {
    let count = 4000;
    let jitter = normal(count, 5);
    let time: Vec<f64> = (0..count).map(|row| row as f64 + 0.1 * jitter[row].tanh()).collect();
    let noise = normal(count, 6);
    let values: Vec<f64> = (0..count).map(|row| 50.0 * time[row] + noise[row]).collect();
    near(white_noise(&time, &values), 1.0, 0.06, "noise under a ramp of fifty a sample");
}

#[test]
fn a_step_is_found_at_any_scale_and_none_where_there_is_none() {
    let noise = normal(3000, 9);
    for (force, _) in SCALES {
        for step in [0.05, 0.37, 1.0, 0.1 / 3.0] {
            let rounded: Vec<f64> = noise.iter().map(|value| (value / step).round() * (step * force)).collect();
            near(quantum(&rounded), step * force, 1e-9, "step");
        }
        let smooth: Vec<f64> = noise.iter().map(|value| value * force).collect();
        assert_eq!(quantum(&smooth), 0.0, "continuous noise");
    }
    let sine: Vec<f64> = (0..3000).map(|row| (f64::from(row) * 0.0123).sin()).collect();
    assert_eq!(quantum(&sine), 0.0, "continuous motion");
    assert_eq!(quantum(&[2.0; 50]), 0.0, "a stuck reading has no step");
    assert_eq!(quantum(&[]), 0.0);
}

#[test]
fn decimal_text_does_not_hide_the_count_behind_its_last_digit() {
    // A 14-bit count of 0.24414 mm, printed to the micrometre, far from zero.
    let count = 4.0 / 16384.0;
    let text = |value: f64| format!("{value:.6}").parse::<f64>().unwrap();
    let values: Vec<f64> = normal(3000, 4).iter().map(|value| text(1.0 + (20.0 * value).round() * count)).collect();
    near(quantum(&values), count, 1e-4, "count");
    // A wide-ranging counter, seldom on neighbouring counts, read 2000 times.
    let values: Vec<f64> = normal(2000, 8).iter().map(|value| (3e4 * value).round() * 1e-3).collect();
    near(quantum(&values), 1e-3, 1e-9, "sparse counts");
}

#[test]
fn a_steady_ramp_is_not_taken_for_a_coarse_sensor() {
    // 1 mm/s at 10 Hz, held to a third of a percent and printed to 10 nm: every row is 0.1 mm on, and no sensor counts.
    let wander = normal(100, 7);
    let mut at = 0.0;
    let mut text = |wander: &f64| {
        at += 1e-4 * (1.0 + 3e-3 * wander);
        format!("{at:.8}").parse::<f64>().unwrap()
    };
    let values: Vec<f64> = wander.iter().map(&mut text).collect();
    assert!(quantum(&values) <= 1e-8, "{:e}", quantum(&values));
    // The same with a rest every six rows, so that its steps come in short runs as a slow sensor's would.
    let resting: Vec<f64> =
        values.chunks(6).flat_map(|run| run.iter().chain([&run[run.len() - 1]; 2])).copied().collect();
    assert!(quantum(&resting) <= 1e-8, "{:e}", quantum(&resting));
    let perfect: Vec<f64> =
        (0..200).map(|row| f64::from(if row < 100 { row } else { 200 - row }) * 1e-3 / 3.0).collect();
    assert_eq!(quantum(&perfect), 0.0, "up and down at one speed, in full digits");
    let rounded: Vec<f64> = (0..200).map(|row| (f64::from(row) * 0.7).round() * 1e-3 / 3.0).collect();
    near(quantum(&rounded), 1e-3 / 3.0, 1e-9, "a ramp of 0.7 counts a reading");
}

#[test]
fn a_million_rows_are_read() {
    let count = 1_000_000;
    let time = clock(count, 1e3);
    let wave = |gain: f64| -> Vec<f64> { time.iter().map(|t| gain * (3.7 * t).sin()).collect() };
    let recording = Recording {
        position: wave(0.01),
        force: Some(wave(3.0)),
        effort: Some(wave(4.0)),
        time: time.clone(),
        ..Recording::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.csv");
    recording.write(&path, &Rig::default()).unwrap();
    let start = std::time::Instant::now();
    let read = Recording::read(&path, &rig(LINEAR)).unwrap();
    let reading = start.elapsed();
    let figures = Figures::of(&rig(LINEAR), &read);
    println!(
        "{count} rows of four columns: read in {reading:.2?}, sensors estimated in {:.2?}",
        start.elapsed() - reading
    );
    assert_eq!(read.time.len(), count);
    assert_eq!(figures.force.unwrap().resolution, 0.0);
}

#[test]
fn a_rounded_noise_is_the_noise_and_its_rounding_and_never_less_than_rounding() {
    let count = 8000;
    let time = clock(count, 1e3);
    let noise = normal(count, 2);
    for (spread, tolerance) in [(2.0, 0.06), (0.5, 0.08)] {
        let values: Vec<f64> = noise.iter().map(|value| (spread * value).round()).collect();
        let expected = f64::hypot(spread, 1.0 / 12f64.sqrt());
        near(white_noise(&time, &values), expected, tolerance, "noise and rounding");
    }
    let recording = Recording {
        time: time.clone(),
        position: (0..count).map(|row| (row as f64 * 0.01).floor()).collect(),
        force: Some((0..count).map(|row| (row as f64 * 0.003).round() * 0.5).collect()),
        ..Recording::default()
    };
    let figures = Figures::of(&rig(LINEAR), &recording);
    let force = figures.force.unwrap();
    near(force.resolution, 0.5, 1e-9, "step of a staircase");
    near(force.noise, 0.5 / 12f64.sqrt(), 1e-9, "floor of a staircase");
    let given =
        Figures::of(&rig(&format!("{LINEAR}[sensors]\nforce_resolution_n = 0.0\nforce_noise_n = 3.0\n")), &recording);
    assert_eq!((given.force.unwrap().resolution, given.force.unwrap().noise), (0.0, 3.0));
}

#[test]
fn the_sensors_of_the_simulated_bench_are_found_in_its_recording() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs/bench.toml");
    let start = std::time::Instant::now();
    let trial = palpate_lab::simulate::simulate(&Rig::read(&path).unwrap(), 5, "bench.toml").unwrap();
    println!("a minute of the bench simulated in {:.2?}", start.elapsed());
    let figures = Figures::of(&rig(LINEAR), &trial.recording);
    let force = figures.force.unwrap();
    println!("{figures:?}");
    near(figures.position.resolution, 1e-4, 1e-9, "encoder count");
    near(force.resolution, 0.05, 1e-9, "force step");
    // 60 000 samples are worth 19 000: 0.5 %, and two and a half times that for a median.
    near(force.noise, 0.09f64.hypot(0.05 / 12f64.sqrt()), 0.015, "force noise");
}

fn recordings() -> Option<PathBuf> {
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/recordings");
    let folder = std::env::var_os("PALPATE_RECORDINGS").map_or(usual, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("LEFT OUT: no real recordings at {} (PALPATE_RECORDINGS points elsewhere)", folder.display());
    None
}

#[test]
fn the_rigs_of_real_recordings_touch_where_the_force_rises() {
    let Some(folder) = recordings() else { return };
    let pairs = [
        ("afm_creep_brain", "afm_soft_contact/creep_brain"),
        ("afm_creep_gel", "afm_soft_contact/creep_polymergel"),
        ("afm_cell", "afm_soft_contact/fd_cell_2016a"),
        ("tissue_s230515", "tissue_indentation/s230515_P002_1"),
        ("tissue_meat", "tissue_indentation/meat_230327_FF1_1A"),
    ];
    for (name, trial) in pairs {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs").join(format!("{name}.toml"));
        let rig = Rig::read(&path).unwrap();
        let recording = Recording::read(&folder.join(format!("{trial}.csv")), &rig).unwrap();
        let (contact, zero) = (rig.contact.unwrap(), rig.sensors.force_zero.unwrap());
        let force = recording.force.unwrap();
        let peak = (0..force.len()).max_by(|one, two| force[*one].total_cmp(&force[*two])).unwrap();
        let load = force[peak] - zero;
        for ((position, force), time) in recording.position.iter().zip(&force).zip(&recording.time).take(peak) {
            // Before the touch only noise and drift: 2 % of the load. At the peak the line is right to a factor of two.
            assert!(*position > contact.surface || (force - zero).abs() < 0.02 * load, "{name} at {time} s");
        }
        let spring = contact.stiffness * (recording.position[peak] - contact.surface);
        assert!((0.5..2.0).contains(&(spring / load)), "{name}: {spring:.2e} N against {load:.2e} N");
    }
}

#[test]
fn real_recordings_are_read_and_their_sensors_are_plausible() {
    let Some(folder) = recordings() else { return };
    let sets = [
        "afm_soft_contact",
        "dfki_pendulum",
        "keyswitch_press",
        "nanoindentation",
        "pneumatic_seal_friction",
        "tissue_indentation",
    ];
    for set in sets {
        let rotary = format!("{ROTARY}[columns]\neffort = \"torque_Nm\"\n");
        let rig = rig(if set == "dfki_pendulum" { &rotary } else { LINEAR });
        let mut paths: Vec<_> =
            std::fs::read_dir(folder.join(set)).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "csv"));
        paths.sort();
        assert!(!paths.is_empty(), "{set}");
        for path in paths {
            let recording = Recording::read(&path, &rig).unwrap();
            let figures = Figures::of(&rig, &recording);
            let (values, channel) = match (&recording.force, figures.force) {
                (Some(force), Some(channel)) => (force, channel),
                _ => (recording.effort.as_ref().unwrap(), figures.effort.unwrap()),
            };
            let most = values.iter().copied().fold(f64::MIN, f64::max);
            let span = most - values.iter().copied().fold(f64::MAX, f64::min);
            println!(
                "{:36} {:9.1} Hz  x step {:9.2e} noise {:9.2e}  F step {:9.2e} noise {:9.2e} span {span:9.2e}",
                recording.name,
                recording.rate(),
                figures.position.resolution,
                figures.position.noise,
                channel.resolution,
                channel.noise
            );
            assert!(channel.noise >= channel.resolution / 12f64.sqrt() && channel.noise > 0.0);
            // The spikiest, a motor's torque under a stiff controller, scatters by a tenth of its span.
            assert!(channel.noise < 0.15 * span, "{}", recording.name);
        }
    }
}
