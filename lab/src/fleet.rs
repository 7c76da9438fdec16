//! `palpate diagnose-all`: the diagnosis of many rigs, one table and one page.
//!
//! A [`source`] lists the rigs. Each is diagnosed by the command that a user runs, in a process and a [`rig_folder`] of its own, so
//! that neither a file at fault nor a crash touches another rig, and what is done stays done ([`worker`]). The [`table`] has a row for
//! each value; [`changes`] compares two tables, [`outliers`] lists what stands out of one, the [`page`] shows both.

pub mod changes;
mod column;
mod command;
mod folder;
mod manifest;
pub mod outliers;
pub mod page;
mod parquet_table;
pub mod rig_folder;
pub mod row;
pub mod source;
pub mod table;
pub mod worker;

pub use command::{DiagnoseAllArgs, run};
