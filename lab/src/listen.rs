//! `palpate listen`: what a drive reports, and what it is sent.

mod client;
mod feed;
mod port;
mod record;
mod screen;
mod tare;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use palpate::{BANK_WINDOW, Method};
use palpate_drive::link::{BAUD, Command, Message, RequestOutcome, Source, Streams};
use palpate_drive::{Calibration, Order, Scale, Settings};

pub use client::Client;
pub use feed::inputs;
pub use port::{Port, open};
pub use record::Taken;

use crate::error::UsageError;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::recording::Recording;
use crate::rig::Rig;
use screen::Screen;

/// Show what a drive feels, record it, and send it commands
#[derive(Debug, Clone, Args)]
pub struct ListenArgs {
    /// The serial port of the drive, or the socket of an emulator
    #[arg(long, value_name = "PORT")]
    pub port: PathBuf,
    /// Bits a second
    #[arg(long, value_name = "N", default_value_t = BAUD)]
    pub baud: u32,
    /// Leave after so many seconds; until Ctrl-C where it is left out
    #[arg(long = "for", value_name = "SECONDS", allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// Choose the estimator
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)).map(|name| method(&name)))]
    pub method: Option<Method>,
    /// Choose the window of the block methods, in samples
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=BANK_WINDOW as i64))]
    pub window: Option<u16>,
    /// Choose the cut-off of the filter, 1 to 400 Hz
    #[arg(long, value_name = "HZ")]
    pub velocity_cutoff: Option<f32>,
    /// Choose the forgetting factor of ewrls
    #[arg(long, value_name = "LAMBDA")]
    pub forgetting: Option<f32>,
    /// Choose for how many milliseconds an estimate is held without a good sample
    #[arg(long, value_name = "MS")]
    pub hold: Option<u16>,
    /// Choose after how many milliseconds of silence the drive takes the host for gone; 0: never
    #[arg(long, value_name = "MS")]
    pub link_timeout: Option<u16>,
    /// The force at present is no force: take the zero anew
    #[arg(long)]
    pub tare: bool,
    /// Forget the contact
    #[arg(long)]
    pub reset: bool,
    /// The reset by the watchdog or a crash was seen
    #[arg(long)]
    pub acknowledge: bool,
    /// Print the counters at the end
    #[arg(long)]
    pub counters: bool,
    /// Record every sample; a rig file of the same name, ending in .toml, is written beside it
    #[arg(long, value_name = "TRIAL.csv")]
    pub record: Option<PathBuf>,
    /// Test mode: feed this recording to the drive in place of its sensors
    #[arg(long, value_name = "TRIAL.csv", requires = "rig")]
    pub feed: Option<PathBuf>,
    /// The rig file of the recording that is fed
    #[arg(long, value_name = "RIG.toml")]
    pub rig: Option<PathBuf>,
}

fn method(name: &str) -> Method {
    Method::ALL.into_iter().find(|method| method.name() == name).unwrap_or(Method::Bls)
}

/// Ticks between two estimates on the screen.
const DISPLAY_PERIOD_TICKS: u16 = 50;

/// Runs `palpate listen`.
///
/// # Errors
/// The port or a file cannot be opened, the drive does not answer, or refuses a command.
pub fn run(args: &ListenArgs) -> Result<()> {
    if let Some(record) = args.record.as_ref().filter(|path| path.extension().is_none_or(|end| end != "toml")) {
        let inputs: Vec<&Path> = args.feed.iter().chain(&args.rig).map(PathBuf::as_path).collect();
        let rig = record.with_extension("toml");
        output_paths::check(&inputs, &[("--record", record), ("--record", &rig)])?;
    }
    let files = args.record.as_ref().map(|path| Ok::<_, anyhow::Error>((OutFile::create(path)?, rig_beside(path)?)));
    let files = files.transpose()?;
    let fed = args.feed.as_ref().map(|path| read_fed(path, args)).transpose()?;
    let duration = args.seconds.map(duration).transpose()?;
    let stop = crate::interrupt::flag();
    let mut client = Client::new(open(&args.port, args.baud)?);
    client.wake()?;
    client.quiet()?;
    let about = client.about()?;
    eprintln!("{}", screen::identity(&about));
    let settings = new_settings(&mut client, args, about.settings)?;
    orders(&mut client, args)?;
    let mut session = Session {
        taken: Taken::default(),
        screen: Screen::new(),
        recording: files.is_some(),
        calibration: about.calibration,
    };
    if let (Some((recording, rig)), Some(path)) = (&fed, &args.feed) {
        feed::check_turn(recording, &path.display().to_string(), rig, &about.calibration, &about.scale)?;
    }
    let inputs = fed.as_ref().map(|(recording, rig)| inputs(recording, rig, &about.calibration, &about.scale));
    begin(&mut client, args, inputs.is_some())?;
    let until = duration.and_then(|duration| Instant::now().checked_add(duration));
    let heard = session.listen(&mut client, inputs.unwrap_or_default(), until, &stop);
    let ended = heard.and_then(|()| end(&mut client, args, &mut session));
    let Some((file, rig)) = files else { return ended };
    if ended.is_err() && session.taken.is_empty() {
        return ended;
    }
    // Whatever went wrong on the way: what was recorded until then is kept.
    session.taken.write(file, rig, &about.calibration, &settings)?;
    ended.with_context(|| format!("{} samples are recorded until then", session.taken.len()))
}

