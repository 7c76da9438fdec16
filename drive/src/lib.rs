//! What a drive needs besides the estimators of [`palpate`]: sensors, faults, calibration and the serial link.
//!
//! All of it is free of registers, so that it runs unchanged in the interrupt of `firmware/src/bin/drive`, in a firmware of
//! your own, and in the tests on a host. One millisecond is one [`Input`] (the words that the sensors' buses brought, and what
//! else happened) through one [`Cycle`], which gives one [`Report`]:
//!
//! ```text
//! As5047p, Ads8681, Quadrature  ->  Input  ->  Cycle::tick  ->  Report  ->  link::Message
//!   (embedded-hal 1.0)                         | words checked (parity, alarms)
//!                                              | readings checked (stuck, jump, range)
//!                                              | scaled by the Calibration, identified
//!                                              | effort, zero on any fault
//! ```
//!
//! The same `Input` may come over the link in place of the sensors ("hardware in the loop"): a `Report` is a function of the
//! inputs and orders before it and of nothing else, so a host that repeats them has the same bits.

#![no_std]
#![forbid(unsafe_code)]

pub mod ads8681;
pub mod as5047p;
mod bus;
mod calibration;
mod channel;
mod counters;
mod cycle;
mod decoder;
mod effort;
mod estimator;
mod faults;
pub mod framing;
mod input;
pub mod link;
mod quadrature;
pub mod replay_format;
mod settings;
mod tare;
mod trajectory;
mod trajectory_config;
mod trajectory_status;

pub use bus::{BoundedSpi, BusFault};
pub use calibration::{CALIBRATION_BYTES, Calibration, CalibrationFault, PositionSensor, Scale};
pub use counters::Counters;
pub use cycle::{Cycle, Order, Report, Validity};
pub use decoder::{DecodedRequest, RequestDecoder};
pub use effort::{Bounds, effort, trusted};
pub use estimator::{Estimator, ValidatedSettings};
pub use faults::Faults;
pub use input::{INPUT_BYTES, Input, InputStatus};
pub use quadrature::{EncoderCounter, Quadrature};
pub use settings::Settings;
pub use trajectory::{POINTS, TrajectoryFollower};
pub use trajectory_config::TrajectoryConfig;
pub use trajectory_status::{StopReason, TrajectoryState, TrajectoryStatus};

/// Ticks of the interrupt in a second.
pub const TICK_HZ: u16 = 1_000;

/// CRC-32 of ISO-HDLC (zip, Ethernet), of the calibration block and of every frame of the link.
pub(crate) const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// The example of the drive's page is a test.
#[cfg(doctest)]
#[doc = include_str!("../../docs/drive.md")]
struct DrivePage;
