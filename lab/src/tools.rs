//! What the project needs beside Rust: the cross target, QEMU and a disassembler. Found, installed where that is allowed, or asked for.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use palpate_cases::python::Packages;

/// The target of the images.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The emulator of the board.
pub const QEMU: &str = "qemu-system-arm";

/// The disassembler of the images.
pub const DISASSEMBLER: &str = "llvm-objdump";

/// Set to anything: nothing is installed, only asked for.
pub const NO_INSTALL: &str = "PALPATE_NO_INSTALL";

/// Whether a tool that is not there may be installed. [`NO_INSTALL`] overrules it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leave {
    /// Install what is missing, saying so.
    Install,
    /// Only look: a test changes nothing on the machine.
    Look,
}

/// What the tests of the Python package and its notebook need beside the package.
pub const PYTHON_TESTS: Packages = Packages {
    name: "package",
    purpose: "to test the Python package and to run its notebook",
    size_mb: 410,
    requirements: include_str!("../proofs/requirements.txt"),
    scripts: &[],
};

/// A tool that is not there and could not be installed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} is missing ({why}); install it with: {command}")]
pub struct Missing {
    /// The tool.
    pub what: &'static str,
    /// Why it was not installed.
    pub why: String,
    /// What a person should run.
    pub command: String,
}

/// All that is missing for one purpose.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct MissingTools(pub Vec<Missing>);

/// Finds or installs what building and running the device's image takes; QEMU's path.
///
/// # Errors
/// All that is not there and cannot be installed, so that a person is asked once.
pub fn for_the_device(leave: Leave) -> Result<PathBuf, MissingTools> {
    match (cross_target(leave), qemu(leave)) {
        (Ok(()), Ok(qemu)) => Ok(qemu),
        (target, qemu) => Err(MissingTools(target.err().into_iter().chain(qemu.err()).collect())),
    }
}

/// As [`for_the_device`], with the disassembler that counting instructions takes; QEMU's path.
///
/// # Errors
/// All that is not there and cannot be installed.
pub fn for_profiling(leave: Leave) -> Result<PathBuf, MissingTools> {
    match (for_the_device(leave), disassembler(leave)) {
        (Ok(qemu), Ok(_)) => Ok(qemu),
        (device, disassembler) => {
            let missing = device.err().map_or_else(Vec::new, |MissingTools(missing)| missing);
            Err(MissingTools(missing.into_iter().chain(disassembler.err()).collect()))
        }
    }
}

/// Finds the cross target, or adds it by rustup.
///
/// # Errors
/// It is not there and cannot be added.
pub fn cross_target(leave: Leave) -> Result<(), Missing> {
    if target_is_installed() {
        return Ok(());
    }
    let command = ["rustup", "target", "add", TARGET];
    let missing =
        |why: String| Missing { what: "the Rust target thumbv7em-none-eabihf", why, command: command.join(" ") };
    if let Some(why) = leave.refused() {
        return Err(missing(why));
    }
    if which::which("rustup").is_err() {
        return Err(missing("there is no rustup on this machine".to_owned()));
    }
    install("the Rust target thumbv7em-none-eabihf", "to build the device's image", &command).map_err(&missing)?;
    if target_is_installed() { Ok(()) } else { Err(missing("rustup added it, yet rustc does not have it".to_owned())) }
}

/// The target's own core library stands in the sysroot, whoever put it there.
fn target_is_installed() -> bool {
    rustlib().is_some_and(|rustlib| rustlib.join(TARGET).join("lib").is_dir())
}

/// The folder of the toolchain that holds a folder for each target.
fn rustlib() -> Option<PathBuf> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).args(["--print", "sysroot"]).output().ok()?;
    Some(PathBuf::from(String::from_utf8_lossy(&output.stdout).trim()).join("lib/rustlib"))
}

/// Finds `llvm-objdump`, the toolchain's own or the system's, or adds the toolchain's by rustup.
///
/// # Errors
/// It is not there and cannot be added.
pub fn disassembler(leave: Leave) -> Result<PathBuf, Missing> {
    if let Some(found) = find_disassembler() {
        return Ok(found);
    }
    let command = ["rustup", "component", "add", "llvm-tools"];
    let missing = |why: String| Missing { what: DISASSEMBLER, why, command: command.join(" ") };
    if let Some(why) = leave.refused() {
        return Err(missing(why));
    }
    install(DISASSEMBLER, "to count what an image executes", &command).map_err(missing)?;
    find_disassembler().ok_or_else(|| missing("rustup added llvm-tools, yet it is not in the toolchain".to_owned()))
}

/// The toolchain's own first: it knows what its compiler makes. It stands in the folder of the host, one of few.
fn find_disassembler() -> Option<PathBuf> {
    let folders = rustlib().and_then(|rustlib| std::fs::read_dir(rustlib).ok()).into_iter().flatten().flatten();
    let file = format!("{DISASSEMBLER}{}", std::env::consts::EXE_SUFFIX);
    let mut candidates = folders.map(|folder| folder.path().join("bin").join(&file));
    candidates.find(|candidate| candidate.is_file()).or_else(|| which::which(DISASSEMBLER).ok())
}

