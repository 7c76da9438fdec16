//! From opened answers and the results of all diagnoses to the score.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, ensure};

use super::case_result::CaseResult;
use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::commitment::{CommittedCase, OpenedAnswers, Origin};
use super::drawn_answer::DrawnAnswer;
use super::external_cases::{ExternalAnswer, ExternalCaseScore, ExternalSetScore};
use super::recordings::specimen::Specimen;
use super::recordings::specimen_score::{RecordingScores, SpecimenScore};

/// Scores `results`, by case, against `answers`. Cases without a result are left out, and said so.
///
/// # Errors
/// An answer that cannot be read, or a real recording of which something else is known than was committed to.
pub fn score(
    seed: u64,
    answers: &OpenedAnswers,
    results: &BTreeMap<String, CaseResult>,
    specimens: &[Specimen],
    mut left_out: Vec<String>,
) -> Result<ChallengeScore> {
    let (mut rows, mut sets, mut real) = (Vec::new(), Vec::<(String, Vec<ExternalCaseScore>)>::new(), Vec::new());
    let (mut numbered, mut unreached) = (specimens.iter(), 0);
    for case in answers.cases() {
        let specimen = if case.origin == Origin::Recorded { numbered.next() } else { None };
        let Some(result) = results.get(&case.case) else {
            unreached += 1;
            continue;
        };
        match case.origin {
            Origin::Drawn => rows.push(drawn(case, result)?),
            Origin::External => {
                let (set, row) = external(case, result)?;
                match sets.last_mut() {
                    Some((name, rows)) if *name == set => rows.push(row),
                    _ => sets.push((set, vec![row])),
                }
            }
            Origin::Recorded => real.push(recorded(case, specimen, result)?),
        }
    }
    if unreached > 0 {
        let all = answers.cases().len();
        left_out.push(format!("{unreached} of {all} cases: not reached in the minutes that were given"));
    }
    rows.iter().for_each(|row| eprintln!("{}", row.line()));
    sets.iter().flat_map(|(_, rows)| rows).for_each(|row| eprintln!("{}", row.line()));
    real.iter().for_each(|row| eprintln!("{}", row.line()));
    let sets = sets.into_iter().map(|(name, rows)| ExternalSetScore::of(&name, rows)).collect();
    let real = (!real.is_empty()).then(|| RecordingScores::of(real));
    ChallengeScore::of(seed, answers, rows, sets, real, left_out)
}

fn drawn(case: &CommittedCase, result: &CaseResult) -> Result<CaseScore> {
    let answer: DrawnAnswer = serde_json::from_value(case.answer.clone()).with_context(|| case.case.clone())?;
    let mut row = CaseScore::score(&answer, result.diagnosis(), result.seconds);
    row.baselines.clone_from(&result.baselines);
    Ok(row)
}

fn external(case: &CommittedCase, result: &CaseResult) -> Result<(String, ExternalCaseScore)> {
    let answer: ExternalAnswer = serde_json::from_value(case.answer.clone()).with_context(|| case.case.clone())?;
    let row = ExternalCaseScore::score(&answer, result.diagnosis(), result.seconds);
    Ok((answer.set, row))
}

fn recorded(case: &CommittedCase, specimen: Option<&Specimen>, result: &CaseResult) -> Result<SpecimenScore> {
    let specimen = specimen.with_context(|| format!("{}: the real recording is gone", case.case))?;
    let known = serde_json::to_value(specimen.sealed()).context("an answer cannot be written as JSON")?;
    ensure!(known == case.answer, "{}: something else is known of it than was committed to", specimen.name);
    let mut row = SpecimenScore::score(specimen, result.diagnosis(), result.seconds);
    match &result.held_out {
        Some(Ok(pair)) => row.held_out = Some(*pair),
        Some(Err(failure)) => row.failure = Some(failure.clone()),
        None => {}
    }
    Ok(row)
}
