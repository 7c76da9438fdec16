//! The bench image: takes a recording by semihosting, feeds it to the estimators from the 1 kHz SysTick interrupt, returns
//! every estimate. The same image runs under QEMU (`netduinoplus2`) and, under `probe-rs run`, on an STM32F405.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod idle;
#[cfg(target_os = "none")]
mod tick;

/// Nothing to run on a host: `palpate replay --on qemu` builds the image for its target and runs it.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see `palpate replay --on qemu`");
}
