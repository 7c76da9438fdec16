//! The drive image in QEMU with a simulated rig in its loop: the drive is given the trajectory, sees the simulated sensors' words,
//! and its effort moves the simulated tool, tick by tick.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use palpate_drive::link::{Command, Message, Source, Streams};
use palpate_drive::{CALIBRATION_BYTES, Calibration, Input, Scale, TrajectoryConfig, TrajectoryState};

use super::drive_trajectory::{References, TIMEOUT_TICKS, config, ending, status};
use super::simulated_bed::{SimulatedBed, truncate};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::error::InputError;
use crate::experiment_design::Limits;
use crate::listen::{Client, inputs};
use crate::qemu_drive::{ClockMode, DriveImage};
use crate::recording::Recording;
use crate::rig::{Control, Rig};
use crate::simulate::{CommandSource, Measurement, simulate_commanded};

/// Ticks at rest before a trial: faults from before the first word have lingered out by then.
const WARM_UP_TICKS: usize = 64;

/// How long an effort may take; an emulator on a busy host may take seconds.
const EFFORT_TIMEOUT: Duration = Duration::from_secs(10);

/// Largest force that the sensor's word holds, over the limit of the force.
const FORCE_RANGE: f64 = 2.0;

/// Something that goes wrong on the link at a row of each trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkFault {
    /// Bytes that are no frame.
    Noise {
        /// The row.
        row: usize,
    },
    /// The host is silent for longer than the drive waits.
    Silence {
        /// The row.
        row: usize,
    },
}

/// A drive in QEMU that moves a simulated rig.
pub struct EmulatedDriveBed {
    plant: SimulatedBed,
    rig: Rig,
    control: Control,
    image: DriveImage,
    faults: Vec<LinkFault>,
}

impl EmulatedDriveBed {
    /// The rig of the file `hidden` in place of that of `rig`, under the controller of `rig` on the drive; `faults` happen in each trial.
    ///
    /// # Errors
    /// The file is at fault, of another coordinate, or without a drive; or `rig` states no controller.
    pub fn new(hidden: &Path, rig: &Rig, seed: u64, image: DriveImage, faults: Vec<LinkFault>) -> Result<Self> {
        let plant = SimulatedBed::new(hidden, rig, seed)?;
        let Some(control) = rig.control else {
            bail!(InputError::new(
                "the rig file",
                "no [control]",
                "the gains with which the drive follows a trajectory"
            ));
        };
        Ok(Self { plant, rig: rig.clone(), control, image, faults })
    }

    /// What the drive needs to know of its sensors to hold `limits`.
    fn calibration(&self, limits: &Limits) -> Calibration {
        let surface = self.rig.surface();
        let far = limits.position.map(|position| (position - surface).abs()).into_iter().fold(0.0, f64::max);
        let force = FORCE_RANGE * limits.force.unwrap_or(1.0);
        Calibration {
            date: 20_260_101,
            // Twice the way to either side of the surface lies within one turn.
            travel_per_turn: (4.0 * far) as f32,
            travel: [-1.9 * far as f32, 1.9 * far as f32],
            max_speed: (10.0 * limits.speed) as f32,
            force_gain: (force / f64::from(0x7000)) as f32,
            force_limit: force as f32,
            force_noise: self.rig.sensors.force_noise.unwrap_or(1e-2 * force) as f32,
            stuck_after: [0, 0],
            ..Calibration::DEFAULT
        }
    }
}

impl TestBed for EmulatedDriveBed {
    fn description(&self) -> String {
        format!("the drive image in QEMU, moving a simulation of {}", self.plant.origin)
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome> {
        let calibration = self.calibration(request.limits);
        let mut buffer = [0; CALIBRATION_BYTES];
        let block = calibration.write(&mut buffer).context("the calibration does not fit its block")?;
        let drive = self.image.start(ClockMode::Wall, Some(block), &[])?;
        let mut client = drive.client()?;
        begin(&mut client)?;
        let hidden = self.plant.prepared(request);
        let mut link = DriveLink {
            client,
            request,
            rig: &self.rig,
            scale: calibration.scale(),
            calibration,
            faults: &self.faults,
            references: References::new(request.reference.iter().copied(), self.rig.surface()),
            row: 0,
            ended: None,
        };
        let length = request.reference.len();
        link.prepare(&config(&self.control, request.limits, self.rig.surface(), length))?;
        let seed = self.plant.seed.wrapping_add(request.round);
        let trial = match simulate_commanded(&hidden, seed, &self.plant.origin, &mut link) {
            Ok(trial) => trial,
            Err(error) => return Ok(TrialOutcome { recording: None, ending: Ending::Failed(error.to_string()) }),
        };
        let (ending, rows) = link.ended.unwrap_or((Ending::Completed, request.reference.len()));
        let mut recording = trial.recording;
        recording.reference = Some(request.reference.iter().take(recording.time.len()).copied().collect());
        truncate(&mut recording, rows);
        Ok(TrialOutcome { recording: Some(recording), ending })
    }
}

/// Test mode, an estimate with its effort each tick.
fn begin(client: &mut Client) -> Result<()> {
    client.demand(Command::Source(Source::Link), "the test mode")?;
    client.demand(Command::Stream(Streams { estimates: 1, samples: false }), "the streams")
}

/// A trial on the link: what the simulated sensors read goes to the drive, its effort comes back.
struct DriveLink<'a> {
    client: Client,
    request: &'a TrialRequest<'a>,
    rig: &'a Rig,
    calibration: Calibration,
    scale: Scale,
    faults: &'a [LinkFault],
    references: References,
    row: usize,
    /// How it ended, and after how many rows.
    ended: Option<(Ending, usize)>,
}

