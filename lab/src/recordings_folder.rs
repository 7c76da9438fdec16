//! Where real recordings are found. The repository holds none of them.

use std::path::PathBuf;

use crate::qemu_bench::project;

/// Names a folder of real recordings.
pub const VARIABLE: &str = "PALPATE_RECORDINGS";

/// What a person without them can do.
pub const ADVICE: &str = "PALPATE_RECORDINGS names the folder that holds them";

/// The folder of real recordings: where [`VARIABLE`] points, else beside the project in `shared/recordings`.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let named = std::env::var_os(VARIABLE).map(PathBuf::from);
    let beside = || Some(project().ok()?.parent()?.join("shared").join("recordings"));
    named.or_else(beside).filter(|folder| folder.is_dir())
}
