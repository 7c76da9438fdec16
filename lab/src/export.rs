//! `palpate export`: the physics that was found, in the model of the simulator that the user has.
//!
//! The joint's coordinate is taken for the rig's position, and the force of its actuator for the effort: same sign, same zero, SI units.

mod description;
mod found_effect;
mod mjcf;
mod mjcf_model;
mod passive_force;
mod python_stepper;
mod xml_edit;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::{Args, ValueEnum};

use crate::error::{InputError, UsageError};
use crate::outfile::OutFile;
use crate::output_paths;
use crate::rig::Rig;
use crate::terminal::printable;
use found_effect::FoundEffect;

/// Write the physics that was found into your own simulation model
#[derive(Debug, Clone, Args)]
pub struct ExportArgs {
    /// What the model is written in
    #[arg(long, value_enum)]
    pub to: Target,
    /// The improved rig file, from `palpate diagnose --model`
    #[arg(value_name = "IMPROVED.toml")]
    pub improved: PathBuf,
    /// Your model: MJCF, URDF or SDF; for `python`, the MJCF model that the stepper steps
    #[arg(long, value_name = "MODEL")]
    pub into: PathBuf,
    /// The joint that was diagnosed
    #[arg(long, value_name = "NAME")]
    pub joint: String,
    /// The joint's actuator, where it has several (MJCF)
    #[arg(long, value_name = "NAME")]
    pub actuator: Option<String>,
    /// The sensor of the contact force, for effects of the sensor (MJCF)
    #[arg(long, value_name = "NAME")]
    pub sensor: Option<String>,
    /// The rig file that was diagnosed: what the recordings add to its inertia becomes armature of the joint (MJCF)
    #[arg(long, value_name = "RIG.toml")]
    pub nominal: Option<PathBuf>,
    /// Write what the format can say and leave the rest out, instead of refusing
    #[arg(long)]
    pub partial: bool,
    /// Write here instead of to standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// A simulator's language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// MuJoCo's XML, version 4.0
    Mjcf,
    /// URDF: joint damping, friction and effort limit
    Urdf,
    /// SDFormat: as URDF
    Sdf,
    /// URDF for Drake, whose joints have damping and no friction
    Drake,
    /// A Python module that steps MuJoCo with what MJCF cannot say
    Python,
}

/// What is to be exported, and where it came from.
pub struct Export<'a> {
    /// The improved rig.
    pub rig: &'a Rig,
    /// Name of its file, without a folder.
    pub source: String,
    /// Its effects.
    pub effects: Vec<FoundEffect>,
    /// The rig that was diagnosed, where it is given.
    pub nominal: Option<Rig>,
    /// The command line.
    pub args: &'a ExportArgs,
}

/// An effect that a format cannot say, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{name}: {reason}")]
pub struct Refused {
    /// The effect.
    pub name: &'static str,
    /// Why.
    pub reason: String,
}

/// A model and what is not in it.
pub struct Exported {
    /// The model's text.
    pub text: String,
    /// What it cannot say.
    pub refused: Vec<Refused>,
    /// What the user has to know.
    pub notes: Vec<String>,
}

/// Runs `palpate export`.
///
/// # Errors
/// As [`export`], and an output that cannot be written.
pub fn run(args: &ExportArgs) -> Result<()> {
    let out = args.out.as_deref().map(|path| ("--out", path));
    let inputs: Vec<&Path> =
        [&args.improved, &args.into].into_iter().chain(&args.nominal).map(PathBuf::as_path).collect();
    output_paths::check(&inputs, out.as_slice())
        .map_err(|_| UsageError::new("--out", "an input of this very run", "another file to write to"))?;
    let exported = export(args)?;
    // To standard error: standard output is for the model.
    exported.notes.iter().for_each(|note| eprintln!("note: {}", printable(note)));
    exported.refused.iter().for_each(|refused| eprintln!("left out: {}", printable(&refused.to_string())));
    match &args.out {
        Some(path) => {
            let mut file = OutFile::create(path)?;
            file.write_all(exported.text.as_bytes()).map_err(|error| file.fault(&error))?;
            Ok(file.commit()?)
        }
        None => Ok(std::io::stdout().write_all(exported.text.as_bytes())?),
    }
}

/// The model of `args` with what was found in it; `args.out` is not used.
///
/// # Errors
/// A file at fault, a joint that the model does not have, an element that it has already, or, unless `args.partial`, an effect that the
/// format cannot say.
pub fn export(args: &ExportArgs) -> Result<Exported, InputError> {
    let rig = Rig::read(&args.improved)?;
    let origin = args.improved.display().to_string();
    let source = args.improved.file_name().map_or_else(|| origin.clone(), |name| name.to_string_lossy().into_owned());
    let effects = found_effect::all(&rig, &origin)?;
    let nominal = args.nominal.as_deref().map(Rig::read).transpose()?;
    let export = Export { rig: &rig, source, effects, nominal, args };
    let model = read_text(&args.into)?;
    let exported = match args.to {
        Target::Mjcf => mjcf::export(&export, &model)?,
        Target::Python => python_stepper::export(&export, &model)?,
        Target::Urdf | Target::Sdf | Target::Drake => description::export(&export, &model)?,
    };
    if args.partial || exported.refused.is_empty() {
        return Ok(exported);
    }
    Err(refusal(&exported, args, &origin))
}

/// All that the format cannot say, as one error.
fn refusal(exported: &Exported, args: &ExportArgs, origin: &str) -> InputError {
    let reasons: Vec<String> =
        exported.refused.iter().map(|refused| format!("{} ({})", refused.name, refused.reason)).collect();
    let expected = match args.to {
        Target::Mjcf => {
            "effects that MJCF can say; --partial leaves these out, and --to python writes them as a stepper where it can"
        }
        _ => "effects that this format can say; --partial leaves these out",
    };
    InputError::new(format!("{origin}: [[effect]]"), reasons.join("; "), expected)
}

fn read_text(path: &Path) -> Result<String, InputError> {
    std::fs::read_to_string(path).map_err(|error| {
        let found = match error.kind() {
            std::io::ErrorKind::NotFound => "no such file".to_owned(),
            std::io::ErrorKind::InvalidData => "bytes that are not UTF-8".to_owned(),
            _ => error.to_string(),
        };
        InputError::new(path.display(), found, "a model that can be read")
    })
}
