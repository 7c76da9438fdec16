//! The command line of `palpate`.

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

use crate::calibrate::{self, CalibrateArgs};
use crate::catalogue::{self, EffectsArgs};
use crate::challenge::{self, ChallengeArgs};
use crate::completions::{self, CompletionsArgs};
use crate::diagnose::{self, DiagnoseArgs};
use crate::error::UsageError;
use crate::export::{self, ExportArgs};
use crate::fleet::{self, DiagnoseAllArgs};
use crate::interrupt;
use crate::investigate::trial_of_method::{self, InvestigateChallengeArgs};
use crate::investigate::{self, InvestigateArgs};
use crate::joints::{self, DiagnoseJointsArgs};
use crate::listen::{self, ListenArgs};
use crate::look::{self, LookArgs};
use crate::profile::{self, ProfileArgs};
use crate::replay::{self, ReplayArgs};
use crate::reproduce::{self, ReproduceArgs};
use crate::schema::{self, SchemaArgs};
use crate::simulate::{self, SimulateArgs};
use crate::terminal;
use crate::threshold_sweep::{self, SweepThresholdsArgs};

/// Stiffness and damping of what a tool touches: identified from recordings, on the host or on the drive's processor.
#[derive(Debug, Parser)]
#[command(name = "palpate", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Find where simulation and recordings differ, and which physics is missing
    Diagnose(DiagnoseArgs),
    /// Diagnose many rigs into one table, and show which stand out and what changed
    DiagnoseAll(DiagnoseAllArgs),
    /// Diagnose each joint of an arm, in one report
    DiagnoseJoints(DiagnoseJointsArgs),
    /// List what a recording holds: columns or topics, rates, ranges and gaps
    Look(LookArgs),
    /// Diagnose, design the next trial, run it, and diagnose again
    Investigate(InvestigateArgs),
    /// Investigate rigs whose missing physics is concealed, against fixed rich recordings of equal length
    InvestigateChallenge(InvestigateChallengeArgs),
    /// Write the physics that was found into your own simulation model
    Export(ExportArgs),
    /// Run recordings through the estimators
    Replay(ReplayArgs),
    /// Make a recording from a rig file
    Simulate(SimulateArgs),
    /// Reproduce the paper's study, and show what does better
    Reproduce(ReproduceArgs),
    /// Count what each estimator costs on the device
    Profile(ProfileArgs),
    /// Put the diagnosis to recordings whose missing physics is concealed from it
    Challenge(ChallengeArgs),
    /// Vary each threshold of the diagnosis by 30 % and count the answers that change
    SweepThresholds(SweepThresholdsArgs),
    /// Show what a drive feels, record it, and send it commands
    Listen(ListenArgs),
    /// Make the calibration block that a drive reads from its flash
    Calibrate(CalibrateArgs),
    /// List the physics that it knows beyond spring and damper
    Effects(EffectsArgs),
    /// Write the JSON schema of a report
    Schema(SchemaArgs),
    /// Write completions for a shell
    Completions(CompletionsArgs),
}

/// Runs the command line; 0 done, 1 the input or a file is at fault, 2 the command line is.
#[must_use]
pub fn run() -> ExitCode {
    // Without a handler a signal ends the process as everywhere: only temporary files would stay.
    if let Err(error) = interrupt::take_over() {
        eprintln!("note: {error}");
    }
    ExitCode::from(run_with(std::env::args_os()))
}

/// Runs the command line `arguments`, the program's name first; its exit status.
#[must_use]
pub fn run_with(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let parsed = match Cli::try_parse_from(arguments) {
        Ok(parsed) => parsed,
        Err(error) => {
            // Help on standard output, faults on standard error; to a closed one nothing can be written.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let done = match parsed.command {
        Command::Diagnose(args) => diagnose::run(&args),
        Command::DiagnoseAll(args) => fleet::run(&args),
        Command::DiagnoseJoints(args) => joints::run(&args),
        Command::Look(args) => look::run(&args),
        Command::Investigate(args) => investigate::run(&args),
        Command::InvestigateChallenge(args) => trial_of_method::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Simulate(args) => simulate::run(args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Profile(args) => profile::run(&args),
        Command::Challenge(args) => challenge::run(&args),
        Command::SweepThresholds(args) => threshold_sweep::run(&args),
        Command::Listen(args) => listen::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Effects(args) => catalogue::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Completions(args) => completions::run(&args, Cli::command()),
    };
    match done {
        Ok(()) => 0,
        Err(error) => {
            eprintln!("palpate: {}", terminal::printable(&format!("{error:#}")));
            if error.is::<UsageError>() { 2 } else { 1 }
        }
    }
}
