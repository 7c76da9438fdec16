//! The device against the host: the same sources, the same samples, the same bits.
//!
//! Without the cross target or QEMU these tests say so and pass, unless `PALPATE_DEVICE=required` (as `cargo verify`
//! sets it where it has set them up).

use std::path::Path;

use palpate::{
    BlockConfig, ContactLoss, EstimatorBank, EstimatorBankConfig, Field, FrontEndConfig, Method, Rejection, Sample,
    StreamConfig, Velocity,
};
use palpate_drive::replay_format::{ReplayCounters, UpdateResult, estimate_words};
use palpate_lab::qemu_bench::{QemuBench, project};
use palpate_lab::recording::Recording;
use palpate_lab::recordings_folder;
use palpate_lab::replay::{Options, Plan};
use palpate_lab::rig::{Contact, Rig};
use palpate_lab::simulate;
use palpate_lab::tools::{Leave, MissingTools};

/// The device, or `None` with a word where its tools are absent.
fn device() -> Option<QemuBench> {
    match QemuBench::prepare(Leave::Look) {
        Ok(device) => Some(device),
        Err(error) if error.is::<MissingTools>() && std::env::var_os("PALPATE_DEVICE").is_none() => {
            eprintln!("left out: {error}");
            None
        }
        Err(error) => panic!("{error:#}"),
    }
}

fn every_estimator(stream: StreamConfig) -> EstimatorBankConfig {
    EstimatorBankConfig { block: BlockConfig::of(120), ..EstimatorBankConfig::all_methods(stream) }
}

/// Runs both and compares every word of every outcome; returns the device's counters and the host's outcomes.
fn compare(
    device: &QemuBench,
    what: &str,
    config: &EstimatorBankConfig,
    samples: &[Sample],
) -> (ReplayCounters, Vec<UpdateResult>) {
    let mut bench = EstimatorBank::new(config).expect("sound settings");
    let host: Vec<UpdateResult> = samples.iter().map(|&sample| bench.update(sample)).collect();
    let mut returned = 0;
    let run = device.start(config, samples.iter().copied(), |_| ());
    let counters = run.and_then(|run| {
        run.each(|outcome| {
            assert_same(what, returned, &host[returned], &outcome);
            returned += 1;
            Ok(())
        })
    });
    let counters = counters.unwrap_or_else(|error| panic!("{what}: {error:#}"));
    assert_eq!(returned, samples.len(), "{what}");
    assert_eq!(counters.samples as usize, samples.len(), "{what}: the interrupt took every sample once");
    (counters, host)
}

fn assert_same(what: &str, k: usize, host: &UpdateResult, device: &UpdateResult) {
    match (host, device) {
        (Ok(host), Ok(device)) => {
            for (method, (host, device)) in Method::ALL.iter().zip(host.iter().zip(device)) {
                assert_eq!(
                    estimate_words(host),
                    estimate_words(device),
                    "{what}, sample {k}, {method:?}: {host:?}, {device:?}"
                );
            }
        }
        _ => assert_eq!(host, device, "{what}, sample {k}"),
    }
}

#[test]
fn on_a_simulated_bench_every_estimate_has_the_same_bits() {
    let Some(device) = device() else { return };
    let rig_path = project().expect("sources").join("lab/rigs/bench.toml");
    let rig = Rig::read(&rig_path).expect("a rig");
    let recording = simulate::simulate(&rig, 7, "bench.toml").expect("a trial").recording;
    let options = Options { methods: Method::ALL.to_vec(), ..Options::default() };
    let plan = Plan::new(&rig, &rig_path, &recording, &options).expect("a plan");
    let samples: Vec<Sample> = plan.samples(&recording).collect();
    let (counters, host) = compare(&device, "bench", &plan.config, &samples);
    assert_eq!(counters.overruns, 0, "every update ends within its millisecond");
    let touched = host.iter().flatten().filter(|all| all[Method::Bls as usize].impedance.stiffness > 100.0).count();
    assert!(touched > 20_000, "the bench touches for half of its 60 s, found {touched} samples");
}

#[test]
fn on_every_real_recording_every_estimate_has_the_same_bits() {
    let Some(device) = device() else { return };
    let Some(folder) = recordings_folder::folder() else {
        eprintln!("left out: no real recordings; {}", recordings_folder::ADVICE);
        return;
    };
    let (mut trials, mut samples) = (0, 0);
    for set in
        ["afm_soft_contact", "tissue_indentation", "keyswitch_press", "nanoindentation", "pneumatic_seal_friction"]
    {
        let mut paths: Vec<_> = std::fs::read_dir(folder.join(set))
            .unwrap_or_else(|error| panic!("{set}: {error}"))
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
            .collect();
        paths.sort();
        for path in paths {
            samples += compare_trial(&device, &path);
            trials += 1;
        }
    }
    eprintln!("{trials} real recordings, {samples} samples, {} methods: the same bits", Method::ALL.len());
    assert!(trials >= 50, "{trials} trials");
}

