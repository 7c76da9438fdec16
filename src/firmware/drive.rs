//! The drive image: sensors at 1 kHz, one update a tick, estimates out over a serial line. For an STM32F405; the same image runs
//! under QEMU (`netduinoplus2`), where the sensors are absent and the link feeds their words.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "drive/board.rs"]
mod board;
#[cfg(target_os = "none")]
#[path = "drive/failure.rs"]
mod failure;
#[cfg(target_os = "none")]
#[path = "drive/flash.rs"]
mod flash;
#[cfg(target_os = "none")]
#[path = "drive/idle.rs"]
mod idle;
#[cfg(target_os = "none")]
#[path = "drive/line.rs"]
mod line;
#[cfg(target_os = "none")]
#[path = "drive/sensors.rs"]
mod sensors;
#[cfg(target_os = "none")]
#[path = "drive/tick.rs"]
mod tick;

/// Nothing to run on a host: `palpate listen` speaks to the image.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see docs/drive.md");
}
