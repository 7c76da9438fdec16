//! `palpate investigate`: diagnose, design a trial, run it, record it, and diagnose again, until one explanation is left.
//!
//! A [`test_bed`] runs a reference on the rig: a simulation with concealed physics ([`simulated_bed`]) or any command of the user
//! ([`command_bed`]), a drive on its serial line ([`drive_bed`]), or the drive image in QEMU with a simulation in its loop
//! ([`emulated_drive_bed`]). [`session`] is the loop; what is open after a diagnosis is put into questions ([`questions`]) for
//! [`experiment_design`](crate::experiment_design). [`monitor`] holds every recording against the limits and knows nothing of the
//! controller or of the design. [`record`] is what the folder of an investigation holds, from which it is resumed, and [`report`] the
//! page. [`trial_of_method`] puts the whole to rigs whose missing physics is concealed from it.

mod bounded_command;
mod command;
pub mod command_bed;
pub mod concealed_bed;
pub mod drive_bed;
pub mod drive_trajectory;
pub mod emulated_drive_bed;
pub mod monitor;
pub mod questions;
pub mod record;
pub mod report;
pub mod separating_trial;
pub mod session;
pub mod simulated_bed;
pub mod test_bed;
pub mod trial_of_method;
pub mod watched_bed;

pub use command::{InvestigateArgs, run};
