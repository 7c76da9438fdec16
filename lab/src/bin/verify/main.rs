//! `cargo verify`: every check there is, with its own set-up. `--strict` fails where a check had to be left out.

mod tree;

use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use palpate_cases::python;
use palpate_lab::qemu_bench::project;
use palpate_lab::recordings_folder;
use palpate_lab::tools::{self, Leave, Missing, TARGET};

/// Name, arguments of cargo, and variables of the environment.
struct Check {
    name: &'static str,
    arguments: Vec<&'static str>,
    variables: Vec<(&'static str, OsString)>,
}

fn main() -> ExitCode {
    let strict = match std::env::args().skip(1).collect::<Vec<_>>().as_slice() {
        [] => false,
        [flag] if flag == "--strict" => true,
        other => {
            eprintln!("verify: found {}, expected nothing or --strict", other.join(" "));
            return ExitCode::from(2);
        }
    };
    match verify(strict) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("verify: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn verify(strict: bool) -> anyhow::Result<bool> {
    println!(
        "verify: formatting, lints, documentation and all tests; 10 minutes of processor time or more from nothing"
    );
    announce("set-up: what is needed beside Rust (a gigabyte of other simulators for Python is the largest)");
    let folder = project()?;
    let (checks, left_out) = set_up(&folder);
    let mut failed = Vec::new();
    announce("source tree: no symbolic link, no path of a machine");
    if let Err(error) = tree::check(&folder) {
        println!("{error:#}\n== source tree: FAILED");
        failed.push("source tree");
    }
    let count = checks.len();
    for (at, check) in checks.into_iter().enumerate() {
        announce(&format!("{} of {count}, {}: cargo {}", at + 1, check.name, check.arguments.join(" ")));
        let since = Instant::now();
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        let done = cargo.args(&check.arguments).envs(check.variables).current_dir(&folder).status()?;
        let outcome = if done.success() { "passed" } else { "FAILED" };
        println!("== {}: {outcome} after {:.0} s", check.name, since.elapsed().as_secs_f64());
        if !done.success() {
            failed.push(check.name);
        }
    }
    println!("\nfailed: {}", if failed.is_empty() { "nothing".to_owned() } else { failed.join(", ") });
    left_out.iter().for_each(|what| println!("left out: {what}"));
    // They are nobody's to install: leaving them out is no failure of a strict run.
    if recordings_folder::folder().is_none() {
        println!("left out: the tests on real recordings; {}", recordings_folder::ADVICE);
    }
    Ok(failed.is_empty() && (left_out.is_empty() || !strict))
}

/// Says what comes next, at once.
fn announce(next: &str) {
    println!("\n== {next}");
}

/// Sets up what the checks need; the checks that can run, and what has to be left out.
fn set_up(folder: &Path) -> (Vec<Check>, Vec<String>) {
    let mut left_out = Vec::new();
    let mut ready = |what: &str, found: Result<(), String>| match found {
        Ok(()) => true,
        Err(missing) => {
            left_out.push(format!("{what}: {missing}"));
            false
        }
    };
    let in_words = |found: Result<(), Missing>| found.map_err(|missing| missing.to_string());
    let rustfmt = ready("formatting", in_words(tools::component("rustfmt", "fmt", Leave::Install)));
    let clippy = ready("lints", in_words(tools::component("clippy", "clippy", Leave::Install)));
    let target = ready("the device's image", in_words(tools::cross_target(Leave::Install)));
    let qemu = ready("the device's tests", in_words(tools::qemu(Leave::Install).map(drop)));
    let disassembler = ready("what the device's code costs", in_words(tools::disassembler(Leave::Install).map(drop)));
    for (what, packages) in [
        ("the tests in MuJoCo, Drake and Exudyn", &python::SIMULATORS),
        ("the tests of PySINDy and SysIdentPy", &python::BASELINES),
        ("the tests of the Python package and its notebook", &tools::PYTHON_TESTS),
    ] {
        let found = python::set_up(&folder.join("target").join("python"), packages);
        ready(what, found.map(drop).map_err(|missing| missing.to_string()));
    }
    (checks(rustfmt, clippy, target, target & qemu & disassembler), left_out)
}

/// All of them share the profile of the tool, so that no package is compiled a second time for another.
fn checks(rustfmt: bool, clippy: bool, target: bool, device: bool) -> Vec<Check> {
    let check = |name, arguments: &[&'static str]| Check { name, arguments: arguments.to_vec(), variables: Vec::new() };
    let mut checks = Vec::new();
    if rustfmt {
        checks.push(check("formatting", &["fmt", "--all", "--check"]));
    }
    if clippy {
        checks.push(check("lints", &["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"]));
    }
    if clippy && target {
        let image = [
            "clippy",
            "--release",
            "--package",
            "palpate",
            "--package",
            "palpate-drive",
            "--package",
            "palpate-firmware",
            "--lib",
            "--bins",
            "--target",
            TARGET,
            "--",
            "-D",
            "warnings",
        ];
        checks.push(check("lints of the images", &image));
        let baselines =
            ["clippy", "--release", "--package", "palpate-baselines", "--lib", "--examples", "--target", TARGET];
        checks.push(check("lints of the baselines' image", &[&baselines[..], &["--", "-D", "warnings"]].concat()));
    }
    let documentation =
        check("documentation", &["doc", "--release", "--workspace", "--no-deps", "--document-private-items"]);
    checks.push(Check { variables: vec![("RUSTDOCFLAGS", "-D warnings".into())], ..documentation });
    let tests = check("tests", &["test", "--release", "--workspace", "--no-fail-fast"]);
    let mut variables = if device { vec![("PALPATE_DEVICE", "required".into())] } else { Vec::new() };
    // The tests build the command beside this program; the Python package is held against it.
    let command = std::env::current_exe().map(|verify| verify.with_file_name(format!("palpate{EXE_SUFFIX}")));
    variables.extend(command.ok().map(|command| ("PALPATE_COMMAND", command.into_os_string())));
    checks.push(Check { variables, ..tests });
    checks
}
