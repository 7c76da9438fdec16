//! The diagnosis as data, as a page, and as an improved rig file.

pub mod build_report;
pub mod diagnosis;
pub mod drive_map;
pub mod drive_report;
pub mod html;
pub mod merge;
pub mod refined_rig;
pub mod residual_location;
pub mod summary;
