//! The bench image: built from the same sources, run under QEMU, fed and read by files.

use std::fs::File;
use std::io::{BufReader, BufWriter, IsTerminal as _, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use palpate::{EstimatorBankConfig, Methods, Sample};
use palpate_drive::replay_format::{
    CONFIG_BYTES, COUNTER_BYTES, ReplayCounters, UpdateResult, decode_counters, decode_record, encode_config,
    encode_sample, record_bytes,
};
use tempfile::TempDir;

use crate::interrupt::{Process, Temporary};
use crate::tools::{self, Leave};

/// An image that takes no record for this long is given up.
const TIMEOUT: Duration = Duration::from_secs(60);

/// The image and the emulator that runs it.
pub struct QemuBench {
    qemu: PathBuf,
    image: PathBuf,
}

impl QemuBench {
    /// Finds the tools, or sets them up where `leave` is given, and builds the image.
    ///
    /// # Errors
    /// A tool is missing (as [`tools::MissingTools`]), the sources are not there, or the build fails.
    pub fn prepare(leave: Leave) -> Result<Self> {
        Ok(Self { qemu: tools::for_the_device(leave)?, image: build("palpate-firmware", "--bin", "replay")? })
    }

    /// Feeds `samples` to the image; `progress` is called meanwhile with how many are done. The time is the emulator's own: it
    /// sleeps through what the core sleeps.
    ///
    /// # Errors
    /// The image or the emulator fails.
    pub fn start(
        &self,
        config: &EstimatorBankConfig,
        samples: impl ExactSizeIterator<Item = Sample>,
        progress: impl Fn(u64),
    ) -> Result<QemuRun> {
        let folder = tempfile::tempdir().context("cannot make a folder for the image's files")?;
        let removed_by_a_signal = Temporary::new(folder.path());
        let count = samples.len();
        write_input(&folder.path().join("replay.in"), config, samples).context("cannot write the image's input")?;
        let run =
            QemuRun { folder, _removed_by_a_signal: removed_by_a_signal, methods: config.methods, samples: count };
        let size = record_bytes(config.methods);
        self.emulate(run.folder.path(), &run.output(), |written| progress(written / size as u64))?;
        Ok(run)
    }

    fn emulate(&self, folder: &Path, output: &Path, grown: impl Fn(u64)) -> Result<()> {
        let image = self.image.canonicalize().with_context(|| format!("{} is gone", self.image.display()))?;
        let mut child = Command::new(&self.qemu)
            .args(["-machine", "netduinoplus2", "-display", "none", "-monitor", "none", "-serial", "none"])
            // Eight nanoseconds an instruction, and no waiting for the wall clock while the core sleeps.
            .args(["-icount", "shift=3,sleep=off", "-semihosting-config", "enable=on,target=native"])
            .arg("-kernel")
            .arg(image)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot run {}", self.qemu.display()))?;
        let _ended_by_a_signal = Process::new(&child);
        let done = wait(&mut child, output, grown);
        if done.is_err() {
            // Killing fails only where it has ended by itself.
            let _ = child.kill();
        }
        let ended = child.wait_with_output().context("the emulator cannot be waited for")?;
        done?;
        let said = String::from_utf8_lossy(&ended.stderr);
        ensure!(ended.status.success(), "the image gave up ({}): {}", ended.status, said.trim());
        Ok(())
    }
}

/// What the image returned, in its file, which is there as long as this is.
#[derive(Debug)]
pub struct QemuRun {
    // Dropped, and with it removed, before it is forgotten that a signal has to remove it.
    folder: TempDir,
    _removed_by_a_signal: Temporary,
    methods: Methods,
    samples: usize,
}

impl QemuRun {
    fn output(&self) -> PathBuf {
        self.folder.path().join("replay.out")
    }

    /// Hands the outcome of each sample to `take`, in order.
    ///
    /// # Errors
    /// The image returned something else than one record a sample, or `take` returns one.
    pub fn each(&self, mut take: impl FnMut(UpdateResult) -> Result<()>) -> Result<ReplayCounters> {
        let mut records = BufReader::new(File::open(self.output()).context("the image wrote no output")?);
        let mut bytes = vec![0; record_bytes(self.methods)];
        for k in 0..self.samples {
            records.read_exact(&mut bytes).with_context(|| format!("the image's output ends at sample {k}"))?;
            let outcome = decode_record(&bytes, self.methods);
            take(outcome.with_context(|| format!("the image's record of sample {k} is none"))?)?;
        }
        let mut counters = [0; COUNTER_BYTES];
        records.read_exact(&mut counters).context("the image's output lacks its counters")?;
        ensure!(records.read(&mut [0])? == 0, "the image's output goes on after its counters");
        decode_counters(&counters).context("the image's counters are none")
    }
}

/// Waits for the emulator as long as its output grows; `grown` is called with its size.
fn wait(child: &mut Child, output: &Path, grown: impl Fn(u64)) -> Result<()> {
    let (mut size, mut since) = (0, Instant::now());
    while child.try_wait().context("the emulator cannot be waited for")?.is_none() {
        let now = std::fs::metadata(output).map_or(0, |file| file.len());
        if now > size {
            (size, since) = (now, Instant::now());
            grown(size);
        }
        if since.elapsed() > TIMEOUT {
            bail!("the image wrote nothing for {} s", TIMEOUT.as_secs());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

fn write_input(path: &Path, config: &EstimatorBankConfig, samples: impl Iterator<Item = Sample>) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let mut buffer = [0; CONFIG_BYTES + 4];
    file.write_all(encode_config(config, &mut buffer).context("the settings do not fit their buffer")?)?;
    for sample in samples {
        file.write_all(&encode_sample(&sample))?;
    }
    Ok(file.flush()?)
}

/// The folder of the sources: where this tool was built, else upwards from where it is called.
///
/// # Errors
/// Neither holds them.
pub fn project() -> Result<PathBuf> {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf);
    let here = std::env::current_dir().context("there is no present folder")?;
    let is_project = |folder: &Path| folder.join("memory.x").is_file() && folder.join("lab/Cargo.toml").is_file();
    let upwards = here.ancestors().map(Path::to_path_buf);
    let found = built.into_iter().chain(upwards).find(|folder| is_project(folder));
    found.context("the device's image is built from source: run this inside the project's folder")
}

/// Builds an image of `package` and finds the file that cargo made. `kind` is `--bin` or `--example`.
pub(crate) fn build(package: &str, kind: &str, name: &str) -> Result<PathBuf> {
    let target = ["--profile", "device", "--package", package, kind, name, "--target", tools::TARGET];
    cargo(&target, name, |message| message["executable"].as_str().map(PathBuf::from))
}

/// Runs `cargo build` with `arguments` and finds the file that `file` takes from the message about `name`.
pub(crate) fn cargo(
    arguments: &[&str],
    name: &str,
    file: impl Fn(&serde_json::Value) -> Option<PathBuf>,
) -> Result<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // Who watches sees cargo's progress; a file does not need it.
    let quiet = if std::io::stderr().is_terminal() { None } else { Some("--quiet") };
    let output = Command::new(cargo)
        .arg("build")
        .args(quiet)
        .args(arguments)
        .args(["--message-format", "json-render-diagnostics"])
        .current_dir(project()?)
        // These replace the flags of .cargo/config.toml, the link script among them.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .context("cannot run cargo")?;
    ensure!(output.status.success(), "`{name}` does not build (see above)");
    let messages = String::from_utf8_lossy(&output.stdout);
    let artifacts = messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let found = artifacts.filter(|message| message["target"]["name"] == name).find_map(|message| file(&message));
    found.with_context(|| format!("cargo built `{name}` and named no file"))
}
