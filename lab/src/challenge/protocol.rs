//! The protocol: cases drawn, answers committed to, diagnosed, opened, scored.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use palpate_cases::SimulatorKind;
use palpate_cases::python::{self, BASELINES, Packages, Python, SIMULATORS};

use super::case_result::CaseResult;
use super::case_source::CaseSource;
use super::challenge_score::ChallengeScore;
use super::command::ChallengeArgs;
use super::commitment::{CommittedCase, OpenedAnswers, Origin, hash};
use super::recordings::run_diagnosis::diagnose_specimen;
use super::recordings::specimen::{self, Specimen};
use super::run_diagnosis::run_diagnosis;
use super::work_folder::{Settings, WorkFolder};
use super::{baselines, case_list, external_cases, generate, score_run};
use crate::consent::{self, Answer};
use crate::error::UsageError;
use crate::qemu_bench::project;
use crate::recordings_folder::{ADVICE, folder};

/// Runs the challenge that `args` asks for, or what an interrupted one has left of it.
///
/// # Errors
/// A folder that cannot be written, answers or files that are not those that were committed to, or a diagnosis that cannot be
/// started.
pub fn run(args: &ChallengeArgs) -> Result<ChallengeScore> {
    let tool = std::env::current_exe().context("this program cannot find itself")?;
    let home = WorkFolder::open(args.out.as_deref(), &settings(args, &tool)?)?;
    let mut left_out = Vec::new();
    let specimens = selected_specimens(&args.recordings, &mut left_out)?;
    let commitment = match home.committed()? {
        Some((commitment, noted)) => {
            left_out = noted;
            commitment
        }
        None => {
            let answers = prepare(args, &home, &specimens, &mut left_out)?;
            ensure!(!answers.is_empty(), "there is nothing to diagnose: {}", left_out.join("; "));
            home.commit(&answers, &left_out)?
        }
    };
    // Read for the names and the files of the cases: the answers are not read before all is diagnosed.
    let cases = commitment.open()?.cases().to_vec();
    let real = cases.iter().filter(|case| case.origin == Origin::Recorded).count();
    let sha256 = commitment.sha256();
    eprintln!("{} cases, {real} real recordings; the answers are committed to by SHA-256 {sha256}", cases.len() - real);
    let python = args.baselines.then(|| scripts(&BASELINES, "PySINDy and SysIdentPy", &mut left_out)).flatten();
    diagnose_all(args, &tool, &home, &cases, &specimens, python.as_ref())?;
    let answers: OpenedAnswers = commitment.open()?;
    score_run::score(args.seed, &answers, &home.results()?, &specimens, left_out)
}

/// What decides this run.
fn settings(args: &ChallengeArgs, tool: &Path) -> Result<Settings> {
    let program = std::fs::read(tool).with_context(|| format!("cannot read {}", tool.display()))?;
    Ok(Settings {
        seed: args.seed,
        cases: args.cases,
        sources: args.source.iter().map(ToString::to_string).collect(),
        recordings: args.recordings.clone(),
        baselines: args.baselines,
        program_sha256: hash(&program),
    })
}

/// Writes the files of every case: those of other authors, then the drawn ones, then the real recordings.
fn prepare(
    args: &ChallengeArgs,
    home: &WorkFolder,
    specimens: &[Specimen],
    left_out: &mut Vec<String>,
) -> Result<Vec<CommittedCase>> {
    let mut answers = external(args, home)?;
    answers.extend(drawn(args, home, left_out)?);
    for (number, specimen) in specimens.iter().enumerate() {
        // The name of a folder is no hint.
        let case = format!("recorded-{number:02}");
        specimen.write(&home.path().join(&case))?;
        answers.push(CommittedCase::new(home.path(), &case, Origin::Recorded, &specimen.sealed())?);
    }
    Ok(answers)
}

/// The cases of other authors that `args` names, copied to `home`.
fn external(args: &ChallengeArgs, home: &WorkFolder) -> Result<Vec<CommittedCase>> {
    let folders = args.source.iter().filter_map(|source| match source {
        CaseSource::Folder(folder) => Some(folder),
        CaseSource::Simulator(_) => None,
    });
    let mut answers = Vec::new();
    for folder in folders {
        for found in external_cases::read(folder)? {
            let case = format!("external-{:04}", answers.len());
            found.copy_to(&home.path().join(&case))?;
            answers.push(CommittedCase::new(home.path(), &case, Origin::External, &found.answer)?);
        }
    }
    Ok(answers)
}

