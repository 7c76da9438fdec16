//! The messages between drive and host; [`super::framing`] defines the frames.
//!
//! The host sends a [`Request`]; the drive does it or refuses it, answers what was asked and then, with the request's number,
//! how it went. Estimates and samples come unasked at the rate that was asked for.

use serde::{Deserialize, Serialize};

use crate::calibration::{Calibration, Scale};
use crate::cycle::{Order, Report, Validity};
use crate::faults::Faults;
use crate::framing::LinkCounters;
use crate::input::Input;
use crate::settings::Settings;
use crate::trajectory_config::TrajectoryConfig;
use crate::trajectory_status::TrajectoryStatus;
use palpate::Estimate;
use palpate::Flags;
use palpate::Impedance;

/// Bits a second of the serial line.
pub const BAUD: u32 = 921_600;

/// A request of the host.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Request<'a> {
    /// Comes back with the answer.
    pub number: u16,
    /// What to do.
    #[serde(borrow)]
    pub command: Command<'a>,
}

/// What to do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Command<'a> {
    /// Sign of life of the host.
    Alive,
    /// Tell the identity.
    Identify,
    /// Tell the calibration.
    Calibration,
    /// Tell the settings.
    Settings,
    /// Tell the counters.
    Counters,
    /// Take these settings.
    Choose(Settings),
    /// An order to the interrupt.
    Order(Order),
    /// Send so much.
    Stream(Streams),
    /// Take the inputs from there.
    Source(Source),
    /// Inputs for [`Source::Link`], one after the other, 1 to [`FEED`] of them.
    Feed(#[serde(borrow)] &'a [u8]),
    /// Prepare to follow a trajectory.
    Prepare(TrajectoryConfig),
    /// References of it, m from the surface, little-endian, one after the other, 1 to [`POINTS`](crate::POINTS) of them.
    Points(#[serde(borrow)] &'a [u8]),
    /// Begin to follow it, or end it.
    Follow(bool),
    /// Tell where it stands.
    Trajectory,
}

/// Most inputs of one request.
pub const FEED: usize = 16;

/// Periodic messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Streams {
    /// An estimate every so many ticks, and at each where a fault begins; 0: none.
    pub estimates: u16,
    /// Every tick's sample.
    pub samples: bool,
}

/// Where the inputs come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Source {
    /// The sensors.
    #[default]
    Sensors,
    /// The link, one input a tick; time stands still while there is none.
    Link,
}

/// A message of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Message<'a> {
    /// How a request went.
    Answer {
        /// The request's number.
        number: u16,
        /// How it went.
        outcome: RequestOutcome,
    },
    /// What the drive is.
    Identity(#[serde(borrow)] Identity<'a>),
    /// How counts become metres and newtons.
    Calibration {
        /// As it was read.
        calibration: Calibration,
        /// As it is now.
        scale: Scale,
    },
    /// What was chosen.
    Settings {
        /// The settings.
        settings: Settings,
        /// Their number, as estimates have it.
        revision: u8,
    },
    /// How often what happened.
    Counters(CountersMessage),
    /// An estimate.
    Estimate(EstimateMessage),
    /// A sample.
    Sample(SampleMessage),
    /// Where a trajectory stands.
    Trajectory(TrajectoryStatus),
}

/// How a request went.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RequestOutcome {
    /// It was done, or will be at the next tick.
    Done,
    /// Nothing was changed: a value is out of its range.
    OutOfRange,
    /// Nothing was changed: there is no room at present.
    NoRoom,
    /// Nothing was changed: it does not go with the present source.
    NotNow,
}

/// What the drive is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Identity<'a> {
    /// Version of the sources.
    pub version: &'a str,
    /// CRC-32 of the image in flash: no two builds have the same.
    pub image: u32,
    /// The chip's own number; zero on the emulator.
    pub chip: [u32; 3],
    /// It is QEMU.
    pub emulator: bool,
    /// Bits 24 to 31 of RCC_CSR at the start: low-power (7), window watchdog (6), watchdog (5), software (4), power-on (3), pin (2)
    /// and brown-out reset (1).
    pub reset: u8,
    /// Faults that were there at the start.
    pub found: u32,
}

/// The event counters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CountersMessage {
    /// Ticks at which each fault occurred, in the order of their bits.
    pub faults: [u32; Faults::COUNT],
    /// Ticks, samples used, times that the estimator began anew, tares refused.
    pub others: [u32; 4],
    /// Reports that the idle loop had no time for.
    pub dropped: u32,
    /// Received bytes lost by overrun of the queue or by an error of the line.
    pub rx_overruns: u32,
    /// Inputs of the link that waited for none, and ticks that waited for an input.
    pub starved: u32,
    /// Least and most cycles of the core from the timer's zero to the interrupt's first look at it.
    pub latency: [u32; 2],
    /// Most cycles of the core from the timer's zero to the interrupt's end.
    pub longest: u32,
    /// What was heard on the link.
    pub link_counters: LinkCounters,
}

/// An estimate as it is sent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EstimateMessage {
    /// The tick.
    pub tick: u32,
    /// Which sample it is based on.
    pub validity: Validity,
    /// The bits of [`Faults`].
    pub faults: u32,
    /// The number of the settings.
    pub revision: u8,
    /// K and B.
    pub impedance: Impedance,
    /// Their half-widths.
    pub half_width: Impedance,
    /// Innovation, fill, excitation.
    pub quality: [f32; 3],
    /// The bits of [`Flags`].
    pub flags: u16,
    /// For the current loop.
    pub effort: f32,
}

/// A sample as it is sent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SampleMessage {
    /// The tick.
    pub tick: u32,
    /// What went in.
    pub input: Input,
    /// Position and force in SI, where the estimator was given them.
    pub taken: Option<[f32; 2]>,
    /// The estimator began anew with it.
    pub restarted: bool,
}

impl EstimateMessage {
    /// The message of `report`.
    pub fn of(report: &Report) -> Self {
        let e = &report.estimate;
        Self {
            tick: report.tick,
            validity: report.validity,
            faults: report.faults.bits(),
            revision: report.revision,
            impedance: e.impedance,
            half_width: e.half_width,
            quality: [e.innovation, e.fill, e.excitation],
            flags: e.flags.bits(),
            effort: report.effort,
        }
    }

    /// The estimate, to the bit.
    pub fn estimate(&self) -> Estimate {
        let [innovation, fill, excitation] = self.quality;
        Estimate {
            impedance: self.impedance,
            half_width: self.half_width,
            innovation,
            fill,
            excitation,
            flags: Flags::from_bits_retain(self.flags),
        }
    }

    /// The faults.
    pub fn faults(&self) -> Faults {
        Faults::from_bits_retain(self.faults)
    }
}

impl SampleMessage {
    /// The message of `report`.
    pub fn of(report: &Report) -> Self {
        Self {
            tick: report.tick,
            input: report.input,
            taken: report.sample.map(|sample| [sample.position, sample.force]),
            restarted: report.restarted,
        }
    }
}
