//! `palpate investigate-challenge`: investigations of rigs whose missing physics is concealed from them, against the first recording
//! alone and against as many trials along fixed rich references of equal length.
//!
//! `listed_rig` is what a run puts to the test: rigs that `own_rig` draws from the cases' own generator, and those of other authors,
//! of which a [`source_rig`] is what an investigation may know and a [`source_bed`] runs the rest. [`comparison`] puts one to all three
//! ways on a [`watched_bed`](super::watched_bed); a [`row`] holds its [`answer`]s against the truth, and [`table`] counts rows.

pub mod answer;
mod command;
pub mod comparison;
mod listed_rig;
mod own_rig;
pub mod row;
pub mod source_bed;
pub mod source_rig;
pub mod table;

pub use command::{InvestigateChallengeArgs, run};
