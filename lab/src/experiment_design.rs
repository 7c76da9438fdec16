//! Design of experiments on rigs alone: which motion discriminates best between explanations of the same recordings.
//!
//! An explanation is a [`Rig`](crate::rig::Rig) with fitted values ([`explanation`]). Candidate motions ([`candidates`], [`path`])
//! become references of the closed loop ([`mod@reference`]), every explanation is simulated along each ([`prediction`]), and what their
//! responses differ by, in units of the sensors' noise and after the best small change of the other's values, is the candidate's
//! worth ([`discrimination`]; T-optimality with a local refit). States not visited yet ([`coverage`]) are the second merit, and listed effects that
//! the recordings ([`recorded`]) could hide ([`departures`]) the third.
//! [`planner`] fills the time of a trial with the candidates that decide most. Nothing here knows how a diagnosis works.
//!
//! Every motion keeps to [`limits`] with a margin under every explanation, never under the likeliest alone.

pub mod candidates;
pub mod coverage;
pub mod departures;
pub mod discrimination;
pub mod explanation;
pub mod limits;
pub mod loop_model;
pub mod parameters;
pub mod path;
pub mod planner;
pub mod prediction;
pub mod recorded;
pub mod reference;

pub use explanation::Explanation;
pub use limits::Limits;
pub use planner::{Plan, Question, plan};
