//! `cargo verify`: every check there is, with its own set-up. `--strict` fails where a check had to be left out.

mod tree;

use std::process::{Command, ExitCode};
use std::time::Instant;

use palpate_cases::python;
use palpate_lab::device::project;
use palpate_lab::recordings_folder;
use palpate_lab::tools::{self, Leave, Missing, TARGET};

/// Name, arguments of cargo, and variables of the environment.
struct Check {
    name: &'static str,
    arguments: Vec<&'static str>,
    variables: Vec<(&'static str, &'static str)>,
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
    let mut left_out = Vec::new();
    let mut ready = |what: &str, found: Result<(), String>| match found {
        Ok(()) => true,
        Err(missing) => {
            left_out.push(format!("{what}: {missing}"));
            false
        }
    };
    let told = |found: Result<(), Missing>| found.map_err(|missing| missing.to_string());
    let rustfmt = ready("formatting", told(tools::component("rustfmt", "fmt", Leave::Install)));
    let clippy = ready("lints", told(tools::component("clippy", "clippy", Leave::Install)));
    let target = ready("the device's image", told(tools::cross_target(Leave::Install)));
    let qemu = ready("the device's tests", told(tools::qemu(Leave::Install).map(drop)));
    let disassembler = ready("what the device's code costs", told(tools::disassembler(Leave::Install).map(drop)));
    let device = target & qemu & disassembler;
    let folder = project()?;
    for (what, packages) in [
        ("the tests in MuJoCo, Drake and Exudyn", &python::SIMULATORS),
        ("the tests of PySINDy and SysIdentPy", &python::BASELINES),
    ] {
        let found = python::set_up(&folder.join("target").join("python"), packages);
        ready(what, found.map(drop).map_err(|missing| missing.to_string()));
    }
    let mut failed = Vec::new();
    println!("\n== source tree: no symbolic link, no path of a machine");
    if let Err(error) = tree::check(&folder) {
        println!("{error:#}\n== source tree: FAILED");
        failed.push("source tree");
    }
    for check in checks(rustfmt, clippy, target, device) {
        println!("\n== {}: cargo {}", check.name, check.arguments.join(" "));
        let since = Instant::now();
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        let done = cargo.args(&check.arguments).envs(check.variables).current_dir(&folder).status()?;
        println!(
            "== {}: {} after {:.0} s",
            check.name,
            if done.success() { "passed" } else { "FAILED" },
            since.elapsed().as_secs_f64()
        );
        if !done.success() {
            failed.push(check.name);
        }
    }
    println!("\nfailed: {}", if failed.is_empty() { "nothing".to_owned() } else { failed.join(", ") });
    left_out.iter().for_each(|what| println!("left out: {what}"));
    if recordings_folder::folder().is_none() {
        println!("left out: the tests on real recordings; {}", recordings_folder::ADVICE);
    }
    Ok(failed.is_empty() && (left_out.is_empty() || !strict))
}

fn checks(rustfmt: bool, clippy: bool, target: bool, device: bool) -> Vec<Check> {
    let check = |name, arguments: &[&'static str]| Check { name, arguments: arguments.to_vec(), variables: Vec::new() };
    let mut checks = Vec::new();
    if rustfmt {
        checks.push(check("formatting", &["fmt", "--all", "--check"]));
    }
    if clippy {
        checks.push(check("lints", &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]));
    }
    if clippy && target {
        let image = [
            "clippy",
            "--package",
            "palpate",
            "--package",
            "palpate-rivals",
            "--lib",
            "--examples",
            "--target",
            TARGET,
            "--",
            "-D",
            "warnings",
        ];
        checks.push(check("lints of the image", &image));
    }
    let documentation = check("documentation", &["doc", "--workspace", "--no-deps", "--document-private-items"]);
    checks.push(Check { variables: vec![("RUSTDOCFLAGS", "-D warnings")], ..documentation });
    let tests = check("tests", &["test", "--workspace", "--no-fail-fast"]);
    let variables = if device { vec![("PALPATE_DEVICE", "required")] } else { Vec::new() };
    checks.push(Check { variables, ..tests });
    checks
}
