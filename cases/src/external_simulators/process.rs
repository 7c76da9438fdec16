//! A simulator as a child process: a line of JSON and raw doubles, to and fro. `cases/simulators/protocol.py` is the
//! other end.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::path::PathBuf;
use std::process::{self, ChildStdin, ChildStdout, Stdio};

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::closed_loop::{LoopSetup, SimulatedTrial};
use crate::effect::EffectParameter;
use crate::python::Python;

/// The columns of an answer, in their order.
const COLUMNS: [&str; 6] = ["position", "velocity", "reading", "force", "force_mean", "effort"];

/// A running script; it ends when this is dropped.
#[derive(Debug)]
pub struct SimulatorProcess {
    name: &'static str,
    process: process::Child,
    to: Option<BufWriter<ChildStdin>>,
    from: BufReader<ChildStdout>,
    log: PathBuf,
}

/// What a simulator answers.
#[derive(Debug)]
pub enum SimulatorReply {
    /// One a reference.
    Trials(Vec<SimulatedTrial>),
    /// It could not bring the trials to an end.
    GaveUp(String),
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct ReplyHeader {
    ready: bool,
    rows: Vec<usize>,
    columns: Vec<String>,
    error: Option<String>,
    gave_up: Option<String>,
}

impl SimulatorProcess {
    /// Starts the script `name`.
    ///
    /// # Errors
    /// It does not come up.
    pub fn start(python: &Python, name: &'static str) -> Result<Self> {
        let script = python.script(name)?;
        let log = script.with_extension(format!("{}.log", process::id()));
        let errors = File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
        let mut process = python
            .command(&script)
            // What a simulator logs beside what it says, as MuJoCo does, lies here and not in the user's folder.
            .current_dir(script.parent().unwrap_or(&script))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .with_context(|| format!("cannot run {}", python.interpreter().display()))?;
        let pipes = process.stdin.take().zip(process.stdout.take());
        let (to, from) = pipes.ok_or_else(|| anyhow!("{name} has no pipes"))?;
        let mut child =
            Self { name, process, to: Some(BufWriter::new(to)), from: BufReader::with_capacity(1 << 16, from), log };
        let head = child.head()?;
        ensure!(head.ready, "{name} did not say that it is ready");
        Ok(child)
    }

    /// Plays a trial along each of `references` with `effects` by name.
    ///
    /// # Errors
    /// The simulator has no such effect, or has ended.
    pub fn simulate(
        &mut self,
        setup: &LoopSetup,
        references: &[Vec<f64>],
        effects: &[(&'static str, Vec<EffectParameter>)],
    ) -> Result<SimulatorReply> {
        let head = request(setup, references, effects);
        self.send(&head, references).with_context(|| self.last_message())?;
        let head = self.head()?;
        if let Some(error) = head.error {
            bail!("{}: {error}", self.name);
        }
        if let Some(why) = head.gave_up {
            return Ok(SimulatorReply::GaveUp(why));
        }
        ensure!(head.columns == COLUMNS, "{} answers with the columns {:?}", self.name, head.columns);
        let wanted: Vec<usize> = references.iter().map(Vec::len).collect();
        ensure!(head.rows == wanted, "{} answers with {:?} rows for {wanted:?}", self.name, head.rows);
        wanted.into_iter().map(|rows| self.read_trial(rows)).collect::<Result<_>>().map(SimulatorReply::Trials)
    }

    fn send(&mut self, head: &Value, references: &[Vec<f64>]) -> Result<()> {
        let to = self.to.as_mut().ok_or_else(|| anyhow!("the simulator has ended"))?;
        serde_json::to_writer(&mut *to, head)?;
        to.write_all(b"\n")?;
        for value in references.iter().flatten() {
            to.write_all(&value.to_le_bytes())?;
        }
        to.flush()?;
        Ok(())
    }

    fn head(&mut self) -> Result<ReplyHeader> {
        let mut line = String::new();
        self.from.read_line(&mut line).with_context(|| self.last_message())?;
        ensure!(!line.is_empty(), "{}", self.last_message());
        serde_json::from_str(&line).with_context(|| format!("{} does not answer in JSON: {line}", self.name))
    }

    fn read_trial(&mut self, rows: usize) -> Result<SimulatedTrial> {
        let mut column = || -> Result<Vec<f64>> {
            let mut bytes = vec![0; 8 * rows];
            self.from.read_exact(&mut bytes).with_context(|| format!("{} stopped in its answer", self.name))?;
            Ok(bytes.as_chunks().0.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect())
        };
        Ok(SimulatedTrial {
            position: column()?,
            velocity: column()?,
            reading: column()?,
            force: column()?,
            force_mean: column()?,
            effort: column()?,
        })
    }

    /// That it ended, with the last of what it last_message.
    fn last_message(&self) -> String {
        let log = std::fs::read_to_string(&self.log).unwrap_or_default();
        let last = log.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it last_message nothing");
        format!("the simulator {} ended: {last}", self.name)
    }
}

impl Drop for SimulatorProcess {
    fn drop(&mut self) {
        // Its input ends, and so does the script; neither matters to anybody any more.
        drop(self.to.take());
        let _ = self.process.wait();
        let _ = std::fs::remove_file(&self.log);
    }
}

fn request(setup: &LoopSetup, references: &[Vec<f64>], effects: &[(&'static str, Vec<EffectParameter>)]) -> Value {
    let values = |parameters: &Vec<EffectParameter>| {
        let entry = |value: &EffectParameter| (value.name.to_owned(), Value::from(value.value));
        Value::from(parameters.iter().map(entry).collect::<Map<_, _>>())
    };
    let effects: Map<_, _> =
        effects.iter().map(|(name, parameters)| ((*name).to_owned(), values(parameters))).collect();
    json!({
        "rows": references.iter().map(Vec::len).collect::<Vec<_>>(),
        "nominal": setup.nominal,
        "control": setup.control,
        "encoder": { "step": setup.encoder.step, "offset": setup.encoder.offset },
        "effects": effects,
    })
}
