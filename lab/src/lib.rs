//! The host tool of palpate, as a library so that its binaries and tests share it.

pub mod error;
pub mod page;
