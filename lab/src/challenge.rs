//! `palpate challenge`: the diagnosis is put to recordings whose missing effect is concealed from it.
//!
//! Cases are drawn from a seed and written as plain recordings, each in a folder of its own; the answers are committed to by
//! a SHA-256 before the first diagnosis; each case is diagnosed by the very command that a user runs; then the seal is
//! opened and the answers are scored. The generator of the cases shares no code of an effect with the diagnosis, and half of
//! the whole list is played by simulators that nobody here wrote. Real recordings, where there are any, pass through the same
//! protocol beside them: what is known of them is the concealed answer.

pub mod aim;
pub mod bic;
mod command;
pub mod draft;
pub mod examination;
pub mod files;
pub mod interval;
pub mod page;
pub mod plan;
mod protocol;
pub mod recorded;
pub mod rival;
pub mod row;
pub mod score;
pub mod seal;
pub mod summary;
pub mod told;
pub mod values;

pub use command::{ChallengeArgs, run};
