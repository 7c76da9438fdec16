//! The diagnosis as data, as a page, and as an improved rig file.

mod channel;
mod contact_findings;
mod contact_plot;
pub mod contact_report;
mod contact_residual;
pub mod contact_rig;
mod contact_values;
mod contact_wording;
mod correlation;
pub mod diagnosis;
mod drive_plot;
pub mod drive_report;
mod drive_residual;
pub mod html;
pub mod merge;
pub mod model_file;
pub mod recorded_motion;
mod residual_map;
pub mod summary;
mod traversals;
