//! Real recordings under the same protocol: what their makers report of them is the concealed answer.
//!
//! Each specimen has the linear rig file of `lab/rigs/` and some of its trials in a folder of its own; what is known of it is
//! committed to with the answers of the drawn cases; the diagnosis is the command that a user runs. Where a specimen has
//! several trials, or one with several strokes, half of them are diagnosed and the identified model is scored on the others,
//! with nothing refitted.

pub mod grade;
pub mod held_out;
pub mod known_physics;
pub mod run_diagnosis;
pub mod specimen;
pub mod specimen_score;
pub mod stroke_split;
pub mod table;
