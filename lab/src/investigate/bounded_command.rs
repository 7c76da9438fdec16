//! A command of the user that ends by itself, is asked to end, or is ended.

use std::io;
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::interrupt::{Process, ask_to_end, end_group, leads_its_group};

/// Time between two looks at whether it has ended.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// What a command is bounded by.
pub struct Bounds<'a> {
    /// How long it may take. It is asked to end then, as by Ctrl-C, so that it can bring its rig to rest.
    pub longest: Duration,
    /// How long it may take to end once it was asked, before it is ended with all that it has started.
    pub grace: Duration,
    /// Set once the user wants to stop: it is asked to end, and has all the time it needs.
    pub interrupted: &'a AtomicBool,
}

/// How it ended.
#[derive(Debug)]
pub enum Ended {
    /// By itself, or as the user asked.
    ByItself(ExitStatus),
    /// Because it took too long.
    OutOfTime,
}

/// Runs `command` within `bounds`.
///
/// # Errors
/// It cannot be started or waited for.
pub fn run(command: &mut Command, bounds: &Bounds<'_>) -> io::Result<Ended> {
    let mut child = leads_its_group(command).spawn()?;
    let _registered = Process::new(&child);
    let began = Instant::now();
    let mut is_asked = false;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Ended::ByItself(status));
        }
        if !is_asked && bounds.interrupted.load(Ordering::Relaxed) {
            ask_to_end(child.id());
            is_asked = true;
        }
        if !is_asked && began.elapsed() >= bounds.longest {
            bring_to_an_end(&mut child, bounds.grace)?;
            return Ok(Ended::OutOfTime);
        }
        std::thread::sleep(LOOK_EVERY);
    }
}

fn bring_to_an_end(child: &mut Child, grace: Duration) -> io::Result<()> {
    ask_to_end(child.id());
    let asked = Instant::now();
    while child.try_wait()?.is_none() && asked.elapsed() < grace {
        std::thread::sleep(LOOK_EVERY);
    }
    // What it has started can outlive it, and would go on moving the rig.
    end_group(child.id());
    child.kill().and_then(|()| child.wait()).map(|_| ())
}
