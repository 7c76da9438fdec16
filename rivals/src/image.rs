//! The rivals' image: every rival on the recording and by the gauge of the profile image.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../src/firmware/board.rs"]
mod board;
#[cfg(target_os = "none")]
mod cases;
#[cfg(target_os = "none")]
#[path = "../../src/firmware/profile/gauge.rs"]
mod gauge;
#[cfg(target_os = "none")]
#[path = "../../src/firmware/profile/input.rs"]
mod input;

#[cfg(target_os = "none")]
use defmt_rtt as _;

/// Nothing to run on a host: `cargo run --release -p palpate-rivals` builds the image for its target and runs it.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see `cargo run --release -p palpate-rivals`");
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    gauge::measure(cases::run)
}
