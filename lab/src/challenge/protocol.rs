//! The protocol: drawn, sealed, diagnosed, opened, scored.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use palpate_cases::python::{self, Packages, Python, RIVALS, SIMULATORS};
use palpate_cases::{Source, Truth};
use serde::Serialize;

use super::command::ChallengeArgs;
use super::draft::{self, Drawn};
use super::recorded::entry::{self, Entry, Sealed};
use super::recorded::examination::examine;
use super::recorded::row::{Recorded, Row as RecordedRow};
use super::row::Row;
use super::score::Challenge;
use super::seal::Seal;
use super::{examination, plan, rival};
use crate::device::project;
use crate::error::UsageError;
use crate::recordings::{ADVICE, folder};

/// A sealed answer.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer<'a> {
    Drawn(&'a Truth),
    Recorded(Sealed<'a>),
}

/// All that is put to the diagnosis.
struct Docket {
    cases: Vec<Drawn>,
    recorded: Vec<Entry>,
}

impl Docket {
    fn answers(&self) -> impl Iterator<Item = Answer<'_>> {
        let drawn = self.cases.iter().map(|case| Answer::Drawn(&case.truth));
        drawn.chain(self.recorded.iter().map(|entry| Answer::Recorded(entry.sealed())))
    }
}

/// Holds the challenge that `args` asks for.
///
/// # Errors
/// A folder that cannot be written, a seal that does not hold, or a diagnosis that cannot be started.
pub fn hold(args: &ChallengeArgs) -> Result<Challenge> {
    let mut left_out = Vec::new();
    let temporary;
    let home = match &args.keep {
        Some(folder) => folder.as_path(),
        None => {
            temporary = tempfile::tempdir().context("no folder for the recordings can be made")?;
            temporary.path()
        }
    };
    std::fs::create_dir_all(home).with_context(|| format!("cannot make {}", home.display()))?;
    let recorded = recordings(&args.recordings, &mut left_out)?;
    let docket = Docket { cases: drawn(args, home, &mut left_out)?, recorded };
    let (cases, real) = (docket.cases.len(), docket.recorded.len());
    ensure!(cases + real > 0, "there is nothing to diagnose: {}", left_out.join("; "));
    let seal = Seal::close(&home.join("answers.jsonl"), docket.answers())?;
    eprintln!("{cases} cases drawn, {real} specimens; the answers are sealed by SHA-256 {}", seal.sha256());
    let others = args.rivals.then(|| scripts(&RIVALS, "PySINDy and SysIdentPy", &mut left_out)).flatten();
    let tool = std::env::current_exe().context("this program cannot find itself")?;
    let rows = diagnosed(args, &tool, &docket.cases, others.as_ref())?;
    if rows.len() < cases {
        left_out.push(format!("{} of {cases} cases: not reached in the minutes that were given", cases - rows.len()));
    }
    let real = specimens(args, &tool, &docket.recorded, home)?;
    seal.open(docket.answers())?;
    let recorded = (!real.is_empty()).then(|| Recorded::of(real));
    Ok(Challenge { recorded, ..Challenge::of(args.seed, seal.sha256(), rows, left_out) })
}

/// The cases that `args` asks for, drawn below `home`.
fn drawn(args: &ChallengeArgs, home: &Path, left_out: &mut Vec<String>) -> Result<Vec<Drawn>> {
    if args.cases == 0 {
        return Ok(Vec::new());
    }
    let asked: Vec<Source> = match args.source.as_slice() {
        [] => Source::ALL.to_vec(),
        some => some.iter().map(|player| player.source()).collect(),
    };
    let elsewhere = asked.iter().any(|source| *source != Source::Own);
    let python = elsewhere.then(|| scripts(&SIMULATORS, "the cases of MuJoCo, Drake and Exudyn", left_out)).flatten();
    let can = |source: &Source| *source == Source::Own || python.is_some();
    let sources: Vec<Source> = asked.into_iter().filter(can).collect();
    let entries = plan::sample(args.cases, &sources, args.seed);
    ensure!(!entries.is_empty(), "there is nobody to play a case: {}", left_out.join("; "));
    let bar = progress(entries.len(), "drawing");
    let (cases, failed) = draft::draw_all(&entries, args.seed, home, python.as_ref(), &|| bar.inc(1))?;
    bar.finish_and_clear();
    left_out.extend(failed);
    Ok(cases)
}

/// The real recordings that `wanted` names.
fn recordings(wanted: &[String], left_out: &mut Vec<String>) -> Result<Vec<Entry>> {
    let wanted = match wanted {
        [only] if only == "none" => return Ok(Vec::new()),
        [only] if only == "all" => &[],
        some => some,
    };
    let Some(root) = folder() else {
        left_out.push(format!("real recordings: there are none; {ADVICE}"));
        return Ok(Vec::new());
    };
    let entries = entry::all(&root, wanted)?;
    let begins = |start: &&String| !entries.iter().any(|entry| entry.name.starts_with(start.as_str()));
    if let Some(unknown) = wanted.iter().find(begins) {
        return Err(UsageError::new("--recordings", unknown, "`all`, `none`, or how names of specimens begin").into());
    }
    if entries.is_empty() {
        left_out.push(format!("real recordings: there is none in {}; {ADVICE}", root.display()));
    }
    Ok(entries)
}

/// Every case that is reached in the time given, diagnosed and scored. They come in no order: those reached are an even sample.
fn diagnosed(args: &ChallengeArgs, tool: &Path, cases: &[Drawn], others: Option<&Python>) -> Result<Vec<Row>> {
    let bar = progress(cases.len(), "diagnosing");
    let mut rows: Vec<Row> = Vec::new();
    let begun = Instant::now();
    let over = || args.minutes.is_some_and(|minutes| begun.elapsed() >= Duration::from_secs(60 * minutes));
    for case in cases {
        if over() {
            break;
        }
        let mut row = examination::examine(tool, case)?;
        if args.rivals {
            row.others = rival::look(&case.folder, others);
        }
        bar.suspend(|| eprintln!("{}", row.line()));
        bar.inc(1);
        rows.push(row);
        clear(args, &case.folder)?;
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// Every specimen diagnosed and scored.
fn specimens(args: &ChallengeArgs, tool: &Path, entries: &[Entry], home: &Path) -> Result<Vec<RecordedRow>> {
    let bar = progress(entries.len(), "real recordings");
    let mut rows = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        // The name of a folder is no hint.
        let folder = home.join(format!("recorded-{number:02}"));
        entry.write(&folder)?;
        let row = examine(tool, entry, &folder)?;
        bar.suspend(|| eprintln!("{}", row.line()));
        bar.inc(1);
        rows.push(row);
        clear(args, &folder)?;
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// A folder that nobody asked to keep goes at once: a thousand of them fill a disk.
fn clear(args: &ChallengeArgs, folder: &Path) -> Result<()> {
    if args.keep.is_some() {
        return Ok(());
    }
    std::fs::remove_dir_all(folder).with_context(|| format!("cannot clear {}", folder.display()))
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

fn progress(count: usize, what: &'static str) -> ProgressBar {
    let bar = ProgressBar::new(count as u64).with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}, {elapsed}, {eta} to go") {
        bar.set_style(style);
    }
    bar
}
