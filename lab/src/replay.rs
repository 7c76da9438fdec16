//! `palpate replay`: recordings through the estimators, on the host or on the device.

mod estimates;
mod median;
mod options;
mod outputs;
mod plan;
mod run;
mod table;
mod tally;

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use palpate::Method;

use crate::error::InputError;
use crate::outfile::OutFile;
use crate::page::{self, Drawing, Drawn, Row, Summary};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::terminal::printable;
use estimates::EstimatesFile;
pub use options::{LossChoice, Options, VelocityChoice};
pub use outputs::{Outputs, REPLAY_PAGE, Sink};
pub use plan::Plan;
pub use run::{Run, Runner, Step};
pub use table::interval;
pub use tally::Tally;

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

/// What the estimators made of a trial.
pub struct Replayed {
    /// The trial's name.
    pub name: String,
    /// What a reader should know, of the settings first and then of the run.
    pub notices: Vec<String>,
    /// The figures of each method, in the order asked for; `None` where no interval was finite in contact.
    pub summaries: Vec<(Method, Option<Summary>)>,
    /// What it leaves behind, where it was asked to.
    pub written: Option<Written>,
}

/// What a replay leaves behind.
pub struct Written {
    /// `estimates.csv`, whole and not yet in its place.
    pub file: OutFile,
    /// What the page draws.
    pub drawn: Drawn,
}

/// Runs the command.
///
/// # Errors
/// A file or the command line is at fault, or the device fails.
pub fn run(args: &ReplayArgs) -> Result<()> {
    let rig = Rig::read(&args.rig)?;
    let mut outputs = args.out.as_deref().map(|folder| Outputs::open(folder, &args.rig, &args.trials)).transpose()?;
    let recordings = args.trials.iter().map(|path| Recording::read_contact(path, &rig));
    let recordings = recordings.collect::<Result<Vec<_>, InputError>>()?;
    let runner = Runner::prepare(args.on)?;
    let mut sinks = outputs.as_mut().map(|outputs| outputs.sinks(rig.coordinate)).unwrap_or_default().into_iter();
    let mut replayed = Vec::with_capacity(recordings.len());
    for recording in recordings {
        let plan = Plan::new(&rig, &args.rig, &recording, &args.options)?;
        replayed.push(replay(&runner, &plan, &recording, sinks.next())?);
    }
    for one in &replayed {
        one.notices.iter().for_each(|notice| eprintln!("{}", printable(&format!("{}: {notice}", one.name))));
    }
    table::print(&rig, &replayed)?;
    if let Some(outputs) = outputs {
        for path in outputs.write(&rig, replayed, &args.options, args.on)? {
            eprintln!("wrote {}", printable(&path.display().to_string()));
        }
    }
    Ok(())
}

/// One recording through the estimators, as `plan` says; where there is a `sink`, its `estimates.csv` is written meanwhile.
///
/// # Errors
/// The device fails, or the file cannot be written any more.
pub fn replay(runner: &Runner, plan: &Plan, recording: &Recording, sink: Option<Sink>) -> Result<Replayed> {
    let rows = plan.samples(recording).len();
    let bar = progress(&recording.name, rows);
    let progress = |done| bar.set_position(done);
    let run = runner.start(plan, recording, progress)?;
    let drawing = sink.as_ref().map(|sink| Drawing::new(rows, plan.methods.len(), sink.page_rows(plan)));
    let mut watch = Watch { tally: Tally::new(&plan.methods), drawing, drawn: Vec::new() };
    let mut file = sink.map(|sink| EstimatesFile::begin(sink.file, sink.coordinate, &plan.methods)).transpose()?;
    run.pass(progress, |step| {
        watch.take(step);
        Ok(file.as_mut().map_or(Ok(()), |file| file.take(step))?)
    })?;
    let file = file.map(EstimatesFile::finish).transpose()?;
    while !watch.end_of_pass() {
        run.pass(progress, |step| {
            watch.take(step);
            Ok(())
        })?;
    }
    bar.finish_and_clear();
    let on_force = plan.config.stream.front_end.contact_detector.on_force;
    Ok(Replayed {
        name: recording.name.clone(),
        notices: plan.notices.iter().cloned().chain(watch.tally.notices(on_force)).collect(),
        summaries: watch.tally.summaries(),
        written: file.zip(watch.drawing).map(|(file, drawing)| Written { file, drawn: drawing.finish() }),
    })
}

/// What is had of the rows while they pass by, in as many passes as it takes.
struct Watch {
    tally: Tally,
    drawing: Option<Drawing>,
    /// Of one row.
    drawn: Vec<[f32; page::ESTIMATE_COLUMNS]>,
}

impl Watch {
    fn take(&mut self, step: &Step<'_>) {
        self.tally.take(step);
        if let Some(drawing) = &mut self.drawing {
            self.drawn.clear();
            self.drawn.extend(step.estimates.iter().map(run::drawn));
            let (penetration, force) = (step.sample.position, step.sample.force);
            let contact = step.contact();
            drawing.take(Row { time: step.time, penetration, force, contact, estimates: &self.drawn });
        }
    }

    /// Whether all is had.
    fn end_of_pass(&mut self) -> bool {
        let is_drawn = self.drawing.as_mut().is_none_or(Drawing::end_of_pass);
        self.tally.end_of_pass() && is_drawn
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
