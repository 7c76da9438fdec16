//! One diagnosis: the command that a user runs, on plain files, in a folder that holds nothing else.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, Result};

use super::case_score::CaseScore;
use super::diagnosis_json::DiagnosisJson;
use super::generate::GeneratedCase;

/// Where the command leaves its answer.
const ANSWER_FILE: &str = "diagnosis.json";

/// Runs `tool diagnose` on `case` and scores what it tells.
///
/// # Errors
/// The command cannot be started.
pub fn diagnose_and_score(tool: &Path, case: &GeneratedCase) -> Result<CaseScore> {
    let (diagnosis, seconds) = run_diagnosis(tool, &case.folder, &["trial-1.csv", "trial-2.csv"])?;
    Ok(CaseScore::score(&case.truth, diagnosis, seconds))
}

/// Runs `tool diagnose` in `folder` on its rig file, with `arguments`: what it tells, or why nothing, and the seconds from
/// its start to its end.
///
/// # Errors
/// The command cannot be started.
pub fn run_diagnosis(tool: &Path, folder: &Path, arguments: &[&str]) -> Result<(Result<DiagnosisJson, String>, f64)> {
    let start = Instant::now();
    let output = Command::new(tool)
        .args(["diagnose", "--rig", "rig.toml", "--json", ANSWER_FILE])
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .output()
        .with_context(|| format!("cannot run {}", tool.display()))?;
    let seconds = start.elapsed().as_secs_f64();
    let diagnosis = if output.status.success() {
        read_answer(&folder.join(ANSWER_FILE))
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(said.lines().last().unwrap_or("it said nothing").to_owned())
    };
    Ok((diagnosis, seconds))
}

fn read_answer(path: &Path) -> Result<DiagnosisJson, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("no answer was written: {error}"))?;
    serde_json::from_str(&text).map_err(|error| format!("an answer that is none of palpate.diagnosis/1: {error}"))
}
