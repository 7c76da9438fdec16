//! Ctrl-C and a request to end: nothing half-written and no emulator is left behind.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Exit status of a command that was interrupted: 128 and the number of SIGINT, as shells have it.
const INTERRUPTED: i32 = 130;

/// What is to be cleared away, and who ends by himself.
struct Registry {
    paths: Vec<PathBuf>,
    processes: Vec<u32>,
    flag: Option<Arc<AtomicBool>>,
}

static REGISTRY: Mutex<Registry> = Mutex::new(Registry { paths: Vec::new(), processes: Vec::new(), flag: None });

fn registry() -> MutexGuard<'static, Registry> {
    // The lists are sound between any two statements that change them.
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes over Ctrl-C and, on Unix, SIGTERM and SIGHUP, for the whole process. Called once, by the command itself: a program that only
/// uses this library keeps its own handlers.
///
/// # Errors
/// Another handler is there already.
pub fn take_over() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(|| {
        let mut registry = registry();
        // The first signal asks a command that has a flag to end by itself.
        if registry.flag.as_ref().is_some_and(|flag| !flag.swap(true, Ordering::Relaxed)) {
            return;
        }
        registry.processes.drain(..).for_each(end);
        registry.paths.drain(..).for_each(|path| remove(&path));
        std::process::exit(INTERRUPTED);
    })
}

/// A flag that the first signal sets from now on; only a second one ends the process.
#[must_use]
pub fn flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    registry().flag = Some(Arc::clone(&flag));
    flag
}

/// A file or folder that a signal removes, until this is dropped.
#[derive(Debug)]
pub struct Temporary(PathBuf);

impl Temporary {
    /// Of the file or folder `path`.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        registry().paths.push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        registry().paths.retain(|path| *path != self.0);
    }
}

/// A process that a signal ends, until this is dropped.
#[derive(Debug)]
pub struct Process(u32);

impl Process {
    /// Of `child`.
    #[must_use]
    pub fn new(child: &Child) -> Self {
        registry().processes.push(child.id());
        Self(child.id())
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        registry().processes.retain(|process| *process != self.0);
    }
}

/// As [`Command::output`], ended by a signal.
///
/// # Errors
/// The command cannot be run.
pub fn output(command: &mut Command) -> io::Result<Output> {
    use std::process::Stdio;
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let _registered = Process::new(&child);
    child.wait_with_output()
}

/// `command` as the leader of a group of its own, with all that it starts: Ctrl-C does not reach it by itself.
#[cfg(unix)]
pub fn leads_its_group(command: &mut Command) -> &mut Command {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0)
}

/// A console tells its own processes.
#[cfg(not(unix))]
pub fn leads_its_group(command: &mut Command) -> &mut Command {
    command
}

/// Asks all of the group that `leader` leads to end, as Ctrl-C does.
pub fn ask_to_end(leader: u32) {
    signal::send_to_group(leader, signal::ASKS);
}

/// Ends all that is left of the group that `leader` leads, or led.
pub fn end_group(leader: u32) {
    signal::send_to_group(leader, signal::ENDS);
}

/// Ends `process`, and the group that it leads if it leads one. It may have ended by itself.
fn end(process: u32) {
    end_group(process);
    signal::end(process);
}

#[cfg(unix)]
mod signal {
    use nix::sys::signal::{Signal, kill, killpg};
    use nix::unistd::Pid;

    pub(super) const ASKS: Signal = Signal::SIGINT;
    pub(super) const ENDS: Signal = Signal::SIGKILL;

    pub(super) fn send_to_group(leader: u32, signal: Signal) {
        if let Ok(leader) = i32::try_from(leader) {
            let _ = killpg(Pid::from_raw(leader), signal);
        }
    }

    pub(super) fn end(process: u32) {
        if let Ok(process) = i32::try_from(process) {
            let _ = kill(Pid::from_raw(process), ENDS);
        }
    }
}

/// A console tells its own processes.
#[cfg(not(unix))]
mod signal {
    pub(super) const ASKS: () = ();
    pub(super) const ENDS: () = ();

    pub(super) fn send_to_group(_leader: u32, _signal: ()) {}

    pub(super) fn end(_process: u32) {}
}

/// It may have been moved into its place.
fn remove(path: &Path) {
    let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
}
