//! The diagnosis as data, as a page, and as an improved rig file.

pub mod contact_map;
pub mod contact_report;
pub mod diagnosis;
pub mod drive_map;
pub mod drive_report;
pub mod html;
pub mod merge;
pub mod summary;
pub mod verdict;
