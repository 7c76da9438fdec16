//! `cargo demo`: the main job, once through, on a recording that it makes and on a real one where there is one.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use palpate::EstimatorBank;
use palpate_drive::replay_format::{UpdateResult, estimate_words};

use crate::diagnose::{self, DiagnoseArgs};
use crate::effects;
use crate::qemu_bench::{QemuBench, project};
use crate::recording::Recording;
use crate::recordings_folder;
use crate::replay::{Options, Outputs, Place, Plan, Replayed, Runner, replay};
use crate::rig::{Rig, Sensors};
use crate::simulate::{self, SimulateArgs};
use crate::tools::{Leave, MissingTools};

/// Runs the demonstration; what had to be left out is listed at the end.
///
/// The diagnosis comes first, for it needs the host alone; the device's image is built after it.
///
/// # Errors
/// A file cannot be written, a tool that is there fails, or host and device differ.
pub fn run() -> Result<()> {
    println!("Palpate: what a simulation leaves out, and how stiff a contact is. Five steps, some minutes.");
    let mut left_out = Vec::new();
    let project = project()?;
    let out = project.join("out").join("demo");
    let rigs = project.join("lab").join("rigs");
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make {}", out.display()))?;
    let bench = rigs.join("bench.toml");

    println!("\n1. What the simulation leaves out: a bench whose contact relaxes, which the rig file does not know");
    let mut pages = vec![concealed(&bench, &out.join("diagnosis"))?];
    println!("\n2. The same of a real recording: an arm with a weight and dry friction, held against a bare inertia");
    let arm = recordings_folder::folder().map(|folder| folder.join("dfki_pendulum"));
    match arm.filter(|folder| folder.is_dir()) {
        Some(folder) => {
            let trials = ["ddp.csv", "dircol.csv"].map(|name| folder.join(name));
            pages.push(explained(&rigs.join("dfki_pendulum.toml"), &trials, &out.join("pendulum"))?);
        }
        None => left_out.push(format!("the arm: there is none here; {}", recordings_folder::ADVICE)),
    }

    println!("\n3. The device: its image is built (half a minute of processor time), and QEMU is to run it");
    let device = match QemuBench::prepare(Leave::Install) {
        Ok(device) => Some(Runner::QemuBench(device)),
        Err(error) if error.is::<MissingTools>() => {
            left_out.push(format!("the device: {error}"));
            None
        }
        Err(error) => return Err(error),
    };
    println!("\n4. A simulated bench, on the host and on the device: a tool taps a wall of 300 N/m and 5 N s/m");
    let trial = out.join("bench.csv");
    simulate::run(SimulateArgs { rig: bench.clone(), model: None, seed: 1, out: trial.clone() })?;
    pages.push(show(device.as_ref(), &bench, &trial, &out.join("bench"))?);
    println!("\n5. A real recording, on both: a probe sinks into a polymer gel, nanonewtons on micrometres");
    let real = recordings_folder::folder().map(|folder| folder.join("afm_soft_contact").join("creep_polymergel.csv"));
    match real.filter(|path| path.is_file()) {
        Some(trial) => pages.push(show(device.as_ref(), &rigs.join("afm_creep_gel.toml"), &trial, &out.join("gel"))?),
        None => left_out.push(format!("the real recording: there is none here; {}", recordings_folder::ADVICE)),
    }

    println!("\nPages to open in a browser:");
    pages.iter().for_each(|page| println!("   {}", page.display()));
    if left_out.is_empty() {
        println!("Nothing was left out.");
    } else {
        println!("Left out:");
        left_out.iter().for_each(|what| println!("   {what}"));
    }
    Ok(())
}

/// Depth, period and sine of the two trials that are diagnosed.
const MOTIONS: [(f64, f64, f64); 2] = [(12e-3, 5.0, 6.0), (8e-3, 4.0, 3.0)];