/// As long as `seconds`; longer than any clock runs is for ever.
fn duration(seconds: f64) -> Result<Duration, UsageError> {
    if seconds.is_nan() || seconds < 0.0 {
        return Err(UsageError::new("--for", seconds, "seconds, zero or more"));
    }
    Ok(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

fn rig_beside(path: &std::path::Path) -> Result<OutFile> {
    let beside = path.with_extension("toml");
    if beside == path {
        let found = path.display();
        bail!(UsageError::new("--record", found, "a name that does not end in .toml"));
    }
    Ok(OutFile::create(&beside)?)
}

fn read_fed(path: &std::path::Path, args: &ListenArgs) -> Result<(Recording, Rig)> {
    let rig = Rig::read(args.rig.as_deref().context("--feed without --rig")?)?;
    Ok((Recording::read(path, &rig)?, rig))
}

/// Sends the settings where one of them was given; those that hold then.
fn new_settings(client: &mut Client, args: &ListenArgs, before: Settings) -> Result<Settings> {
    let chosen = Settings {
        method: args.method.unwrap_or(before.method),
        window: args.window.unwrap_or(before.window),
        cutoff: args.velocity_cutoff.unwrap_or(before.cutoff),
        forgetting: args.forgetting.unwrap_or(before.forgetting),
        hold: args.hold.unwrap_or(before.hold),
        link_timeout: args.link_timeout.unwrap_or(before.link_timeout),
        ..before
    };
    if chosen != before {
        client.demand(Command::Choose(chosen), "the settings")?;
    }
    Ok(chosen)
}

fn orders(client: &mut Client, args: &ListenArgs) -> Result<()> {
    if args.acknowledge {
        client.demand(Command::Order(Order::Acknowledge), "the acknowledgement")?;
    }
    if args.tare {
        tare::tare(client)?;
    }
    if args.reset {
        client.demand(Command::Order(Order::Restart), "the reset")?;
    }
    Ok(())
}

/// Asks for the streams. A recording begins with an estimator that knows nothing, so that a replay of it can follow.
fn begin(client: &mut Client, args: &ListenArgs, feeding: bool) -> Result<()> {
    if feeding {
        client.demand(Command::Source(Source::Link), "the test mode")?;
    }
    let streams = Streams { estimates: DISPLAY_PERIOD_TICKS, samples: args.record.is_some() };
    client.demand(Command::Stream(streams), "the streams")?;
    // Another source is another beginning already.
    if args.record.is_some() && !feeding {
        client.demand(Command::Order(Order::Restart), "the reset")?;
    }
    Ok(())
}

fn end(client: &mut Client, args: &ListenArgs, session: &mut Session) -> Result<()> {
    session.screen.clear();
    client.quiet()?;
    if args.feed.is_some() {
        client.demand(Command::Source(Source::Sensors), "the end of the test mode")?;
    }
    if args.counters {
        print!("{}", screen::counters(&client.counters()?));
    }
    Ok(())
}

struct Session {
    taken: Taken,
    screen: Screen,
    recording: bool,
    calibration: Calibration,
}

impl Session {
    /// Until the time is over, Ctrl-C, or all that was to be fed has come back.
    fn listen(
        &mut self,
        client: &mut Client,
        inputs: Vec<palpate_drive::Input>,
        until: Option<Instant>,
        stop: &AtomicBool,
    ) -> Result<()> {
        let feeding = !inputs.is_empty();
        let (mut waiting, mut alive) = (inputs.as_slice(), Instant::now());
        let mut quiet_since = Instant::now();
        while !stop.load(Ordering::Relaxed) && until.is_none_or(|until| Instant::now() < until) {
            let mut has_data = false;
            let mut take = |message: Message<'_>| {
                has_data |= matches!(message, Message::Sample(_) | Message::Estimate(_));
                self.take(&message);
            };
            if !waiting.is_empty() {
                waiting = client.feed(waiting, &mut take)?;
            } else {
                client.poll(&mut take)?;
            }
            if has_data || !waiting.is_empty() {
                quiet_since = Instant::now();
            } else if feeding && quiet_since.elapsed() > Duration::from_millis(500) {
                break;
            }
            // The drive may be waiting for a sign of life.
            if alive.elapsed() > Duration::from_millis(200) {
                alive = Instant::now();
                client.send(Command::Alive)?;
            }
        }
        Ok(())
    }

    fn take(&mut self, message: &Message<'_>) {
        match message {
            Message::Estimate(estimate) => self.screen.show(estimate, &self.calibration),
            Message::Sample(seen) if self.recording => self.taken.take(seen),
            _ => {}
        }
    }
}

/// What a drive is and how it is set.
#[derive(Debug, Clone)]
pub struct DriveInfo {
    /// Version of its sources.
    pub version: String,
    /// CRC-32 of its image.
    pub image: u32,
    /// The chip's own number.
    pub chip: [u32; 3],
    /// It is QEMU.
    pub emulator: bool,
    /// Bits 24 to 31 of RCC_CSR at its start.
    pub reset: u8,
    /// What was found wrong at its start.
    pub found: palpate_drive::Faults,
    /// Its calibration.
    pub calibration: Calibration,
    /// Its scale at present.
    pub scale: Scale,
    /// Its settings.
    pub settings: Settings,
    /// Their number.
    pub revision: u8,
}

/// An answer in words.
#[must_use]
pub fn in_words(outcome: RequestOutcome) -> &'static str {
    match outcome {
        RequestOutcome::Done => "done",
        RequestOutcome::OutOfRange => "a value is out of its range",
        RequestOutcome::NoRoom => "the drive has no room at present",
        RequestOutcome::NotNow => "the drive takes it in test mode alone",
    }
}
