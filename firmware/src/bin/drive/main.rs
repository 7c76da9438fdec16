//! The drive image: sensors at 1 kHz, one update a tick, estimates out over a serial line. For an STM32F405; the same image runs
//! under QEMU (`netduinoplus2`), where the sensors are absent and the link feeds their words.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod failure;
#[cfg(target_os = "none")]
mod flash;
#[cfg(target_os = "none")]
mod idle;
#[cfg(target_os = "none")]
mod line;
#[cfg(target_os = "none")]
mod sensors;
#[cfg(target_os = "none")]
mod tick;

/// Nothing to run on a host: `palpate listen` speaks to the image.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see docs/drive.md");
}
