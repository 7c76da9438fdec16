//! The profile image: every update of every law on one recording, each between two reads of a counter.
//!
//! The counter is SysTick, which QEMU drives by the instructions executed (`-icount`), and beside it the cycle counter of the
//! debug unit, which a board has and QEMU has not (it reads zero). A plugin of QEMU counts the same region by itself.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod cases;

/// Nothing to run on a host: `palpate profile` builds the image for its target and runs it.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see `palpate profile`");
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    palpate_firmware::measurement::measure(cases::run)
}
