//! `palpate replay`: recordings through the estimators, on the host or on the device.

mod estimates;
mod options;
mod outputs;
mod plan;
mod table;
mod trace;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use palpate::{EstimatorBank, EstimatorBankConfig, Sample};
use palpate_drive::replay_format::UpdateResult;

use crate::error::InputError;
use crate::qemu_bench::QemuBench;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::terminal::printable;
use crate::tools::Leave;
pub use options::{LossChoice, Options, VelocityChoice};
pub use outputs::{Outputs, REPLAY_PAGE};
pub use plan::Plan;
pub use table::interval;
pub use trace::Trace;

/// Arguments of `palpate replay`.
#[derive(Debug, Clone, Args)]
pub struct ReplayArgs {
    /// The rig file: surface, nominal values, sensors
    #[arg(long, value_name = "RIG.toml")]
    pub rig: PathBuf,
    /// Recordings, one file a trial
    #[arg(required = true, value_name = "TRIAL.csv")]
    pub trials: Vec<PathBuf>,
    /// Where the estimators run; both give the same file to the bit
    #[arg(long, value_enum, default_value_t)]
    pub on: Place,
    /// The estimators' settings.
    #[command(flatten)]
    pub options: Options,
    /// Folder for estimates.csv and replay.html (with several trials, estimates.csv goes to a folder for each)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Where the estimators run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Place {
    /// On this machine.
    #[default]
    Host,
    /// On the drive's processor, emulated by QEMU.
    Qemu,
}

/// A trial with what the estimators made of it.
pub struct Replayed {
    /// Name and time of what was measured; depth and force as they were fed are in the plan.
    pub recording: Recording,
    /// How it was fed to the estimators.
    pub plan: Plan,
    /// What they returned.
    pub trace: Trace,
}

impl Replayed {
    /// What a reader should know, of the settings first and then of the run.
    #[must_use]
    pub fn notices(&self) -> Vec<String> {
        self.plan.notices.iter().cloned().chain(self.trace.notices(&self.plan)).collect()
    }
}

/// Runs the command.
///
/// # Errors
/// A file or the command line is at fault, or the device fails.
pub fn run(args: &ReplayArgs) -> Result<()> {
    let rig = Rig::read(&args.rig)?;
    let outputs = args.out.as_deref().map(|folder| Outputs::open(folder, &args.rig, &args.trials)).transpose()?;
    let recordings = args.trials.iter().map(|path| Recording::read(path, &rig));
    let recordings = recordings.collect::<Result<Vec<_>, InputError>>()?;
    let runner = Runner::prepare(args.on)?;
    let mut replayed = Vec::with_capacity(recordings.len());
    for recording in recordings {
        replayed.push(replay(&runner, &rig, &args.rig, recording, &args.options)?);
    }
    for one in &replayed {
        one.notices()
            .iter()
            .for_each(|notice| eprintln!("{}", printable(&format!("{}: {notice}", one.recording.name))));
    }
    table::print(&rig, &replayed)?;
    if let Some(outputs) = outputs {
        for path in outputs.write(&rig, replayed, &args.options, args.on)? {
            eprintln!("wrote {}", printable(&path.display().to_string()));
        }
    }
    Ok(())
}

/// One recording through the estimators.
///
/// # Errors
/// The rig or the recording lacks what the estimators need, a setting is out of range, or the device fails.
pub fn replay(
    runner: &Runner,
    rig: &Rig,
    rig_path: &Path,
    recording: Recording,
    options: &Options,
) -> Result<Replayed> {
    let plan = Plan::new(rig, rig_path, &recording, options)?;
    let mut trace = Trace::new(&plan.methods, plan.samples.len());
    let bar = progress(&recording.name, plan.samples.len());
    runner.run(&plan.config, &plan.samples, |done| bar.set_position(done), |outcome| trace.take(outcome))?;
    bar.finish_and_clear();
    // Depth and force are in the plan; the other columns of a long recording would only take room.
    let recording = Recording { name: recording.name, time: recording.time, ..Recording::default() };
    Ok(Replayed { recording, plan, trace })
}

/// Runs a bench at its place.
pub enum Runner {
    /// Here.
    Host,
    /// Under QEMU.
    QemuBench(QemuBench),
}

impl Runner {
    /// Samples between two words of progress.
    const BLOCK: usize = 4096;

    /// Sets up what the place needs.
    ///
    /// # Errors
    /// A tool is missing or the image does not build.
    pub fn prepare(place: Place) -> Result<Self> {
        Ok(match place {
            Place::Host => Self::Host,
            Place::Qemu => Self::QemuBench(QemuBench::prepare(Leave::Install)?),
        })
    }

    /// Hands the outcome of each sample to `take`, in order; `progress` receives from time to time how many are done.
    ///
    /// # Errors
    /// The settings are out of range, or the device fails.
    pub fn run(
        &self,
        config: &EstimatorBankConfig,
        samples: &[Sample],
        progress: impl Fn(u64),
        mut take: impl FnMut(UpdateResult),
    ) -> Result<()> {
        match self {
            Self::Host => {
                let mut bench = EstimatorBank::new(config)?;
                for (done, block) in samples.chunks(Self::BLOCK).enumerate() {
                    progress((done * Self::BLOCK) as u64);
                    block.iter().for_each(|&sample| take(bench.update(sample)));
                }
            }
            Self::QemuBench(device) => {
                device.run(config, samples, progress, take)?;
            }
        }
        Ok(())
    }
}

/// A bar on standard error where that is a terminal, and nothing else.
fn progress(name: &str, samples: usize) -> ProgressBar {
    let bar = ProgressBar::new(samples as u64);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {human_pos}/{human_len} samples, {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(name.to_owned());
    bar
}
