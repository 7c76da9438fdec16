//! The command line of `palpate diagnose-joints`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;

use super::{DiagnosedJoint, Joint, diagnose, json, page};
use crate::error::{InputError, UsageError};
use crate::outfile::OutFile;
use crate::output_paths;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::terminal::printable;

/// Diagnose each joint of an arm, in one report
#[derive(Debug, Clone, Args)]
pub struct DiagnoseJointsArgs {
    /// A joint and its rig file, whose `[columns]` name what of the recordings is this joint's
    #[arg(long = "joint", required = true, value_name = "NAME=RIG.toml", value_parser = joint_argument)]
    pub joints: Vec<(String, PathBuf)>,
    /// Recordings of the arm, one file a trial
    #[arg(required = true, value_name = "TRIAL.csv")]
    pub trials: Vec<PathBuf>,
    /// What your own simulator gave for each trial, in the same order, in the columns of a recording
    #[arg(long, value_name = "SIM.csv", num_args = 1..)]
    pub simulation: Vec<PathBuf>,
    /// Write the diagnoses as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the report, one self-contained page
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write each joint's improved rig file into this folder, under the joint's name
    #[arg(long, value_name = "DIR")]
    pub models: Option<PathBuf>,
    /// Seed, as of `palpate diagnose`
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

fn joint_argument(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, rig)) if !name.is_empty() && !rig.is_empty() => Ok((name.to_owned(), PathBuf::from(rig))),
        _ => Err("a joint's name and its rig file are expected, as in elbow=elbow.toml".to_owned()),
    }
}

/// Runs `palpate diagnose-joints`.
///
/// # Errors
/// A joint given twice, a rig file or recording at fault, or an output that cannot be written.
pub fn run(args: &DiagnoseJointsArgs) -> Result<()> {
    check(args)?;
    let arm: Vec<Joint> = args.joints.iter().map(|(name, rig)| joint(args, name, rig)).collect::<Result<_>>()?;
    let to_standard = args.json.as_deref().is_some_and(|path| path.as_os_str() == "-");
    let open = |path: &Option<PathBuf>| {
        path.as_deref().filter(|path| path.as_os_str() != "-").map(OutFile::create).transpose()
    };
    // Opened before the work: a place that cannot be written is reported at once.
    let (json_file, report) = (open(&args.json)?, open(&args.report)?);
    let diagnosed = diagnose(&arm, args.seed, &|step| eprintln!("{}", printable(step)))?;
    let text = json(&diagnosed)?;
    if let Some(file) = json_file {
        commit(file, text.as_bytes())?;
    }
    if let Some(file) = report {
        commit(file, page(&diagnosed)?.as_bytes())?;
    }
    if let Some(folder) = &args.models {
        write_models(folder, &diagnosed)?;
    }
    if to_standard {
        std::io::stdout().write_all(text.as_bytes())?;
    } else {
        std::io::stdout().write_all(printable(&console_text(&diagnosed)).as_bytes())?;
    }
    Ok(())
}

fn joint(args: &DiagnoseJointsArgs, name: &str, path: &Path) -> Result<Joint> {
    let rig = Rig::read(path)?;
    let read = |paths: &[PathBuf]| paths.iter().map(|path| Recording::read(path, &rig)).collect::<Result<Vec<_>, _>>();
    let (trials, simulation) = (read(&args.trials)?, read(&args.simulation)?);
    Ok(Joint { name: name.to_owned(), origin: path.display().to_string(), rig, trials, simulation })
}

fn check(args: &DiagnoseJointsArgs) -> Result<()> {
    if !args.simulation.is_empty() && args.simulation.len() != args.trials.len() {
        let expected = format!("one a trial, {} in all", args.trials.len());
        bail!(UsageError::new("--simulation", format!("{} files", args.simulation.len()), expected));
    }
    for (at, (name, _)) in args.joints.iter().enumerate() {
        if args.joints[..at].iter().any(|(earlier, _)| earlier == name) {
            bail!(UsageError::new("--joint", format!("{name} twice"), "each joint once"));
        }
        // It becomes the name of a file.
        if args.models.is_some() && name.contains(['/', '\\']) {
            bail!(UsageError::new("--joint", name, "a name without slashes, where --models makes a file of it"));
        }
    }
    let models: Vec<PathBuf> =
        args.joints.iter().filter_map(|(name, _)| Some(model_path(args.models.as_ref()?, name))).collect();
    let inputs = args.joints.iter().map(|(_, rig)| rig).chain(&args.trials).chain(&args.simulation);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    let single = [("--json", args.json.as_deref()), ("--report", args.report.as_deref())];
    let mut outputs: Vec<(&str, &Path)> =
        single.into_iter().filter_map(|(option, path)| Some((option, path?))).collect();
    outputs.extend(models.iter().map(|path| ("--models", path.as_path())));
    output_paths::check(&inputs, &outputs)
}

fn model_path(folder: &Path, joint: &str) -> PathBuf {
    folder.join(format!("{joint}.toml"))
}

fn write_models(folder: &Path, diagnosed: &[DiagnosedJoint]) -> Result<()> {
    std::fs::create_dir_all(folder)
        .map_err(|error| InputError::new(folder.display(), error, "a folder that can be written"))?;
    diagnosed.iter().try_for_each(|joint| Ok(joint.found.improved.write(&model_path(folder, &joint.name))?))
}

fn commit(mut file: OutFile, bytes: &[u8]) -> Result<()> {
    file.write_all(bytes).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

/// A line a joint.
fn console_text(diagnosed: &[DiagnosedJoint]) -> String {
    let line = |joint: &DiagnosedJoint| format!("joint {}: {}\n", joint.name, joint.found.answer.summary);
    diagnosed.iter().map(line).collect()
}
