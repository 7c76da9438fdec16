//! The table of `palpate` beside its baselines: `cargo run --release -p palpate-baselines`; with `--document` its rows are
//! written into docs/profile.md.

#[cfg(not(target_os = "none"))]
mod accuracy;
#[cfg(not(target_os = "none"))]
mod table;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => table::print(),
        ["--document"] => table::write(),
        _ => Err(anyhow::anyhow!("nothing, or --document")),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("baselines: {error:#}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// The table is made on the host.
#[cfg(target_os = "none")]
fn main() {}
