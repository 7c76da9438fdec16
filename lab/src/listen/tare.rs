//! A tare, waited for: the drive takes two hundred good samples after the order, and refuses it in contact or where the zero
//! is too far away.

use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use palpate_drive::link::Command;
use palpate_drive::{Order, TICK_HZ};

use super::client::Client;

/// Good samples that the drive takes the mean of.
const TARE_SAMPLES: u32 = 200;

/// Ticks within which two hundred good samples have to have come.
const MAX_TICKS: u32 = 2 * TICK_HZ as u32;

/// A drive whose ticks stand still is in test mode, and nobody feeds it.
const STANDSTILL: Duration = Duration::from_secs(10);

/// Orders a tare, and waits until it is done.
///
/// # Errors
/// The port is gone, the tool touches, the zero would move further than the calibration lets it, or the sensor gives no good samples.
pub fn tare(client: &mut Client) -> Result<()> {
    let before = client.counters()?.others;
    client.demand(Command::Order(Order::Tare), "the tare")?;
    let since = Instant::now();
    loop {
        let now = client.counters()?.others;
        let [ticks, used, _, refused] = [0, 1, 2, 3].map(|at| now[at].wrapping_sub(before[at]));
        if refused > 0 {
            bail!(
                "the drive refuses the tare: the tool is in contact, or the force is further from the calibrated zero than `tare_limit` \
                 of its calibration. Move the tool clear of the surface and tare again"
            );
        }
        // The sample that completes it is counted in the same tick.
        if used > TARE_SAMPLES {
            return Ok(());
        }
        if ticks > MAX_TICKS || since.elapsed() > STANDSTILL {
            bail!(
                "no tare: {used} good samples in {ticks} ticks, {TARE_SAMPLES} are needed. The order stands until they \
                 come: mend the sensors"
            );
        }
    }
}
