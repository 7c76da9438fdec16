//! The command line of `palpate investigate`.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context as _, Result};
use clap::Args;
use sha2::{Digest as _, Sha256};

use super::command_bed::{CommandBed, LONGEST_S};
use super::drive_bed::DriveBed;
use super::emulated_drive_bed::EmulatedDriveBed;
use super::record::{Investigation, Setup};
use super::report;
use super::session::{Session, default_limits};
use super::simulated_bed::SimulatedBed;
use super::test_bed::TestBed;
use crate::experiment_design::Limits;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::qemu_drive::DriveImage;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::terminal::printable;
use crate::tools::Leave;

/// Diagnose, design the trial that tells most, run it, and diagnose again, until one explanation is left
#[derive(Debug, Clone, Args)]
pub struct InvestigateArgs {
    /// The rig file: the simulation
    #[arg(long, value_name = "RIG.toml")]
    pub rig: PathBuf,
    /// Recordings to begin with; without any, the first trial explores
    #[arg(value_name = "TRIAL.csv")]
    pub trials: Vec<PathBuf>,
    /// What runs a trial: port:/dev/ttyUSB0, a drive on its serial line; sim:HIDDEN.toml, a simulation; qemu:HIDDEN.toml, the same
    /// under the control of the drive image in QEMU; or a command, called as COMMAND REFERENCE.csv RECORDING.csv
    #[arg(long, value_name = "port:PORT|sim:FILE|qemu:FILE|COMMAND")]
    pub on: String,
    /// Limits of every trial; where left out, what the recordings kept
    #[arg(long, value_name = "LIMITS.toml")]
    pub limits: Option<PathBuf>,
    /// Most trials that are run
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub rounds: u64,
    /// Folder for every round, the report and the model; an investigation that it holds is resumed
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Longest time that a COMMAND may take for a trial, s: it is asked to end then, as by Ctrl-C, 30 s later it is ended, and the trial has failed
    #[arg(long, value_name = "SECONDS", default_value_t = LONGEST_S, value_parser = clap::value_parser!(u64).range(1..))]
    pub longest: u64,
    /// Seed of the noise that is simulated, and drawn by the diagnosis: the same seed, the same answer
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

/// Runs `palpate investigate`.
///
/// # Errors
/// A file at fault, a folder of another investigation, a test bed that cannot be used, or an output that cannot be written.
pub fn run(args: &InvestigateArgs) -> Result<()> {
    let rig = Rig::read(&args.rig)?;
    let given = args.trials.iter().map(|path| Recording::read(path, &rig)).collect::<Result<Vec<_>, _>>()?;
    let limits = match &args.limits {
        Some(path) => Limits::read(path, &rig)?,
        None => default_limits(&given)?,
    };
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    let inputs: Vec<&Path> =
        std::iter::once(&args.rig).chain(&args.trials).chain(&args.limits).map(PathBuf::as_path).collect();
    let places = ["improved.toml", "report.html", super::record::FILE].map(|name| args.out.join(name));
    let outputs: Vec<_> = places.iter().map(|place| ("--out", place.as_path())).collect();
    output_paths::check(&inputs, &outputs)?;
    let mut bed = test_bed(args, &rig)?;
    let inputs = std::iter::once(&args.rig).chain(&args.trials).map(|path| sha256(path)).collect::<Result<_>>()?;
    let setup = Setup { inputs_sha256: inputs, on: args.on.clone(), limits, seed: args.seed };
    let mut investigation = Investigation::open(&args.out, setup)?;
    let interrupted = crate::interrupt::flag();
    let origin = args.rig.display().to_string();
    let session = Session {
        rig: &rig,
        origin: &origin,
        given: &given,
        folder: &args.out,
        rounds: args.rounds,
        interrupted: &interrupted,
        say: &|text| eprintln!("{}", printable(text)),
    };
    eprintln!("on {}", bed.description());
    let found = session.run(&mut investigation, bed.as_mut())?;
    if let Some(found) = &found {
        super::record::write(&args.out.join("improved.toml"), found.improved.to_toml().as_bytes())?;
    }
    let mut page = OutFile::create(&args.out.join("report.html"))?;
    report::write(&investigation, &rig, &args.out, &mut page).map_err(|error| page.fault(&error))?;
    page.commit()?;
    match investigation.outcome {
        Some(outcome) => eprintln!("{}", outcome.sentence()),
        None => eprintln!("interrupted: the same command resumes it"),
    }
    Ok(())
}

/// What `--on` names.
fn test_bed(args: &InvestigateArgs, rig: &Rig) -> Result<Box<dyn TestBed>> {
    let (on, seed) = (args.on.as_str(), args.seed);
    if let Some(hidden) = on.strip_prefix("sim:") {
        return Ok(Box::new(SimulatedBed::new(Path::new(hidden), rig, seed)?));
    }
    if let Some(hidden) = on.strip_prefix("qemu:") {
        let image = DriveImage::prepare(Leave::Look)?;
        return Ok(Box::new(EmulatedDriveBed::new(Path::new(hidden), rig, seed, image, Vec::new())?));
    }
    if let Some(port) = on.strip_prefix("port:") {
        return Ok(Box::new(DriveBed::new(Path::new(port), rig)?));
    }
    Ok(Box::new(CommandBed::new(on, rig, Duration::from_secs(args.longest))))
}

fn sha256(path: &Path) -> Result<String> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    Ok(Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect())
}
