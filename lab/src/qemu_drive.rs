//! A drive in QEMU: the image that a board is flashed with, its serial line on a socket.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};

use crate::interrupt::{Process, Temporary};
use crate::listen::{Client, open};
use crate::qemu_bench;
use crate::tools::{self, Leave};

/// How long the emulator may take to open its socket.
const TIMEOUT: Duration = Duration::from_secs(20);

/// How the emulated core sleeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClockMode {
    /// By the wall clock, as a board does. A host that wakes late is then an interrupt that comes late.
    Wall,
    /// Not at all: every tick comes exactly when it is due, as fast as the host can go.
    Exact,
}

/// A running drive. It ends with this value.
pub struct QemuDrive {
    child: Child,
    folder: tempfile::TempDir,
    /// Whoever ends the tool by a signal leaves no emulator behind.
    _registered: (Process, Temporary),
}

/// The image and the emulator that runs it.
pub struct DriveImage {
    qemu: PathBuf,
    /// The image's file.
    pub path: PathBuf,
}

impl DriveImage {
    /// Finds the tools and builds the image.
    ///
    /// # Errors
    /// A tool is missing (as [`tools::MissingTools`]), or the build fails.
    pub fn prepare(leave: Leave) -> Result<Self> {
        Ok(Self { qemu: tools::for_the_device(leave)?, path: qemu_bench::build("palpate-firmware", "--bin", "drive")? })
    }

    /// Starts the drive, with `calibration` in its flash where there is one, and `arguments` more for QEMU.
    ///
    /// Eight nanoseconds an instruction by the emulator's clock: a tick has 125 000 instructions.
    ///
    /// # Errors
    /// QEMU does not start.
    pub fn start(&self, pace: ClockMode, calibration: Option<&[u8]>, arguments: &[&str]) -> Result<QemuDrive> {
        let folder = tempfile::tempdir().context("cannot make a folder for the drive's socket")?;
        let socket = folder.path().join("line");
        let mut command = Command::new(&self.qemu);
        let clock = match pace {
            ClockMode::Wall => "shift=3",
            ClockMode::Exact => "shift=3,sleep=off",
        };
        command
            .args(["-machine", "netduinoplus2", "-display", "none", "-monitor", "stdio", "-icount", clock])
            .arg("-chardev")
            .arg(format!("socket,id=line,path={},server=on,wait=off", socket.display()))
            .args(["-serial", "chardev:line"])
            .args(arguments)
            .arg("-kernel")
            .arg(self.path.canonicalize().with_context(|| format!("{} is gone", self.path.display()))?);
        if let Some(block) = calibration {
            let file = folder.path().join("calibration.bin");
            std::fs::write(&file, block).context("cannot write the calibration")?;
            command.arg("-device").arg(format!("loader,file={},addr=0x080e0000,force-raw=on", file.display()));
        }
        let child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::inherit())
            .spawn()
            .with_context(|| format!("cannot run {}", self.qemu.display()))?;
        let registered = (Process::new(&child), Temporary::new(folder.path()));
        let mut drive = QemuDrive { child, folder, _registered: registered };
        drive.wait()?;
        Ok(drive)
    }
}

impl QemuDrive {
    fn wait(&mut self) -> Result<()> {
        let since = Instant::now();
        while !self.socket().exists() {
            if let Some(status) = self.child.try_wait().context("the emulator cannot be waited for")? {
                bail!("the emulator ended with {status}");
            }
            if since.elapsed() > TIMEOUT {
                bail!("the emulator opened no socket for {} s", TIMEOUT.as_secs());
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        Ok(())
    }

    /// The socket of its serial line.
    #[must_use]
    pub fn socket(&self) -> PathBuf {
        self.folder.path().join("line")
    }

    /// A client on the line, once the drive answers.
    ///
    /// # Errors
    /// The emulator is gone, or the drive does not answer.
    pub fn client(&self) -> Result<Client> {
        let path: &Path = &self.socket();
        let since = Instant::now();
        loop {
            // The socket is there a moment before somebody listens on it.
            match open(path, 0) {
                Ok(port) => {
                    let mut client = Client::new(port);
                    client.wake()?;
                    return Ok(client);
                }
                Err(error) if since.elapsed() > TIMEOUT => return Err(error.into()),
                Err(_) => std::thread::sleep(Duration::from_millis(10)),
            }
        }
    }

    /// Lets it end in order, so that a plugin writes what it counted.
    ///
    /// # Errors
    /// It does not end.
    pub fn quit(mut self) -> Result<()> {
        let mut monitor = self.child.stdin.take().context("the emulator has no monitor")?;
        monitor.write_all(b"quit\n").and_then(|()| monitor.flush()).context("the emulator's monitor is gone")?;
        let since = Instant::now();
        while self.runs()? {
            if since.elapsed() > TIMEOUT {
                bail!("the emulator does not end");
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        Ok(())
    }

    /// Whether it still runs.
    ///
    /// # Errors
    /// It cannot be asked.
    pub fn runs(&mut self) -> Result<bool> {
        Ok(self.child.try_wait().context("the emulator cannot be waited for")?.is_none())
    }
}

impl Drop for QemuDrive {
    fn drop(&mut self) {
        // Killing fails only where it has ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
