//! `cargo demo`.

use std::process::ExitCode;

fn main() -> ExitCode {
    match palpate_lab::demo::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("demo: {error:#}");
            ExitCode::FAILURE
        }
    }
}
