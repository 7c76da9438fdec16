//! The diagnosis as data, as a page, and as an improved rig file.

mod channel;
pub mod contact_report;
mod contact_residual;
pub mod diagnosis;
pub mod drive_report;
mod drive_residual;
pub mod html;
pub mod merge;
mod residual_map;
pub mod summary;
