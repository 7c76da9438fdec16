//! A drive on its serial line, which follows the trajectory by its own sensors.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use palpate_drive::link::{BAUD, Command, EstimateMessage, Message, SampleMessage, Source, Streams};
use palpate_drive::{TICK_HZ, TrajectoryState};

use super::drive_trajectory::{References, config, ending, status};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::error::InputError;
use crate::listen::{Client, open};
use crate::recording::Recording;
use crate::rig::{Control, Rig};

/// Time in which the tool is brought from where it stands to where a trial begins, s.
const APPROACH_S: f64 = 3.0;

/// How often the drive is asked where its trajectory stands.
const STATUS_INTERVAL: Duration = Duration::from_millis(40);

/// Ticks from one reported effort to the next: both streams at each tick are as much as the line carries.
const EFFORT_TICKS: u16 = 2;

/// How long the first sample may take.
const SAMPLE_TIMEOUT: Duration = Duration::from_secs(2);

/// A drive on a port.
pub struct DriveBed {
    port: PathBuf,
    rig: Rig,
    control: Control,
}

impl DriveBed {
    /// The drive on `port`, which follows under the controller of `rig`.
    ///
    /// # Errors
    /// `rig` states no controller.
    pub fn new(port: &Path, rig: &Rig) -> Result<Self> {
        let Some(control) = rig.control else {
            bail!(InputError::new(
                "the rig file",
                "no [control]",
                "the gains with which the drive follows a trajectory"
            ));
        };
        Ok(Self { port: port.to_owned(), rig: rig.clone(), control })
    }

    /// Runs `request` on `client`, and hears what the drive tells of it.
    fn follow(&self, client: &mut Client, request: &TrialRequest<'_>, heard: &mut Heard) -> Result<Ending> {
        client.demand(Command::Source(Source::Sensors), "its sensors")?;
        client.demand(Command::Stream(Streams { estimates: EFFORT_TICKS, samples: true }), "the streams")?;
        let surface = self.rig.surface();
        let Some(stands) = heard.first_depth(client)? else {
            return Ok(Ending::Failed("the drive has no good sample: see its faults by `palpate listen`".to_owned()));
        };
        let approach = approach(surface + stands, request.reference[0]);
        heard.approach_rows = approach.len();
        let mut references = References::new(approach.into_iter().chain(request.reference.iter().copied()), surface);
        let limits = request.limits;
        client.demand(Command::Prepare(config(&self.control, limits, surface, references.len())), "the trajectory")?;
        references.top_up(client, 0, |message| heard.take(&message))?;
        heard.begin();
        client.demand(Command::Follow(true), "the start")?;
        loop {
            if request.interrupted.load(Ordering::Relaxed) {
                client.demand(Command::Follow(false), "the end")?;
                return Ok(Ending::Interrupted);
            }
            let stands = status(client, |message| heard.take(&message))?;
            match stands.state {
                TrajectoryState::Finished => return Ok(Ending::Completed),
                TrajectoryState::Stopped(reason) => {
                    let [position, force] = heard.last();
                    let time = heard.samples.len() as f64 / f64::from(TICK_HZ);
                    return Ok(ending(reason, limits, time, surface + position, force));
                }
                TrajectoryState::Idle | TrajectoryState::Prepared | TrajectoryState::Running => {}
            }
            references.top_up(client, stands.played as usize, |message| heard.take(&message))?;
            let since = Instant::now();
            while since.elapsed() < STATUS_INTERVAL {
                client.poll(|message| heard.take(&message))?;
            }
        }
    }
}

impl TestBed for DriveBed {
    fn description(&self) -> String {
        format!("the drive on {}", self.port.display())
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome> {
        let mut client = Client::new(open(&self.port, BAUD)?);
        client.wake()?;
        client.quiet()?;
        let mut heard = Heard::default();
        let ending = match self.follow(&mut client, request, &mut heard) {
            Ok(ending) => ending,
            // The drive ends a run by itself where nobody speaks to it.
            Err(error) => Ending::Failed(format!("the link to the drive: {error:#}")),
        };
        // A drive that is still there is asked for rest and silence; one that is gone has come to rest by itself.
        let _ = client.request(Command::Follow(false), |_| ()).and_then(|_| client.quiet());
        Ok(TrialOutcome { recording: heard.recording(request, self.rig.surface()), ending })
    }
}

/// From where the tool stands to `first`, a quintic.
fn approach(from: f64, first: f64) -> Vec<f64> {
    let rows = (APPROACH_S * f64::from(TICK_HZ)) as usize;
    let part = |row: usize| {
        let u = row as f64 / rows as f64;
        u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    };
    (0..rows).map(|row| from + (first - from) * part(row)).collect()
}

/// What a drive reported of a run.
#[derive(Default)]
struct Heard {
    samples: Vec<(u32, [f32; 2])>,
    efforts: std::collections::BTreeMap<u32, f32>,
    approach_rows: usize,
}

impl Heard {
    fn take(&mut self, message: &Message<'_>) {
        match message {
            Message::Sample(SampleMessage { tick, taken: Some(taken), .. }) => self.samples.push((*tick, *taken)),
            Message::Estimate(EstimateMessage { tick, effort, .. }) => {
                self.efforts.insert(*tick, *effort);
            }
            _ => {}
        }
    }

    /// The depth of the first good sample; `None` where there is none in time.
    fn first_depth(&mut self, client: &mut Client) -> Result<Option<f64>> {
        let since = Instant::now();
        while self.samples.is_empty() && since.elapsed() < SAMPLE_TIMEOUT {
            client.poll(|message| self.take(&message))?;
        }
        Ok(self.samples.last().map(|(_, [depth, _])| f64::from(*depth)))
    }

    /// Forgets what was before the run.
    fn begin(&mut self) {
        self.samples.clear();
        self.efforts.clear();
    }

    /// Depth and force read last.
    fn last(&self) -> [f64; 2] {
        self.samples.last().map_or([0.0; 2], |(_, taken)| taken.map(f64::from))
    }

    /// The effort that was reported last before `tick`.
    fn effort(&self, tick: u32) -> f64 {
        self.efforts.range(..=tick).next_back().map_or(0.0, |(_, effort)| f64::from(*effort))
    }

    /// The trial without its approach; `None` where it did not come so far.
    fn recording(&self, request: &TrialRequest<'_>, surface: f64) -> Option<Recording> {
        let rows = self.samples.get(self.approach_rows..).filter(|rows| rows.len() > 1)?;
        let first = rows.first().context("no row").ok()?.0;
        let since = |tick: u32| tick.wrapping_sub(first);
        let reference = |tick: u32| {
            let row = since(tick) as usize;
            request.reference[row.min(request.reference.len() - 1)]
        };
        Some(Recording {
            time: rows.iter().map(|(tick, _)| f64::from(since(*tick)) / f64::from(TICK_HZ)).collect(),
            position: rows.iter().map(|(_, [depth, _])| surface + f64::from(*depth)).collect(),
            force: Some(rows.iter().map(|(_, [_, force])| f64::from(*force)).collect()),
            effort: Some(rows.iter().map(|(tick, _)| self.effort(*tick)).collect()),
            reference: Some(rows.iter().map(|(tick, _)| reference(*tick)).collect()),
            ..Recording::default()
        })
    }
}
