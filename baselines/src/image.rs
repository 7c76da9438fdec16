//! The image of the baselines: each on the recording and with the measurement of the profile image.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod cases;

#[cfg(target_os = "none")]
use defmt_rtt as _;

/// Nothing to run on a host: `cargo run --release -p palpate-baselines` builds the image for its target and runs it.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see `cargo run --release -p palpate-baselines`");
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    palpate_firmware::measurement::measure(cases::run)
}
