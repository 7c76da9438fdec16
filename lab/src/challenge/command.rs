//! The command line of `palpate challenge`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use palpate_cases::Source;
use palpate_cases::python::{self, Packages, Python, RIVALS, SIMULATORS};

use super::row::Row;
use super::score::Challenge;
use super::seal::Seal;
use super::{draft, examination, page, plan, rival, summary};
use crate::device::project;
use crate::error::{InputError, UsageError};
use crate::outfile::OutFile;

/// Put the diagnosis to recordings whose missing effect is concealed from it
#[derive(Debug, Clone, Args)]
pub struct ChallengeArgs {
    /// How many of the 1580 cases, an even sample; all of them take some ten hours
    #[arg(long, value_name = "N", default_value_t = 60)]
    pub cases: usize,
    /// Seed of the cases: the same seed, the same recordings
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Write the score as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the page
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Simulators that play the cases; all where left out
    #[arg(long, value_name = "NAME", value_enum, value_delimiter = ',')]
    pub source: Vec<Player>,
    /// Have plain BIC, PySINDy and SysIdentPy look at the same files
    #[arg(long)]
    pub rivals: bool,
    /// Keep recordings, sealed answers and diagnoses here
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Run nothing: redraw page and tables of a score that was written by --json
    #[arg(long, value_name = "FILE", conflicts_with_all = ["cases", "seed", "source", "rivals", "keep"])]
    pub from: Option<PathBuf>,
    /// Put the score into docs/challenge.json of this project, its page beside it and its table into the README
    #[arg(long)]
    pub publish: bool,
}

/// Who plays a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Player {
    /// Our own simulation
    Own,
    /// MuJoCo
    Mujoco,
    /// Drake
    Drake,
    /// Exudyn
    Exudyn,
}

impl Player {
    fn source(self) -> Source {
        match self {
            Self::Own => Source::Own,
            Self::Mujoco => Source::Mujoco,
            Self::Drake => Source::Drake,
            Self::Exudyn => Source::Exudyn,
        }
    }
}

/// Runs `palpate challenge`.
///
/// # Errors
/// A file that cannot be read or written, a seal that does not hold, or a diagnosis that cannot be started.
pub fn run(args: &ChallengeArgs) -> Result<()> {
    ensure!(args.cases > 0, UsageError::new("--cases", 0, "at least one"));
    let open = |path: &Option<PathBuf>| {
        path.as_deref().filter(|path| path.as_os_str() != "-").map(OutFile::create).transpose()
    };
    let (json, report) = (open(&args.json)?, open(&args.report)?);
    let challenge = match &args.from {
        Some(path) => read(path)?,
        None => held(args)?,
    };
    let table = summary::table(&challenge);
    eprintln!("{table}");
    let text = serde_json::to_string_pretty(&challenge).context("the score cannot be written as JSON")? + "\n";
    if let Some(mut file) = report {
        page::write(&challenge, &mut file).map_err(|error| file.fault(&error))?;
        file.commit()?;
    }
    if args.publish {
        publish(&challenge, &text, &table)?;
    }
    match json {
        Some(file) => commit(file, text.as_bytes()),
        None if args.json.is_some() => Ok(std::io::stdout().write_all(text.as_bytes())?),
        None => Ok(()),
    }
}

/// A score as `--json` wrote it.
fn read(path: &Path) -> Result<Challenge> {
    let text = std::fs::read_to_string(path).map_err(|error| InputError::new(path.display(), error, "a score"))?;
    let wrong = |found: String| InputError::new(path.display(), found, "a score of palpate.challenge/1");
    let challenge: Challenge = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    ensure!(challenge.schema == "palpate.challenge/1", wrong(challenge.schema));
    Ok(challenge)
}

