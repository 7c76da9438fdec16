//! The host tool `palpate`.

use std::process::ExitCode;

fn main() -> ExitCode {
    palpate_lab::cli::run()
}
