//! The protocol: drawn, sealed, diagnosed, opened, scored.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use palpate_cases::python::{self, BASELINES, Packages, Python, SIMULATORS};
use palpate_cases::{SimulatorKind, Truth};
use serde::Serialize;

use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::command::ChallengeArgs;
use super::commitment::Commitment;
use super::generate::{self, GeneratedCase};
use super::recordings::run_diagnosis::diagnose_specimen;
use super::recordings::specimen::{self, SealedAnswer, Specimen};
use super::recordings::specimen_score::{RecordingScores, SpecimenScore};
use super::{baselines, case_list, run_diagnosis};
use crate::error::UsageError;
use crate::qemu_bench::project;
use crate::recordings_folder::{ADVICE, folder};

/// A sealed answer.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer<'a> {
    GeneratedCase(&'a Truth),
    RecordingScores(SealedAnswer<'a>),
}

/// All that is put to the diagnosis.
struct TestSet {
    cases: Vec<GeneratedCase>,
    recorded: Vec<Specimen>,
}

impl TestSet {
    fn answers(&self) -> impl Iterator<Item = Answer<'_>> {
        let drawn = self.cases.iter().map(|case| Answer::GeneratedCase(&case.truth));
        drawn.chain(self.recorded.iter().map(|entry| Answer::RecordingScores(entry.sealed())))
    }
}

/// Holds the challenge that `args` asks for.
///
/// # Errors
/// A folder that cannot be written, a commitment that does not hold, or a diagnosis that cannot be started.
pub fn run(args: &ChallengeArgs) -> Result<ChallengeScore> {
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
    let test_set = TestSet { cases: drawn(args, home, &mut left_out)?, recorded };
    let (cases, real) = (test_set.cases.len(), test_set.recorded.len());
    ensure!(cases + real > 0, "there is nothing to diagnose: {}", left_out.join("; "));
    let commitment = Commitment::commit(&home.join("answers.jsonl"), test_set.answers())?;
    eprintln!("{cases} cases drawn, {real} specimens; the answers are sealed by SHA-256 {}", commitment.sha256());
    let others = args.rivals.then(|| scripts(&BASELINES, "PySINDy and SysIdentPy", &mut left_out)).flatten();
    let tool = std::env::current_exe().context("this program cannot find itself")?;
    let rows = diagnosed(args, &tool, &test_set.cases, others.as_ref())?;
    if rows.len() < cases {
        left_out.push(format!("{} of {cases} cases: not reached in the minutes that were given", cases - rows.len()));
    }
    let real = specimens(args, &tool, &test_set.recorded, home)?;
    commitment.verify(test_set.answers())?;
    let recorded = (!real.is_empty()).then(|| RecordingScores::of(real));
    Ok(ChallengeScore { recorded, ..ChallengeScore::of(args.seed, commitment.sha256(), rows, left_out) })
}

/// The cases that `args` asks for, drawn below `home`.
fn drawn(args: &ChallengeArgs, home: &Path, left_out: &mut Vec<String>) -> Result<Vec<GeneratedCase>> {
    if args.cases == 0 {
        return Ok(Vec::new());
    }
    let asked: Vec<SimulatorKind> = match args.source.as_slice() {
        [] => SimulatorKind::ALL.to_vec(),
        some => some.iter().map(|player| player.kind()).collect(),
    };
    let elsewhere = asked.iter().any(|source| *source != SimulatorKind::Own);
    let python = elsewhere.then(|| scripts(&SIMULATORS, "the cases of MuJoCo, Drake and Exudyn", left_out)).flatten();
    let can = |source: &SimulatorKind| *source == SimulatorKind::Own || python.is_some();
    let sources: Vec<SimulatorKind> = asked.into_iter().filter(can).collect();
    let entries = case_list::sample(args.cases, &sources, args.seed);
    ensure!(!entries.is_empty(), "there is nobody to play a case: {}", left_out.join("; "));
    let bar = progress(entries.len(), "drawing");
    let (cases, failed) = generate::generate_all(&entries, args.seed, home, python.as_ref(), &|| bar.inc(1))?;
    bar.finish_and_clear();
    left_out.extend(failed);
    Ok(cases)
}

/// The real recordings that `wanted` names.
fn recordings(wanted: &[String], left_out: &mut Vec<String>) -> Result<Vec<Specimen>> {
    let wanted = match wanted {
        [only] if only == "none" => return Ok(Vec::new()),
        [only] if only == "all" => &[],
        some => some,
    };
    let Some(root) = folder() else {
        left_out.push(format!("real recordings: there are none; {ADVICE}"));
        return Ok(Vec::new());
    };
    let entries = specimen::all(&root, wanted)?;
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
fn diagnosed(
    args: &ChallengeArgs,
    tool: &Path,
    cases: &[GeneratedCase],
    others: Option<&Python>,
) -> Result<Vec<CaseScore>> {
    let bar = progress(cases.len(), "diagnosing");
    let mut rows: Vec<CaseScore> = Vec::new();
    let begun = Instant::now();
    let over = || args.minutes.is_some_and(|minutes| begun.elapsed() >= Duration::from_secs(60 * minutes));
    for case in cases {
        if over() {
            break;
        }
        let mut row = run_diagnosis::diagnose_and_score(tool, case)?;
        if args.rivals {
            row.baselines = baselines::run_all(&case.folder, others);
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
fn specimens(args: &ChallengeArgs, tool: &Path, entries: &[Specimen], home: &Path) -> Result<Vec<SpecimenScore>> {
    let bar = progress(entries.len(), "real recordings");
    let mut rows = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        // The name of a folder is no hint.
        let folder = home.join(format!("recorded-{number:02}"));
        entry.write(&folder)?;
        let row = diagnose_specimen(tool, entry, &folder)?;
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
