//! From opened answers and the results of all diagnoses to the score.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, ensure};

use super::case_result::CaseResult;
use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::commitment::{CommittedCase, OpenedAnswers, Origin};
use super::drawn_answer::DrawnAnswer;
use super::external_cases::ExternalAnswer;
use super::external_score::{ExternalCaseScore, ExternalSetScore};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::case_score::tests::diagnosis;
    use crate::challenge::commitment::hash;
    use serde_json::{Value, json};

    fn line(case: &str, origin: &str, answer: &Value) -> String {
        json!({"case": case, "origin": origin, "files": {}, "answer": answer}).to_string()
    }

    /// A drawn case and five of two other authors, of which those of `reached` have a result.
    fn scored(reached: &[&str]) -> ChallengeScore {
        let drawn = json!({
            "source": "own", "seed": 1, "index": 7, "kind": "none", "strength": 0.0, "grade": "fine", "reference": "rich",
            "effects": [], "channels": ["force_N"],
        });
        let other = |set: &str, case: &str| json!({"set": set, "case": case, "truth": ["adhesion"], "also": []});
        let mut lines = vec![line("drawn", "drawn", &drawn)];
        for (case, set) in [("a", "one"), ("b", "one"), ("c", "two"), ("d", "two"), ("e", "two")] {
            lines.push(line(case, "external", &other(set, case)));
        }
        let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
        let answers = OpenedAnswers::check(lines, &hash(text.as_bytes())).unwrap();
        let result = |case: &&str| ((*case).to_owned(), CaseResult::new(case, Ok(diagnosis(&["adhesion"], &[])), 1.0));
        let results = reached.iter().map(result).collect();
        score(1, &answers, &results, &[], vec!["MuJoCo".to_owned()]).unwrap()
    }

    #[test]
    fn cases_are_counted_with_those_of_their_author() {
        let score = scored(&["drawn", "a", "b", "c", "d", "e"]);
        assert_eq!((score.cases, score.none.false_alarms, score.seed), (1, 1, 1));
        let sets: Vec<_> =
            score.sources.iter().map(|set| (set.name.as_str(), set.cases, set.single.named_rightly)).collect();
        assert_eq!(sets, [("one", 2, 2), ("two", 3, 3)]);
        assert!(score.recorded.is_none());
        assert_eq!(score.left_out, ["MuJoCo"]);
    }

    #[test]
    fn a_case_without_a_result_is_left_out_and_said_so() {
        let score = scored(&["a", "c", "e"]);
        assert_eq!(score.cases, 0);
        let sets: Vec<_> = score.sources.iter().map(|set| (set.name.as_str(), set.cases)).collect();
        assert_eq!(sets, [("one", 1), ("two", 2)]);
        assert_eq!(score.left_out, ["MuJoCo", "3 of 6 cases: not reached in the minutes that were given"]);
    }

    #[test]
    fn real_recordings_are_scored_in_the_order_of_their_answers() {
        use crate::challenge::recordings::specimen_score::tests::specimen;
        let specimens = ["arm/one", "arm/two"].map(|name| specimen("dfki_pendulum", name));
        let scored = |answers: [&Specimen; 2]| {
            let sealed = answers.map(|specimen| serde_json::to_value(specimen.sealed()).unwrap());
            let other = json!({"set": "one", "case": "a", "truth": [], "also": []});
            let lines = vec![
                line("x", "external", &other),
                line("r0", "recorded", &sealed[0]),
                line("r1", "recorded", &sealed[1]),
            ];
            let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
            let answers = OpenedAnswers::check(lines, &hash(text.as_bytes())).unwrap();
            let result = |case: &str| CaseResult::new(case, Ok(diagnosis(&["gravity_load"], &[])), 1.0);
            let results = ["x", "r0", "r1"].map(|case| (case.to_owned(), result(case)));
            score(1, &answers, &results.into_iter().collect(), &specimens, Vec::new())
        };
        let recorded = scored([&specimens[0], &specimens[1]]).unwrap().recorded.unwrap();
        let names: Vec<_> = recorded.rows.iter().map(|row| row.recording.as_str()).collect();
        assert_eq!((names, recorded.named), (vec!["arm/one", "arm/two"], 2));
        let error = scored([&specimens[1], &specimens[0]]).unwrap_err().to_string();
        assert!(error.contains("something else is known of it"), "{error}");
    }
}
