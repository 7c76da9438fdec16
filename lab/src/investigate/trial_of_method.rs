//! `palpate investigate-challenge`: investigations of rigs whose missing physics is concealed from them, against the first recording
//! alone and against as many trials along fixed rich references of equal length.
//!
//! [`own_rig`] draws rigs from the cases' own generator. [`comparison`] puts one to all three ways on a [`watched_bed`]; a [`row`]
//! holds its [`answer`]s against the truth, and [`table`] counts rows.

pub mod answer;
mod command;
pub mod comparison;
mod own_rig;
pub mod row;
pub mod table;
pub mod watched_bed;

pub use command::{InvestigateChallengeArgs, run};
