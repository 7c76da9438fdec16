//! `palpate schema`: the JSON schema of a report, made from the types that write it.

use std::io::Write as _;

use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use schemars::{Schema, schema_for};

use crate::diagnose;
use crate::profile;

/// Write the JSON schema of a report
#[derive(Debug, Clone, Args)]
pub struct SchemaArgs {
    /// The report
    #[arg(value_enum)]
    pub report: Report,
}

/// A report that is written as JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Report {
    /// `palpate diagnose --json`, palpate.diagnosis/1
    Diagnosis,
    /// `palpate profile --json`, palpate.profile/1
    Profile,
}

impl Report {
    /// Its schema (JSON Schema 2020-12).
    #[must_use]
    pub fn schema(self) -> Schema {
        match self {
            Self::Diagnosis => schema_for!(diagnose::Diagnosis),
            Self::Profile => profile::schema(),
        }
    }
}

/// Writes the schema to standard output.
///
/// # Errors
/// Standard output is closed.
pub fn run(args: &SchemaArgs) -> Result<()> {
    let text = serde_json::to_string_pretty(&args.report.schema())? + "\n";
    std::io::stdout().write_all(text.as_bytes()).context("standard output")
}
