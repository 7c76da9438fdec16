//! What the images share: the clocks of the board, the recording that is read by semihosting, and the measurement of one update.
//! There is nothing here for a host.

#![no_std]

#[cfg(target_os = "none")]
pub mod board;
#[cfg(target_os = "none")]
pub mod measurement;
#[cfg(target_os = "none")]
pub mod recording;
