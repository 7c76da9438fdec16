//! Real recordings under the same protocol: what their makers know of them is the concealed answer.
//!
//! Each specimen is an entry: the linear rig of `lab/rigs/` and some of its trials go to a folder of their own, what is known
//! is sealed with the answers of the drawn cases, the diagnosis is the command that a user runs. Where a specimen has several
//! trials, or one with several strokes, half of them teach and the others are scored by what was learnt, nothing fitted.

pub mod entry;
pub mod examination;
pub mod judge;
pub mod known;
pub mod part;
pub mod row;
pub mod table;
pub mod unseen;
