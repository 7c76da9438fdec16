//! What a tick of the drive's interrupt costs, by the plugin, from the vector to the return.

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Context as _, Result, ensure};
use palpate::Method;
use palpate_drive::link::{Command, Message, Source, Streams};
use palpate_drive::{Calibration, Input, Settings};

use super::counts::{Pass, read_plugin};
use super::emulator::{counter, table};
use super::image::Image;
use crate::listen::{Client, inputs};
use crate::qemu_bench;
use crate::qemu_drive::{ClockMode, DriveImage, QemuDrive};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::simulate;
use crate::tools::Leave;

/// Ticks that a drive without sensors is counted for, by its own counter: a busy host makes fewer of them in a second.
const IDLE_TICKS: u32 = 2_500;

/// Ticks within which all that is fed has to come back: a thousand seconds of the drive's own time for a few seconds of samples.
const MAX_TICKS: u32 = 1_000_000;

/// What ticks cost.
#[derive(Debug, Clone)]
pub struct InterruptCost {
    /// What went on.
    pub what: String,
    /// Ticks that were counted.
    pub ticks: usize,
    /// Instructions of the longest, without those of the serial line's interrupt: QEMU hands its bytes over faster than any line
    /// could, and how many come within a tick depends on the host.
    pub most: u32,
    /// Its modelled cycles, least and most.
    pub cycles: [u32; 2],
    /// Instructions of the median tick of those that took a sample; `None` where no samples were fed.
    pub median_live: Option<u32>,
}

/// Counts the ticks of a drive without sensors and of one that is fed a contact with losses and onsets, and with every
/// fourth word upset.
///
/// # Errors
/// A tool is missing, or the drive fails.
pub fn interrupt_costs() -> Result<Vec<InterruptCost>> {
    let drive = DriveImage::prepare(Leave::Look)?;
    let image = Image::read(&drive.path)?;
    let sound = trial()?;
    let upset: Vec<Input> = sound
        .iter()
        .enumerate()
        .map(|(k, &input)| match k % 16 {
            3 => Input { angle: input.angle ^ 1, ..input },
            7 => Input { force: u32::MAX, ..input },
            11 => Input { elapsed: 60, ..input },
            15 => Input { angle: input.angle ^ 0x0c00, ..input },
            _ => input,
        })
        .collect();
    let meter = InterruptMeter { drive, image, counter: counter()? };
    let mut costs = vec![meter.measure("without sensors", None, &[])?];
    costs.push(meter.measure(
        "other settings are taken",
        Some(Settings { window: 299, ..Settings::default() }),
        &sound,
    )?);
    for (what, words) in [("the recommended law, a contact", &sound), ("the recommended law, faults", &upset)] {
        costs.push(meter.measure(what, Some(Settings::default()), words)?);
    }
    let bls = Settings { method: Method::Bls, ..Settings::default() };
    costs.push(meter.measure("bls, a contact", Some(bls), &sound)?);
    // Of the laws blmf takes longest; taking it over is in the figure.
    let longest = Settings { method: Method::Blmf, ..Settings::default() };
    costs.push(meter.measure("blmf, taken over, faults", Some(longest), &upset)?);
    Ok(costs)
}

/// Four seconds of the bench: two onsets and two losses.
fn trial() -> Result<Vec<Input>> {
    let mut rig = Rig::read(&qemu_bench::project()?.join("lab/rigs/bench.toml"))?;
    rig.simulation.duration_s = 4.0;
    if let Some(reference) = &mut rig.reference {
        (reference.period_s, reference.contact_s) = (2.0, 1.2);
    }
    let recording: Recording = simulate::simulate(&rig, 3, "bench.toml")?.recording;
    let calibration = Calibration::DEFAULT;
    Ok(inputs(&recording, &rig, &calibration, &calibration.scale()))
}

struct InterruptMeter {
    drive: DriveImage,
    image: Image,
    counter: PathBuf,
}

impl InterruptMeter {
    fn measure(&self, what: &str, settings: Option<Settings>, words: &[Input]) -> Result<InterruptCost> {
        let folder = tempfile::tempdir().context("cannot make a folder for the counts")?;
        let (costs, counts) = (folder.path().join("costs"), folder.path().join("counts"));
        std::fs::write(&costs, table(&self.image)).context("cannot write the costs")?;
        let line = self.image.label("USART1")?;
        let line_end = self.image.function_at(line).context("the line's interrupt is no function")?.end;
        let plugin = format!(
            "{},begin={},end={},case={},excluded_begin={line},excluded_end={line_end},costs={},out={}",
            self.counter.display(),
            self.image.label("palpate_begin")?,
            self.image.label("palpate_end")?,
            self.image.label("main")?,
            costs.display(),
            counts.display()
        );
        let running = self.drive.start(ClockMode::Exact, None, &["-plugin", &plugin])?;
        let mut client = running.client()?;
        let before = run(&mut client, settings, words)?;
        finish(running, what, &counts, before..before + words.len())
    }
}

/// Feeds all of `words`; how many ticks had read the absent sensors before.
fn run(client: &mut Client, settings: Option<Settings>, words: &[Input]) -> Result<usize> {
    client.about()?;
    let Some(settings) = settings else {
        while client.ticks(|_| ())? < IDLE_TICKS {}
        return Ok(0);
    };
    if settings != Settings::default() {
        client.demand(Command::Choose(settings), "the settings")?;
    }
    client.demand(Command::Source(Source::Link), "the test mode")?;
    client.demand(Command::Stream(Streams { estimates: 0, samples: true }), "the streams")?;
    let (mut rest, mut back, start) = (words, 0, client.ticks(|_| ())?);
    while back < words.len() {
        let mut take = |message: Message<'_>| back += usize::from(matches!(message, Message::Sample(_)));
        if rest.is_empty() {
            let ticks = client.ticks(&mut take)?.wrapping_sub(start);
            ensure!(ticks < MAX_TICKS, "{back} of {} came back within {ticks} ticks", words.len());
        } else {
            rest = client.feed(rest, &mut take)?;
        }
    }
    Ok(start as usize)
}

/// Reads the counts. The first ticks, as many as `live` begins at, read the absent sensors. Of those behind them the longest took the
/// samples, as many as `live` has: one without a sample returns at once.
fn finish(running: QemuDrive, what: &str, counts: &std::path::Path, live: Range<usize>) -> Result<InterruptCost> {
    running.quit()?;
    let text = std::fs::read_to_string(counts).context("the plugin wrote no counts")?;
    let passes: Vec<Pass> = read_plugin(&text)?.into_iter().flat_map(|(passes, _)| passes).collect();
    let longest = passes.iter().max_by_key(|pass| pass.instructions).context("no tick was counted")?;
    let behind = passes.get(live.start..).context("fewer ticks than the drive told")?;
    let mut instructions: Vec<u32> = behind.iter().map(|pass| pass.instructions).collect();
    instructions.sort_unstable_by_key(|&count| std::cmp::Reverse(count));
    let median = instructions.get(..live.len()).context("fewer ticks than samples")?.get(live.len() / 2);
    Ok(InterruptCost {
        what: what.to_owned(),
        ticks: passes.len(),
        most: longest.instructions,
        cycles: longest.cycles,
        median_live: median.copied(),
    })
}
