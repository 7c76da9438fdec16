//! A drive in QEMU, a recording to feed it, and the host's own run of the same.

use std::sync::OnceLock;

use palpate_drive::link::{Command, EstimateMessage, Message, SampleMessage, Source, Streams};
use palpate_drive::{Bounds, Calibration, Counters, Cycle, Estimator, Faults, Input, InputStatus, Settings};
use palpate_lab::listen::{Client, inputs};
use palpate_lab::qemu_bench::project;
use palpate_lab::qemu_drive::{ClockMode, DriveImage, QemuDrive};
use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;
use palpate_lab::simulate;
use palpate_lab::tools::{Leave, MissingTools};

/// The image, built once; `None` with a word where its tools are absent.
pub fn image() -> Option<&'static DriveImage> {
    static IMAGE: OnceLock<Option<DriveImage>> = OnceLock::new();
    let prepare = || match DriveImage::prepare(Leave::Look) {
        Ok(image) => Some(image),
        Err(error) if error.is::<MissingTools>() && std::env::var_os("PALPATE_DEVICE").is_none() => {
            eprintln!("left out: {error}");
            None
        }
        Err(error) => panic!("{error:#}"),
    };
    IMAGE.get_or_init(prepare).as_ref()
}

/// A drive that has come up, and a client on its line.
pub fn drive(image: &DriveImage, calibration: Option<&[u8]>) -> (QemuDrive, Client) {
    let drive = image.start(ClockMode::Exact, calibration, &[]).unwrap_or_else(|error| panic!("{error:#}"));
    let client = drive.client().unwrap_or_else(|error| panic!("{error:#}"));
    (drive, client)
}

/// The rig of the bench, and a trial of `seconds` on it.
pub fn bench(seconds: f64) -> (Rig, Recording) {
    let mut rig = Rig::read(&project().expect("sources").join("lab/rigs/bench.toml")).expect("a rig");
    rig.simulation.duration_s = seconds;
    // Contact from the first second on, again and again.
    if let Some(reference) = &mut rig.reference {
        (reference.period_s, reference.contact_s) = (5.0, 3.5);
    }
    let recording = simulate::simulate(&rig, 5, "bench.toml").expect("a trial").recording;
    (rig, recording)
}

/// The trial as the sensors' words.
pub fn words(seconds: f64) -> Vec<Input> {
    let (rig, recording) = bench(seconds);
    inputs(&recording, &rig, &Calibration::DEFAULT, &Calibration::DEFAULT.scale())
}

/// Ticks of the drive within which all that is fed has to come back.
const MAX_TICKS: u32 = 1_000_000;

/// What came back for what was fed, in order.
pub struct Heard {
    pub seen: Vec<SampleMessage>,
    pub told: Vec<EstimateMessage>,
}

/// Feeds `words` to an estimator that begins with them, with every sample and estimate told, and waits until all are back.
pub fn feed(client: &mut Client, words: &[Input]) -> Heard {
    client.demand(Command::Source(Source::Link), "the test mode").unwrap_or_else(|error| panic!("{error:#}"));
    let streams = Streams { estimates: 1, samples: true };
    client.demand(Command::Stream(streams), "the streams").unwrap_or_else(|error| panic!("{error:#}"));
    let mut heard = Heard { seen: Vec::new(), told: Vec::new() };
    let mut rest = words;
    let start = client.ticks(|_| ()).unwrap_or_else(|error| panic!("{error:#}"));
    while heard.told.len() < words.len() {
        let before = heard.told.len();
        let mut take = |message: Message<'_>| match message {
            // The last ticks of the sensors may still be on their way.
            Message::Sample(seen) if heard.seen.is_empty() && seen.input != words[0] => {}
            Message::Sample(seen) => heard.seen.push(seen),
            Message::Estimate(told) if !heard.seen.is_empty() => heard.told.push(told),
            _ => {}
        };
        let done = if rest.is_empty() {
            client.ticks(&mut take).map(|now| {
                let ticks = now.wrapping_sub(start);
                assert!(ticks < MAX_TICKS, "{before} of {} came back within {ticks} ticks", words.len());
            })
        } else {
            client.feed(rest, &mut take).map(|later| rest = later)
        };
        done.unwrap_or_else(|error| panic!("after {before} of {}: {error:#}", words.len()));
    }
    heard
}

/// What the host makes of `words`, after as many ticks of lines that hang low as a drive without sensors had before them.
pub fn host(settings: Settings, revision: u8, first: u32, words: &[Input]) -> Vec<(SampleMessage, EstimateMessage)> {
    let (calibration, found) = (Calibration::DEFAULT, Faults::CALIBRATION);
    let counters = Counters::new();
    let mut estimator = Estimator::new(&settings, &calibration, revision).expect("sound settings");
    let mut cycle = Cycle::new(calibration, &mut estimator, &counters, Bounds::NO_EFFORT, found);
    (1..first).for_each(|_| {
        cycle.tick(Input { status: InputStatus::empty(), ..Input::NOTHING });
    });
    let reports = words.iter().map(|&word| cycle.tick(word));
    reports.map(|report| (SampleMessage::of(&report), EstimateMessage::of(&report))).collect()
}
