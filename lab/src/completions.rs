//! `palpate completions`: what a shell needs to complete the command line.

use std::io::Write as _;

use anyhow::{Context as _, Result};
use clap::Args;
use clap_complete::Shell;

/// Write completions for a shell
#[derive(Debug, Clone, Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Writes the completions of `command` to standard output.
///
/// # Errors
/// Standard output is closed.
pub fn run(args: &CompletionsArgs, mut command: clap::Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "palpate", &mut script);
    std::io::stdout().write_all(&script).context("standard output")
}
