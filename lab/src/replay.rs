//! `palpate replay`: recordings through the estimators, on the host or on the device.

mod estimates;
mod settings;
mod trace;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use palpate::exchange::Outcome;
use palpate::{Bench, BenchConfig, Sample};

use crate::device::Device;
use crate::error::InputError;
use crate::outfile::OutFile;
use crate::page::{Page, Trial, Units};
use crate::recording::Recording;
use crate::rig::{Coordinate, Rig};
use crate::tools::Leave;
pub use settings::{Options, Plan};
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
    /// What was measured.
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
    let outputs = args.out.as_deref().map(|folder| Outputs::open(folder, &args.trials)).transpose()?;
    let recordings = args.trials.iter().map(|path| Recording::read(path, &rig));
    let recordings = recordings.collect::<Result<Vec<_>, InputError>>()?;
    let runner = Runner::prepare(args.on)?;
    let mut replayed = Vec::with_capacity(recordings.len());
    for recording in recordings {
        replayed.push(replay(&runner, &rig, &args.rig, recording, &args.options)?);
    }
    for one in &replayed {
        one.notices().iter().for_each(|notice| eprintln!("{}: {notice}", one.recording.name));
    }
    print_table(&rig, &replayed)?;
    if let (Some(outputs), Some(folder)) = (outputs, &args.out) {
        outputs.write(&rig, &replayed, &args.options, args.on)?;
        println!("{}", folder.join("replay.html").display());
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
    runner.run(&plan.config, &plan.samples, |outcome| {
        trace.take(outcome);
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    Ok(Replayed { recording, plan, trace })
}

/// Runs a bench at its place.
pub enum Runner {
    /// Here.
    Host,
    /// Under QEMU.
    Device(Device),
}

impl Runner {
    /// Sets up what the place needs.
    ///
    /// # Errors
    /// A tool is missing or the image does not build.
    pub fn prepare(place: Place) -> Result<Self> {
        Ok(match place {
            Place::Host => Self::Host,
            Place::Qemu => Self::Device(Device::prepare(Leave::Install)?),
        })
    }

    /// Hands the outcome of each sample to `take`, in order.
    ///
    /// # Errors
    /// The settings are out of range, or the device fails.
    pub fn run(&self, config: &BenchConfig, samples: &[Sample], mut take: impl FnMut(Outcome)) -> Result<()> {
        match self {
            Self::Host => {
                let mut bench = Bench::new(config)?;
                samples.iter().for_each(|&sample| take(bench.update(sample)));
            }
            Self::Device(device) => {
                device.run(config, samples, take)?;
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

/// The output files, opened before the work so that a place that cannot be written shows at once.
pub struct Outputs {
    estimates: Vec<OutFile>,
    page: OutFile,
}

impl Outputs {
    /// Makes the folders and opens the files: `estimates.csv` in `folder` itself for one trial, in a folder each for
    /// several, and `replay.html`.
    ///
    /// # Errors
    /// The place cannot be written.
    pub fn open(folder: &Path, trials: &[PathBuf]) -> Result<Self> {
        let make = |folder: &Path| {
            let what = || InputError::new(folder.display(), "a folder that cannot be made", "a writable place");
            std::fs::create_dir_all(folder).with_context(what)
        };
        make(folder)?;
        let mut estimates = Vec::new();
        for (k, trial) in trials.iter().enumerate() {
            let place = match trials.len() {
                1 => folder.to_path_buf(),
                // The number keeps trials of one name in different folders apart.
                _ => folder.join(format!("{:02}-{}", k + 1, trial.file_stem().unwrap_or_default().display())),
            };
            make(&place)?;
            estimates.push(OutFile::create(&place.join("estimates.csv"))?);
        }
        Ok(Self { estimates, page: OutFile::create(&folder.join("replay.html"))? })
    }

    /// Writes what was replayed, whole or not at all.
    ///
    /// # Errors
    /// The place cannot be written any more.
    pub fn write(mut self, rig: &Rig, replayed: &[Replayed], options: &Options, place: Place) -> Result<()> {
        for (file, replayed) in self.estimates.into_iter().zip(replayed) {
            estimates::write(file, rig.coordinate, replayed)?;
        }
        page(rig, replayed, options, place).write(&mut self.page).map_err(|error| self.page.fault(&error))?;
        Ok(self.page.commit()?)
    }
}

fn page(rig: &Rig, replayed: &[Replayed], options: &Options, place: Place) -> Page {
    let (stiffness, damping) = rig.contact.map_or((f64::NAN, f64::NAN), |c| (c.stiffness, c.damping));
    Page {
        rig: rig.name.clone(),
        ran_on: match place {
            Place::Host => "host".to_owned(),
            Place::Qemu => "Cortex-M4F under QEMU".to_owned(),
        },
        settings: options.in_words(),
        trials: replayed
            .iter()
            .map(|r| Trial {
                name: r.recording.name.clone(),
                units: units(rig.coordinate),
                nominal_stiffness: stiffness,
                nominal_damping: damping,
                time: r.recording.time.clone(),
                penetration: r.plan.samples.iter().map(|sample| sample.position).collect(),
                force: r.plan.samples.iter().map(|sample| sample.force).collect(),
                contact: r.trace.contact(),
                methods: r.trace.methods(&r.plan.samples),
                notices: r.notices(),
            })
            .collect(),
    }
}

fn units(coordinate: Coordinate) -> Units {
    Units {
        position: coordinate.position_unit(),
        force: coordinate.force_unit(),
        stiffness: coordinate.stiffness_unit(),
        damping: coordinate.damping_unit(),
    }
}

/// The figures on standard output: one line a trial and method.
fn print_table(rig: &Rig, replayed: &[Replayed]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    let (k, b) = (rig.coordinate.stiffness_unit(), rig.coordinate.damping_unit());
    writeln!(
        out,
        "{:<28} {:<12} {:>24} {:>24} {:>8}",
        "trial",
        "method",
        format!("K [{k}]"),
        format!("B [{b}]"),
        "RMSE %"
    )?;
    for r in replayed {
        for method in r.trace.methods(&r.plan.samples) {
            let name = format!("{:<28} {:<12}", r.recording.name, method.name);
            match method.summary {
                None => writeln!(out, "{name} never known: no contact, or no movement in it")?,
                Some(s) => {
                    let k = interval(s.stiffness, s.stiffness_half_width);
                    let b = interval(s.damping, s.damping_half_width);
                    writeln!(out, "{name} {k:>24} {b:>24} {:>8.2}", s.rmse_percent)?;
                }
            }
        }
    }
    Ok(())
}

/// A value with the half-width of its interval.
#[must_use]
pub fn interval(value: f64, half_width: f64) -> String {
    format!("{:.4} ± {:.2}", Short(value), Short(half_width))
}

/// A number in as many significant digits as the precision asks for, with an exponent where it is very small or large.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(4).max(1);
        let magnitude = if self.0 == 0.0 { 0 } else { self.0.abs().log10().floor() as i32 };
        if !self.0.is_finite() || !(-3..6).contains(&magnitude) {
            return write!(f, "{:.*e}", digits - 1, self.0);
        }
        let decimals = usize::try_from(digits as i32 - 1 - magnitude).unwrap_or(0);
        write!(f, "{:.*}", decimals, self.0)
    }
}