/// The cases that `args` has drawn, written below `home`.
fn drawn(args: &ChallengeArgs, home: &WorkFolder, left_out: &mut Vec<String>) -> Result<Vec<CommittedCase>> {
    let asked = CaseSource::simulators(&args.source);
    if args.cases == 0 || asked.is_empty() {
        return Ok(Vec::new());
    }
    let needs_python = asked.iter().any(|source| *source != SimulatorKind::Own);
    let wanted = needs_python.then(|| scripts(&SIMULATORS, "the cases of MuJoCo, Drake and Exudyn", left_out));
    let python = wanted.flatten();
    let can = |source: &SimulatorKind| *source == SimulatorKind::Own || python.is_some();
    let sources: Vec<SimulatorKind> = asked.into_iter().filter(can).collect();
    let entries = case_list::sample(args.cases, &sources, args.seed);
    ensure!(!entries.is_empty(), "no simulator is there to draw a case: {}", left_out.join("; "));
    let bar = progress(entries.len(), "drawing");
    let (cases, failed) = generate::generate_all(&entries, args.seed, home, python.as_ref(), &|| bar.inc(1))?;
    bar.finish_and_clear();
    left_out.extend(failed);
    Ok(cases)
}

/// The real recordings that `wanted` names.
fn selected_specimens(wanted: &[String], left_out: &mut Vec<String>) -> Result<Vec<Specimen>> {
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

/// Diagnoses every case that has no result yet and is reached in the time given; real recordings always. Drawn cases come in
/// no order: those reached are an even sample.
fn diagnose_all(
    args: &ChallengeArgs,
    tool: &Path,
    home: &WorkFolder,
    cases: &[CommittedCase],
    specimens: &[Specimen],
    python: Option<&Python>,
) -> Result<()> {
    let (there, begun) = (home.results()?, Instant::now());
    let bar = progress(cases.len(), "diagnosing");
    let over = || args.minutes.is_some_and(|minutes| begun.elapsed() >= Duration::from_secs(60 * minutes));
    let mut numbered = specimens.iter();
    for case in cases {
        let specimen = if case.origin == Origin::Recorded { numbered.next() } else { None };
        bar.inc(1);
        if there.contains_key(&case.case) || (specimen.is_none() && over()) {
            continue;
        }
        case.check_files(home.path())?;
        let result = match specimen {
            Some(specimen) => diagnose_specimen(tool, specimen, home.path(), &case.case)?,
            None => diagnose_case(tool, home.path(), case, args.baselines, python)?,
        };
        home.note_result(&result)?;
        bar.suspend(|| eprintln!("{}", result.line()));
        home.clear(&case.case)?;
    }
    bar.finish_and_clear();
    Ok(())
}

/// Runs the diagnosis, and the baselines where they are asked for, on one case.
fn diagnose_case(
    tool: &Path,
    home: &Path,
    case: &CommittedCase,
    with_baselines: bool,
    python: Option<&Python>,
) -> Result<CaseResult> {
    let folder: PathBuf = home.join(&case.case);
    let trials = case.files.keys().filter(|name| name.ends_with(".csv")).map(String::as_str).collect::<Vec<_>>();
    let (diagnosis, seconds) = run_diagnosis(tool, &folder, &trials)?;
    let mut result = CaseResult::new(&case.case, diagnosis, seconds);
    if with_baselines && case.origin == Origin::Drawn {
        result.baselines = baselines::run_all(&folder, python);
    }
    Ok(result)
}

/// The scripts of `packages` with a Python that has what they need, if that can be had.
fn scripts(packages: &Packages, what: &str, left_out: &mut Vec<String>) -> Option<Python> {
    let home = match project() {
        Ok(folder) => folder.join("target").join("python"),
        Err(_) => std::env::temp_dir().join("palpate-python"),
    };
    let question = python::to_install(&home, packages);
    let found = match question.as_deref().map_or(Answer::Yes, consent::ask) {
        Answer::Yes => python::set_up(&home, packages),
        Answer::No => Err(python::declined(&home, packages)),
    };
    match found {
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
