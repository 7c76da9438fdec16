//! The page of an investigation.

use std::io::{self, Write};
use std::path::Path;

use super::record::Investigation;
use crate::rig::Rig;

/// Writes the page.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(investigation: &Investigation, rig: &Rig, folder: &Path, out: &mut impl Write) -> io::Result<()> {
    let _ = (investigation, rig, folder);
    out.write_all(b"")
}