impl DriveLink<'_> {
    /// Lets the drive see a tool at rest where the reference begins, gives it the trajectory, and starts.
    fn prepare(&mut self, config: &TrajectoryConfig) -> Result<()> {
        let rest = self.word(self.request.reference[0], 0.0);
        for _ in 0..WARM_UP_TICKS {
            self.tick(rest)?;
        }
        self.client.demand(Command::Prepare(*config), "the trajectory")?;
        // It is prepared at the next tick.
        self.tick(rest)?;
        self.references.top_up(&mut self.client, 0, |_| ())?;
        self.client.demand(Command::Follow(true), "the start")?;
        Ok(())
    }

    /// The sensors' words of a position and a force.
    fn word(&self, position: f64, force: f64) -> Input {
        let one = Recording { position: vec![position], force: Some(vec![force]), ..Recording::default() };
        inputs(&one, self.rig, &self.calibration, &self.scale).first().copied().unwrap_or(Input::NOTHING)
    }

    /// Feeds one tick: the effort of the drive.
    fn tick(&mut self, input: Input) -> Result<f64> {
        let (since, mut effort) = (Instant::now(), None);
        let mut take = |message: Message<'_>| {
            if let Message::Estimate(estimate) = message {
                effort = Some(f64::from(estimate.effort));
            }
        };
        while !self.client.feed(&[input], &mut take)?.is_empty() {}
        while effort.is_none() {
            let mut take = |message: Message<'_>| {
                if let Message::Estimate(estimate) = message {
                    effort = Some(f64::from(estimate.effort));
                }
            };
            self.client.poll(&mut take)?;
            if since.elapsed() > EFFORT_TIMEOUT {
                bail!("the drive tells no effort");
            }
        }
        effort.context("the drive tells no effort")
    }

    fn disturb(&mut self) -> Result<()> {
        for fault in self.faults {
            match fault {
                LinkFault::Noise { row } if *row == self.row => {
                    self.client.write(&[0x55, 0xaa, 0x13, 0x00, 0x07, 0x00])?
                }
                LinkFault::Silence { row } if *row == self.row => {
                    std::thread::sleep(2 * Duration::from_millis(TIMEOUT_TICKS.into()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// One row: the effort that the drive answers its readings with.
    fn follow(&mut self, measurement: &Measurement) -> Result<f64> {
        self.disturb()?;
        if self.request.interrupted.load(Ordering::Relaxed) {
            self.client.demand(Command::Follow(false), "the end")?;
            self.ended = Some((Ending::Interrupted, self.row));
            return Ok(0.0);
        }
        // Estimates of the tick before are of no use any more.
        self.references.top_up(&mut self.client, self.row, |_| ())?;
        let effort = self.tick(self.word(measurement.position, measurement.force))?;
        // The drive says zero where it has ended; it is asked only then.
        if effort == 0.0
            && let TrajectoryState::Stopped(reason) = status(&mut self.client, |_| ())?.state
        {
            let Measurement { time, position, force, .. } = *measurement;
            self.ended = Some((ending(reason, self.request.limits, time, position, force), self.row));
        }
        Ok(effort)
    }
}

impl CommandSource for DriveLink<'_> {
    fn command(&mut self, _measurement: &Measurement) -> f64 {
        0.0
    }

    fn effort(&mut self, measurement: &Measurement) -> Option<f64> {
        self.row += 1;
        if self.ended.is_some() {
            return Some(0.0);
        }
        let effort = self.follow(measurement).unwrap_or_else(|error| {
            self.ended = Some((Ending::Failed(format!("the link to the drive: {error:#}")), self.row));
            0.0
        });
        Some(effort)
    }
}
