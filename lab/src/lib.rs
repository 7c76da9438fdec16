//! The host tool of palpate, as a library so that its binaries and tests share it.

pub mod device;
pub mod error;
pub mod page;
pub mod tools;
