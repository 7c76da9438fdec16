//! The host tool of palpate, as a library so that its binaries and tests share it.

pub mod calibrate;
pub mod catalogue;
pub mod challenge;
pub mod cli;
pub mod completions;
pub mod demo;
pub mod diagnose;
pub mod effects;
pub mod error;
pub mod listen;
pub mod outfile;
pub mod page;
pub mod plant;
pub mod profile;
pub mod qemu_bench;
pub mod qemu_drive;
pub mod recording;
pub mod recordings_folder;
pub mod reference;
pub mod replay;
pub mod reproduce;
pub mod rig;
pub mod schema;
pub mod sensors;
pub mod simulate;
pub mod tools;