/// Simulates two trials of the bench with a relaxing contact, and diagnoses them against the bench without it.
fn concealed(bench: &Path, out: &Path) -> Result<PathBuf> {
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let mut known = Rig::read(bench)?;
    known.sensors = Sensors {
        position_resolution: Some(5e-6),
        force_resolution: Some(0.005),
        force_noise: Some(0.01),
        force_zero: None,
    };
    known.simulation.duration_s = 12.0;
    let mut trials = Vec::new();
    for (number, (depth, period, sine)) in MOTIONS.into_iter().enumerate() {
        let mut true_one = known.clone();
        if let Some(reference) = &mut true_one.reference {
            (reference.contact_depth, reference.period_s, reference.contact_s) = (depth, period, 0.6 * period);
            (reference.free_depth, reference.sine_amplitude, reference.sine_frequency_hz) = (-5e-3, 1e-3, sine);
        }
        let relaxation = effects::find("stress_relaxation").context("no effect of that name")?;
        true_one.effects = vec![effects::to_table(relaxation, 0, true_one.coordinate, &[60.0, 0.4], None)];
        let (rig, trial) =
            (out.join(format!("true-{}.toml", number + 1)), out.join(format!("trial-{}.csv", number + 1)));
        true_one.write(&rig)?;
        simulate::run(SimulateArgs { rig, model: None, seed: number as u64, out: trial.clone() })?;
        trials.push(trial);
    }
    let rig = out.join("known.toml");
    known.write(&rig)?;
    explained(&rig, &trials, out)
}

/// Diagnoses `trials`; returns the page.
fn explained(rig: &Path, trials: &[PathBuf], out: &Path) -> Result<PathBuf> {
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let page = out.join("diagnosis.html");
    diagnose::run(&DiagnoseArgs {
        vary: None,
        margins: None,
        rig: rig.to_path_buf(),
        trials: trials.to_vec(),
        simulation: Vec::new(),
        json: Some(out.join("diagnosis.json")),
        report: Some(page.clone()),
        model: Some(out.join("improved.toml")),
        experiment: None,
        seed: 1,
    })?;
    Ok(page)
}

/// Identifies one recording on the host and, where there is one, on the device; returns the page.
fn show(device: Option<&Runner>, rig_path: &Path, trial: &Path, out: &Path) -> Result<PathBuf> {
    let rig = Rig::read(rig_path)?;
    let options = Options::default();
    let mut outputs = Outputs::open(out, rig_path, &[trial.to_path_buf()])?;
    let recording = Recording::read(trial, &rig)?;
    let plan = Plan::new(&rig, rig_path, &recording, &options)?;
    let host = replay(&Runner::Host, &plan, &recording, outputs.sinks(rig.coordinate).pop())?;
    let verdict = match device {
        None => "left out".to_owned(),
        Some(device) => same_bits(device, &plan, &recording)?,
    };
    print_side_by_side(&rig, &host, &verdict);
    host.notices.iter().for_each(|notice| println!("   note: {notice}"));
    outputs.write(&rig, vec![host], &options, Place::Host)?;
    Ok(out.join("replay.html"))
}

fn print_side_by_side(rig: &Rig, host: &Replayed, verdict: &str) {
    let (k, b) = (rig.coordinate.stiffness_unit(), rig.coordinate.damping_unit());
    println!(
        "   {:<9} {:>26} {:>26}   device",
        "method",
        format!("K on the host [{k}]"),
        format!("B on the host [{b}]")
    );
    for (method, summary) in &host.summaries {
        let (k, b) = summary.map_or(("unknown".to_owned(), "unknown".to_owned()), |s| {
            (
                crate::replay::interval(s.stiffness, s.stiffness_half_width),
                crate::replay::interval(s.damping, s.damping_half_width),
            )
        });
        println!("   {:<9} {k:>26} {b:>26}   {verdict}", method.name());
    }
}

/// How many samples agree to the bit, in all methods; an error where one does not.
fn same_bits(device: &Runner, plan: &Plan, recording: &Recording) -> Result<String> {
    let mut host = EstimatorBank::new(&plan.config)?;
    let mut samples = plan.samples(recording).enumerate();
    let words = |outcome: &UpdateResult| {
        let estimates = outcome.as_ref().map(|all| plan.methods.iter().map(|method| all[*method as usize]));
        estimates
            .map(|estimates| estimates.map(|estimate| estimate_words(&estimate)).collect::<Vec<_>>())
            .map_err(|r| *r)
    };
    device.start(plan, recording, |_| ())?.outcomes(|device| {
        let (k, sample) = samples.next().context("the device returned more samples than it was fed")?;
        let host = host.update(sample);
        ensure!(words(&host) == words(&device), "host and device differ at sample {k}: {host:?}, {device:?}");
        Ok(())
    })?;
    let count = plan.samples(recording).len();
    ensure!(samples.len() == 0, "the device returned {} of {count} samples", count - samples.len());
    Ok(format!("same bits on {count} of {count} samples"))
}