/// Draws, seals, diagnoses, opens, scores.
fn held(args: &ChallengeArgs) -> Result<Challenge> {
    let mut left_out = Vec::new();
    let asked: Vec<Source> = match args.source.as_slice() {
        [] => Source::ALL.to_vec(),
        some => some.iter().map(|player| player.source()).collect(),
    };
    let elsewhere = asked.iter().any(|source| *source != Source::Own);
    let python =
        elsewhere.then(|| scripts(&SIMULATORS, "the cases of MuJoCo, Drake and Exudyn", &mut left_out)).flatten();
    let others = args.rivals.then(|| scripts(&RIVALS, "PySINDy and SysIdentPy", &mut left_out)).flatten();
    let can = |source: &Source| *source == Source::Own || python.is_some();
    let sources: Vec<Source> = asked.into_iter().filter(can).collect();
    let entries = plan::sample(args.cases, &sources, args.seed);
    ensure!(!entries.is_empty(), "there is nobody to play a case: {}", left_out.join("; "));
    let temporary;
    let home = match &args.keep {
        Some(folder) => folder.as_path(),
        None => {
            temporary = tempfile::tempdir().context("no folder for the recordings can be made")?;
            temporary.path()
        }
    };
    std::fs::create_dir_all(home).with_context(|| format!("cannot make {}", home.display()))?;
    let bar = progress(entries.len() as u64, "drawing");
    let (cases, failed) = draft::draw_all(&entries, args.seed, home, python.as_ref(), &|| bar.inc(1))?;
    bar.finish_and_clear();
    left_out.extend(failed);
    let seal = Seal::close(&home.join("answers.jsonl"), cases.iter().map(|case| &case.truth))?;
    eprintln!("{} cases drawn; the answers are sealed by SHA-256 {}", cases.len(), seal.sha256());
    let tool = std::env::current_exe().context("this program cannot find itself")?;
    let bar = progress(cases.len() as u64, "diagnosing");
    let mut rows: Vec<Row> = Vec::new();
    for case in &cases {
        let mut row = examination::examine(&tool, case)?;
        if args.rivals {
            row.others = rival::look(&case.folder, others.as_ref());
        }
        bar.suspend(|| eprintln!("{}", row.line()));
        bar.inc(1);
        rows.push(row);
        if args.keep.is_none() {
            std::fs::remove_dir_all(&case.folder).with_context(|| format!("cannot clear {}", case.folder.display()))?;
        }
    }
    bar.finish_and_clear();
    seal.open(cases.iter().map(|case| &case.truth))?;
    Ok(Challenge::of(args.seed, seal.sha256(), rows, left_out))
}

/// The scripts of `packages` with a Python that has what they need, if that can be had.
fn scripts(packages: &Packages, what: &str, left_out: &mut Vec<String>) -> Option<Python> {
    let home = match project() {
        Ok(folder) => folder.join("target").join("python"),
        Err(_) => std::env::temp_dir().join("palpate-python"),
    };
    match python::set_up(&home, packages) {
        Ok(python) => Some(python),
        Err(missing) => {
            eprintln!("note: {what} are left out: {missing}");
            left_out.push(format!("{what}: {missing}"));
            None
        }
    }
}

/// Puts the score where the project shows it.
fn publish(challenge: &Challenge, text: &str, table: &str) -> Result<()> {
    let project = project()?;
    let readme = project.join("README.md");
    let old = std::fs::read_to_string(&readme).with_context(|| format!("cannot read {}", readme.display()))?;
    let lacking = || InputError::new(readme.display(), "no place for the table", summary::BEGIN);
    let new = summary::replaced(&old, table).ok_or_else(lacking)?;
    let mut page = Vec::new();
    page::write(challenge, &mut page).context("the page cannot be written")?;
    let docs = project.join("docs");
    for (path, bytes) in
        [(readme, new.as_bytes()), (docs.join("challenge.json"), text.as_bytes()), (docs.join("challenge.html"), &page)]
    {
        commit(OutFile::create(&path)?, bytes)?;
    }
    Ok(())
}

fn commit(mut file: OutFile, bytes: &[u8]) -> Result<()> {
    file.write_all(bytes).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

fn progress(cases: u64, what: &'static str) -> ProgressBar {
    let bar = ProgressBar::new(cases).with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}, {elapsed}, {eta} to go") {
        bar.set_style(style);
    }
    bar
}
