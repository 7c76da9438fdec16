//! A trajectory on its way to a drive: its limits and gains in the drive's words, and its references in time.

use anyhow::{Context as _, Result};
use palpate_drive::link::{Command, Message, RequestOutcome};
use palpate_drive::{POINTS, StopReason, TICK_HZ, TrajectoryConfig, TrajectoryStatus};

use super::monitor::{Quantity, Violation};
use super::simulated_bed::stop_limits;
use super::test_bed::Ending;
use crate::experiment_design::Limits;
use crate::listen::Client;
use crate::rig::Control;

/// Ticks of silence after which the drive ends a run by itself.
pub const TIMEOUT_TICKS: u16 = 2_000;

/// References that wait in the drive, at least.
const MIN_BUFFERED_REFERENCES: usize = 256;

/// How a drive under `control` follows `length` references, depths counted from `surface`, within `limits`.
#[must_use]
pub fn config(control: &Control, limits: &Limits, surface: f64, length: usize) -> TrajectoryConfig {
    let stop = stop_limits(limits);
    let corner = control.derivative_filter_hz.unwrap_or(0.1 * control.rate_hz);
    TrajectoryConfig {
        depth: stop.position.map(|position| (position - surface) as f32),
        speed: stop.speed as f32,
        force: stop.force.unwrap_or(f64::from(f32::MAX)) as f32,
        effort: limits.effort.unwrap_or(control.effort_saturation).min(f64::from(f32::MAX)) as f32,
        proportional: control.proportional as f32,
        derivative: control.derivative as f32,
        pass: -(-std::f64::consts::TAU * corner / f64::from(TICK_HZ)).exp_m1() as f32,
        length: u32::try_from(length).unwrap_or(u32::MAX),
        timeout: TIMEOUT_TICKS,
    }
}

/// References of a run, as far as the drive was sent them.
pub struct References {
    depths: Vec<f32>,
    sent: usize,
}

impl References {
    /// Of positions, as depths from `surface`.
    pub fn new(positions: impl Iterator<Item = f64>, surface: f64) -> Self {
        Self { depths: positions.map(|position| (position - surface) as f32).collect(), sent: 0 }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.depths.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.depths.is_empty()
    }

    /// Sends references until enough wait in the drive, which has followed `played`; what comes meanwhile goes to `take`.
    ///
    /// # Errors
    /// The link is gone.
    pub fn top_up(&mut self, client: &mut Client, played: usize, mut take: impl FnMut(Message<'_>)) -> Result<()> {
        while self.sent < self.depths.len() && self.sent < played + MIN_BUFFERED_REFERENCES {
            let end = (self.sent + POINTS).min(self.depths.len());
            let bytes: Vec<u8> = self.depths[self.sent..end].iter().flat_map(|depth| depth.to_le_bytes()).collect();
            // Asked once: what is sent twice would be followed twice.
            match client.request(Command::Points(&bytes), &mut take)? {
                RequestOutcome::Done => self.sent = end,
                // No room yet, or the run has ended by itself: its status says which.
                _ => break,
            }
        }
        Ok(())
    }
}

/// Where the drive's trajectory stands; what comes meanwhile goes to `take`.
///
/// # Errors
/// The link is gone.
pub fn status(client: &mut Client, mut take: impl FnMut(Message<'_>)) -> Result<TrajectoryStatus> {
    let mut status = None;
    client.ask(Command::Trajectory, |message| match message {
        Message::Trajectory(found) => status = Some(found),
        other => take(other),
    })?;
    status.context("the drive does not report where its trajectory stands")
}

/// What `reason` is to an investigation; `position` and `force` were read last, at `time_s`.
#[must_use]
pub fn ending(reason: StopReason, limits: &Limits, time_s: f64, position: f64, force: f64) -> Ending {
    let stop = stop_limits(limits);
    let [low, high] = stop.position;
    let passed = |quantity, value: f64, limit: f64| Ending::Stopped(Violation { quantity, time_s, value, limit });
    match reason {
        StopReason::Depth => {
            passed(Quantity::Position, position, if position < 0.5 * (low + high) { low } else { high })
        }
        // The drive tells that it was passed, not by how much.
        StopReason::Speed => passed(Quantity::Speed, stop.speed, stop.speed),
        StopReason::Force => passed(Quantity::Force, force, stop.force.unwrap_or(f64::MAX)),
        other => Ending::Failed(format!("the drive ended it by itself: {other:?}").to_lowercase()),
    }
}
