//! The image in QEMU, twice: counted by a plugin, and by the emulator's own clock.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use palpate_drive::replay_format::{CONFIG_BYTES, encode_config, encode_sample};

use super::cycles::cost;
use super::image::Image;
use super::trial;
use crate::interrupt::{self, Temporary};
use crate::qemu_bench;

/// Runs the image and hands out what it and the plugin wrote.
pub struct Emulator {
    qemu: PathBuf,
    counter: PathBuf,
    folder: tempfile::TempDir,
    _removed_by_a_signal: Temporary,
}

impl Emulator {
    /// Builds the plugin and lays out the recording.
    ///
    /// # Errors
    /// The plugin does not build, or the disk is full.
    pub fn prepare(qemu: PathBuf) -> Result<Self> {
        let counter = counter()?;
        let folder = tempfile::tempdir().context("cannot make a folder for the image's files")?;
        let mut buffer = [0; CONFIG_BYTES + 4];
        let mut input = encode_config(&trial::config(), &mut buffer).context("the settings do not fit")?.to_vec();
        input.extend(trial::samples()?.iter().flat_map(encode_sample));
        std::fs::write(folder.path().join("profile.in"), input).context("cannot write the image's input")?;
        let _removed_by_a_signal = Temporary::new(folder.path());
        Ok(Self { qemu, counter, folder, _removed_by_a_signal })
    }

    /// What the plugin counted: its file's text.
    ///
    /// # Errors
    /// QEMU or the image fails.
    pub fn with_plugin(&self, image: &Image) -> Result<String> {
        let costs = self.folder.path().join("costs");
        std::fs::write(&costs, table(image)).context("cannot write the costs")?;
        let counts = self.folder.path().join("counts");
        let plugin = format!(
            "{},begin={},end={},case={},costs={},out={}",
            self.counter.display(),
            image.label("palpate_begin")?,
            image.label("palpate_end")?,
            image.label("palpate_case")?,
            costs.display(),
            counts.display()
        );
        self.run(image, &["-plugin", &plugin])?;
        std::fs::read_to_string(&counts).context("the plugin wrote no counts")
    }

    /// What the image read from its own clock: its file's text. One instruction is 64 ns of it, 10.752 ticks.
    ///
    /// # Errors
    /// QEMU or the image fails.
    pub fn with_clock(&self, image: &Image) -> Result<String> {
        self.run(image, &["-icount", "shift=6,sleep=off"])?;
        std::fs::read_to_string(self.folder.path().join("profile.out")).context("the image wrote no output")
    }

    fn run(&self, image: &Image, arguments: &[&str]) -> Result<()> {
        let path: &Path = &image.path;
        let mut command = Command::new(&self.qemu);
        command
            .args(["-machine", "netduinoplus2", "-display", "none", "-monitor", "none", "-serial", "none"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .args(arguments)
            .arg("-kernel")
            .arg(path.canonicalize().with_context(|| format!("{} is gone", path.display()))?)
            .current_dir(self.folder.path())
            .stdin(Stdio::null());
        let output = interrupt::output(&mut command).with_context(|| format!("cannot run {}", self.qemu.display()))?;
        let said = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "the image gave up ({}): {}", output.status, said.trim());
        Ok(())
    }
}

/// Builds the plugin.
pub(super) fn counter() -> Result<PathBuf> {
    let library = |message: &serde_json::Value| {
        let files = message["filenames"].as_array()?.iter().filter_map(|file| file.as_str());
        files.map(PathBuf::from).find(|file| file.extension().is_some_and(|e| e == "so" || e == "dylib" || e == "dll"))
    };
    qemu_bench::cargo(&["--release", "--package", "palpate-counter"], "palpate_counter", library)
}

/// One line an instruction: address, bytes, least and most cycles, saved behind an access, an access itself, registers read
/// and written late.
pub(super) fn table(image: &Image) -> String {
    let mut text = String::new();
    for (address, instruction) in &image.code {
        let c = cost(instruction);
        let memory = u32::from(c.memory);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{address} {} {} {} {} {memory} {} {}",
            instruction.size, c.band[0], c.band[1], c.paired, c.reads, c.writes
        );
    }
    text
}