/// The surface stands at the median position, so that about half of any recording is contact.
fn compare_trial(device: &QemuBench, path: &Path) -> usize {
    let recording = Recording::read(path, &Rig::default()).unwrap_or_else(|error| panic!("{error}"));
    let mut positions = recording.position.clone();
    positions.sort_by(f64::total_cmp);
    let surface = positions[positions.len() / 2];
    let contact = Contact { surface, stiffness: 1.0, damping: 0.0, bilateral: false };
    let rig = Rig { contact: Some(contact), ..Rig::default() };
    let options = Options { methods: Method::ALL.to_vec(), window: 120, ..Options::default() };
    let plan =
        Plan::new(&rig, path, &recording, &options).unwrap_or_else(|error| panic!("{}: {error:#}", recording.name));
    let samples: Vec<Sample> = plan.samples(&recording).collect();
    compare(device, &recording.name, &plan.config, &samples);
    samples.len()
}

#[test]
fn a_hostile_stream_has_the_same_bits_and_the_same_rejections() {
    let Some(device) = device() else { return };
    let mut random = 1_u32;
    let mut draw = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        random >> 8
    };
    let samples: Vec<Sample> = (0..6000)
        .map(|k| {
            let t = k as f32 * 1e-3;
            let position = 0.010 * (2.0 * t).sin() + 0.003 * (63.0 * t).sin();
            let good = Sample { position, force: (300.0 * position).max(0.0), elapsed: 1e-3 };
            match draw() % 40 {
                0 => Sample { position: f32::NAN, ..good },
                1 => Sample { force: f32::INFINITY, ..good },
                2 => Sample { elapsed: -1.0, ..good },
                3 => Sample { elapsed: 0.05, ..good },
                4 => Sample { force: 1e30, ..good },
                5 => Sample { elapsed: 1e-3 * (1.0 + draw() as f32 / 1.7e7), ..good },
                6 => Sample { position: f32::from_bits(draw()), ..good },
                7 => Sample { position: good.position * 1e5, force: good.force * 1e4, ..good },
                _ => good,
            }
        })
        .collect();
    for velocity in [Velocity::Matched, Velocity::Paper] {
        for contact_loss in [ContactLoss::Everything, ContactLoss::Memory, ContactLoss::Nothing] {
            let front_end = FrontEndConfig { velocity, ..FrontEndConfig::BENCH };
            let config = every_estimator(StreamConfig { front_end, contact_loss, ..StreamConfig::BENCH });
            let (_, host) = compare(&device, &format!("{velocity:?}, {contact_loss:?}"), &config, &samples);
            for rejection in [
                Rejection::NotFinite(Field::Position),
                Rejection::NotFinite(Field::Force),
                Rejection::OutOfRange(Field::Elapsed),
                Rejection::OutOfRange(Field::Force),
            ] {
                assert!(host.contains(&Err(rejection)), "the stream was to provoke {rejection:?}");
            }
        }
    }
}

#[test]
fn replay_on_either_side_writes_the_same_file() {
    if device().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let rig = project().expect("sources").join("lab/rigs/bench.toml");
    let trial = folder.path().join("trial.csv");
    let palpate = || {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_palpate"));
        command.env("PALPATE_NO_INSTALL", "1");
        command
    };
    let simulated = palpate().args(["simulate", "--rig"]).arg(&rig).arg("--out").arg(&trial).status();
    assert!(simulated.expect("palpate runs").success());
    let [host, qemu] = ["host", "qemu"].map(|place| {
        let out = folder.path().join(place);
        let mut command = palpate();
        command.args(["replay", "--on", place, "--rig"]).arg(&rig).arg(&trial).arg("--out").arg(&out);
        assert!(command.output().expect("palpate runs").status.success(), "{place}");
        std::fs::read(out.join("estimates.csv")).expect("estimates")
    });
    assert!(host.len() > 1_000_000, "{} bytes of 60 000 rows", host.len());
    assert!(host == qemu, "estimates.csv differs");
}

#[test]
fn an_empty_recording_and_a_single_sample_come_back() {
    let Some(device) = device() else { return };
    let config = every_estimator(StreamConfig::BENCH);
    compare(&device, "empty", &config, &[]);
    compare(&device, "single", &config, &[Sample { position: 0.01, force: 3.0, elapsed: 1e-3 }]);
}

#[test]
fn settings_out_of_range_are_refused_by_the_image_and_told() {
    let Some(device) = device() else { return };
    let config =
        EstimatorBankConfig { block: BlockConfig::of(5000), ..EstimatorBankConfig::all_methods(StreamConfig::BENCH) };
    let error = device.start(&config, [].into_iter(), |_| ()).expect_err("a window of 5000 samples");
    assert!(format!("{error:#}").contains("the settings are out of range"), "{error:#}");
}