/// Finds QEMU, or installs it by the system's package manager.
///
/// # Errors
/// It is not there and may not be, or could not be, installed.
pub fn qemu(leave: Leave) -> Result<PathBuf, Missing> {
    if let Ok(found) = which::which(QEMU) {
        return Ok(found);
    }
    let manager = Manager::ALL.into_iter().find(|manager| which::which(manager.program()).is_ok());
    let Some(manager) = manager else {
        return Err(Missing {
            what: QEMU,
            why: "no package manager is known here".to_owned(),
            command: "see https://www.qemu.org/download".to_owned(),
        });
    };
    let missing = |why: String| Missing { what: QEMU, why, command: manager.advice() };
    if let Some(why) = leave.refused() {
        return Err(missing(why));
    }
    let rights = manager.rights(is_root(), may_sudo());
    let Some(prefix) = rights else {
        return Err(missing("installing it needs the rights of root".to_owned()));
    };
    for step in manager.steps() {
        let command: Vec<&str> = prefix.iter().copied().chain(step.iter().copied()).collect();
        install(QEMU, "to run the device's image without a board", &command).map_err(missing)?;
    }
    which::which(QEMU).map_err(|_| missing("the package was installed, yet it is not on the PATH".to_owned()))
}

/// Finds a component of the toolchain by the command that it brings, or adds it by rustup.
///
/// # Errors
/// It is not there and cannot be added.
pub fn component(name: &'static str, subcommand: &str, leave: Leave) -> Result<(), Missing> {
    let works = || {
        let mut command = Command::new("cargo");
        command.args([subcommand, "--version"]).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    if works() {
        return Ok(());
    }
    let command = ["rustup", "component", "add", name];
    let missing = |why: String| Missing { what: name, why, command: command.join(" ") };
    match leave.refused() {
        Some(why) => Err(missing(why)),
        None => install(name, "to check the sources", &command).map_err(missing),
    }
}

impl Leave {
    /// Why nothing is installed, `None` where it may be.
    fn refused(self) -> Option<String> {
        match self {
            Self::Look => Some("nothing is installed by a test".to_owned()),
            Self::Install => std::env::var_os(NO_INSTALL).map(|_| format!("{NO_INSTALL} is set")),
        }
    }
}

/// A system's package manager.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manager {
    Apt,
    Dnf,
    Pacman,
    Brew,
}

impl Manager {
    const ALL: [Self; 4] = [Self::Apt, Self::Dnf, Self::Pacman, Self::Brew];

    fn program(self) -> &'static str {
        match self {
            Self::Apt => "apt-get",
            Self::Dnf => "dnf",
            Self::Pacman => "pacman",
            Self::Brew => "brew",
        }
    }

    /// The commands, one after the other.
    fn steps(self) -> &'static [&'static [&'static str]] {
        match self {
            Self::Apt => {
                &[&["apt-get", "update"], &["apt-get", "install", "-y", "--no-install-recommends", "qemu-system-arm"]]
            }
            Self::Dnf => &[&["dnf", "install", "-y", "qemu-system-arm"]],
            Self::Pacman => &[&["pacman", "-S", "--noconfirm", "--needed", "qemu-system-arm"]],
            Self::Brew => &[&["brew", "install", "qemu"]],
        }
    }

    /// What goes before the commands, `None` where they may not be run: root needs nothing, others sudo without a
    /// password (a prompt would hang a script); Homebrew refuses root and needs nobody's leave.
    fn rights(self, root: bool, sudo: bool) -> Option<&'static [&'static str]> {
        match self {
            Self::Brew => Some(&[]),
            _ if root => Some(&[]),
            _ if sudo => Some(&["sudo", "-n"]),
            _ => None,
        }
    }

    fn advice(self) -> String {
        let sudo = if self == Self::Brew { "" } else { "sudo " };
        self.steps().iter().map(|step| format!("{sudo}{}", step.join(" "))).collect::<Vec<_>>().join(" && ")
    }
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

fn may_sudo() -> bool {
    let quiet = Command::new("sudo").args(["-n", "true"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    quiet.is_ok_and(|status| status.success())
}

/// Runs an installation, announced beforehand; what it prints goes to standard error.
fn install(what: &str, why: &str, command: &[&str]) -> Result<(), String> {
    let Some((program, arguments)) = command.split_first() else {
        return Err("there is no command for it".to_owned());
    };
    eprintln!("installing {what}, {why}: {}", command.join(" "));
    let output = Command::new(program)
        .args(arguments)
        .env("DEBIAN_FRONTEND", "noninteractive")
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("`{}` could not be run: {error}", command.join(" ")))?;
    if output.status.success() {
        return Ok(());
    }
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    Err(format!("`{}` failed with {}", command.join(" "), output.status))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_asked_for_a_password_and_the_advice_can_be_pasted() {
        assert_eq!(Manager::Apt.rights(true, false), Some(&[][..]));
        assert_eq!(Manager::Apt.rights(false, true), Some(&["sudo", "-n"][..]));
        assert_eq!(Manager::Apt.rights(false, false), None);
        assert_eq!(Manager::Brew.rights(false, false), Some(&[][..]));
        assert_eq!(
            Manager::Apt.advice(),
            "sudo apt-get update && sudo apt-get install -y --no-install-recommends qemu-system-arm"
        );
        assert_eq!(Manager::Brew.advice(), "brew install qemu");
    }
}
