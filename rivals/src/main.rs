//! The table of `palpate` beside its rivals: `cargo run --release -p palpate-rivals`.

#[cfg(not(target_os = "none"))]
mod accuracy;
#[cfg(not(target_os = "none"))]
mod table;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    match table::print() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rivals: {error:#}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// The table is made on the host.
#[cfg(target_os = "none")]
fn main() {}
