//! `palpate calibrate`: from a file that a person writes to the block that a drive reads.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Args;
use palpate_drive::{CALIBRATION_BYTES, Calibration};

use crate::error::InputError;
use crate::outfile::OutFile;

/// Make the calibration block that a drive reads from its flash
#[derive(Debug, Clone, Args)]
pub struct CalibrateArgs {
    /// The calibration, as docs/drive.md has it; without it an example is printed
    #[arg(value_name = "CALIBRATION.toml")]
    pub calibration: Option<PathBuf>,
    /// The block to write, for the flash at 0x080E0000
    #[arg(long, value_name = "CALIBRATION.bin", required_unless_present = "example", requires = "calibration")]
    pub out: Option<PathBuf>,
    /// Print an example to copy
    #[arg(long)]
    pub example: bool,
}

/// Runs `palpate calibrate`.
///
/// # Errors
/// The file is at fault, or the block cannot be written.
pub fn run(args: &CalibrateArgs) -> Result<()> {
    let (Some(path), Some(out)) = (&args.calibration, &args.out) else {
        print!("{}", toml::to_string(&Calibration::DEFAULT).context("the default calibration is no TOML")?);
        return Ok(());
    };
    let fault = |found: String, expected: &str| InputError::new(path.display(), found, expected);
    let text = std::fs::read_to_string(path).map_err(|error| fault(error.to_string(), "a calibration"))?;
    let calibration: Calibration = toml::from_str(&text).map_err(|error| {
        fault(error.to_string().trim_end().to_owned(), "a calibration as `palpate calibrate --example` prints it")
    })?;
    calibration.check().map_err(|error| fault(format!("{} out of range", error.parameter), error.expected))?;
    let mut buffer = [0; CALIBRATION_BYTES];
    let block = calibration.write(&mut buffer).context("the calibration does not fit its block")?;
    let mut file = OutFile::create(out)?;
    file.write_all(block).map_err(|error| file.fault(&error))?;
    file.commit()?;
    Ok(())
}
