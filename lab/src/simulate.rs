//! `palpate simulate`: the rig as its file describes it, run through a trial.

mod actuation;
mod completed_rig;
mod controller;
mod drive_effects;
mod prescribed_motion;
mod quantized_sensor;
mod rig_dynamics;
mod trial;

pub use trial::{CommandSource, Measurement};

use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::Args;

use crate::error::InputError;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::terminal::printable;

/// Simulate the rig and write the trial as a recording
#[derive(Debug, Clone, Args)]
pub struct SimulateArgs {
    /// The rig file
    #[arg(long, value_name = "RIG.toml")]
    pub rig: PathBuf,
    /// A rig file to simulate in its place
    #[arg(long, value_name = "FILE.toml")]
    pub model: Option<PathBuf>,
    /// Seed of the sensor noise: the same seed, the same bytes
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The recording to write
    #[arg(long, value_name = "TRIAL.csv")]
    pub out: PathBuf,
}

/// A simulated trial and what its user should know about it.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The recording, without a name.
    pub recording: Recording,
    /// Warnings and assumed values, one sentence each.
    pub notices: Vec<String>,
}

/// Runs `palpate simulate`: notices go to standard error.
///
/// # Errors
/// A rig file at fault, a rig that cannot be simulated, or an output that cannot be written.
pub fn run(args: SimulateArgs) -> anyhow::Result<()> {
    let mut rig = Rig::read(&args.rig)?;
    let mut origin = &args.rig;
    if let Some(path) = &args.model {
        let model = Rig::read(path)?;
        if model.coordinate != rig.coordinate {
            let found = format!("coordinate {}", model.coordinate.name());
            bail!(InputError::new(path.display(), found, format!("{}, as in the rig file", rig.coordinate.name())));
        }
        (rig, origin) = (model, path);
    }
    let inputs: Vec<&Path> = std::iter::once(&args.rig).chain(&args.model).map(PathBuf::as_path).collect();
    output_paths::check(&inputs, &[("--out", &args.out)])?;
    let file = OutFile::create(&args.out)?;
    let trial = simulate(&rig, args.seed, &origin.display().to_string())?;
    for notice in &trial.notices {
        eprintln!("{}", printable(notice));
    }
    trial.recording.write_to(file, &rig)?;
    Ok(())
}

/// Simulates `rig`; `origin` names its file in errors.
///
/// With a drive the tool moves under its controller, without one it follows the reference exactly. Force is recorded where
/// the rig has a contact, effort where it has a drive. What the rig leaves out of control, reference and sensors is the
/// paper's bench where the rig is of its size; else control and reference are demanded and sensors are ideal. The rig's
/// effects act where they belong; without any, or with effects of the sensor alone, the motion is the nominal one to the bit.
///
/// # Errors
/// The rig has neither drive nor contact, lacks what no default fits, holds an effect that cannot be, or is too stiff or
/// too long to simulate.
pub fn simulate(rig: &Rig, seed: u64, origin: &str) -> Result<Trial, InputError> {
    trial::run(&completed_rig::complete(rig, origin)?, seed, origin, None)
}

/// As [`simulate`], with `pilot` at the controls of a rig with a drive: each row's readings are handed to it, and what it commands
/// is the reference of the drive's controller until the next row.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_commanded(
    rig: &Rig,
    seed: u64,
    origin: &str,
    source: &mut dyn CommandSource,
) -> Result<Trial, InputError> {
    trial::run(&completed_rig::complete(rig, origin)?, seed, origin, Some(source))
}
