//! One specimen: diagnosed by the command that a user runs; its improved rig file on the trials that were kept back.

use std::path::Path;

use anyhow::Result;

use super::held_out;
use super::specimen::Specimen;
use super::specimen_score::ResidualPair;
use crate::challenge::case_result::CaseResult;
use crate::challenge::run_diagnosis::run_diagnosis;
use crate::rig::Rig;

/// Where the command leaves the improved rig file.
const MODEL_FILE: &str = "improved.toml";

/// Runs `tool diagnose` on `specimen`, which lies in `home/case`.
///
/// # Errors
/// The command cannot be started.
pub fn diagnose_specimen(tool: &Path, specimen: &Specimen, home: &Path, case: &str) -> Result<CaseResult> {
    let (files, folder) = (specimen.files(), home.join(case));
    let arguments: Vec<&str> = files.iter().map(String::as_str).chain(["--model", MODEL_FILE]).collect();
    let (diagnosis, seconds) = run_diagnosis(tool, &folder, &arguments)?;
    let mut result = CaseResult::new(case, diagnosis, seconds);
    if result.failure.is_none() && !specimen.held_out.is_empty() {
        let pair = |[before, after]: [f64; 2]| ResidualPair { before: Some(before), after: Some(after) };
        let rms = held_out_rms(specimen, &folder.join(MODEL_FILE));
        result.held_out = Some(rms.map(pair).map_err(|error| format!("the trials kept back: {error:#}")));
    }
    Ok(result)
}

/// RMS residuals of the refitted nominal law and of the improved rig file on the trials kept back.
fn held_out_rms(specimen: &Specimen, improved: &Path) -> Result<[f64; 2]> {
    let origin = improved.display().to_string();
    let nominal = held_out::refitted(&specimen.rig, &specimen.rig_file.display().to_string(), &specimen.training)?;
    held_out::left([&nominal, &Rig::read(improved)?], &origin, &specimen.held_out, specimen.set.own_to_trial)
}
