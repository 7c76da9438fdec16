//! The score of all cases, in the layout of `palpate.challenge/1`.

use anyhow::{Result, bail, ensure};
use palpate_cases::truth::CaseKind;
use serde::{Deserialize, Serialize};

use super::case_counts::{NoEffectCounts, OutsideCounts, PairCounts};
use super::case_score::{CaseScore, ParameterScore};
use super::commitment::{OpenedAnswers, Origin, hash};
use super::drawn_answer::DrawnAnswer;
use super::external_cases::ExternalAnswer;
use super::external_score::{ExternalCaseScore, ExternalSetScore};
use super::recordings::specimen_score::RecordingScores;
use super::scored_case::ScoredCase as _;
use super::single_effect_counts::SingleEffectCounts;
use super::statistics::{median, share};

/// A run: its score, and the cases it was made of.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ChallengeScore {
    /// "palpate.challenge/1".
    pub schema: String,
    /// Of all cases.
    pub seed: u64,
    /// Of the answers, before the first diagnosis.
    pub sealed_sha256: String,
    /// How many.
    pub cases: usize,
    /// Nothing is missing.
    pub none: NoEffectCounts,
    /// One effect of the list.
    pub single: SingleEffectCounts,
    /// Two effects of the list.
    pub pairs: PairCounts,
    /// One effect that the list does not hold.
    pub outside: OutsideCounts,
    /// Of single effects that were named rightly.
    pub parameters: ParameterStatistics,
    /// Held-out residual over the expected noise where listed effects were named rightly, medians.
    pub residual_over_floor: ResidualStatistics,
    /// Of one diagnosis.
    pub seconds_median: f64,
    /// Cases of other authors, a score for each folder.
    #[serde(default)]
    pub sources: Vec<ExternalSetScore>,
    /// Real recordings, where there were any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<RecordingScores>,
    /// What was left out of the run, and why.
    pub left_out: Vec<String>,
    /// Every drawn case.
    pub rows: Vec<CaseScore>,
    /// SHA-256 over the rows of drawn cases, of other authors' cases and of real recordings, as they were scored.
    #[serde(default)]
    pub rows_sha256: String,
    /// The lines that `sealed_sha256` commits to: true answer and files of every case.
    #[serde(default)]
    pub answers: Vec<String>,
}

/// Parameters of effects that were named rightly.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ParameterStatistics {
    /// Relative, absolute value.
    pub median_error: f64,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage: f64,
}

/// Held-out residual over the expected noise.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ResidualStatistics {
    /// Nominal physics, values refitted.
    pub before_median: f64,
    /// With the named physics.
    pub after_median: f64,
}

impl ChallengeScore {
    /// The score of `rows`, of `sources` and of `recorded`, which were scored against `answers`.
    ///
    /// # Errors
    /// The rows cannot be written as JSON.
    pub fn of(
        seed: u64,
        answers: &OpenedAnswers,
        rows: Vec<CaseScore>,
        sources: Vec<ExternalSetScore>,
        recorded: Option<RecordingScores>,
        left_out: Vec<String>,
    ) -> Result<Self> {
        let rows_sha256 = rows_hash(&rows, &sources, recorded.as_ref())?;
        let of = |kind: CaseKind| rows.iter().filter(|row| row.kind == kind).collect::<Vec<_>>();
        let (none, single, pairs, outside) =
            (of(CaseKind::None), of(CaseKind::Single), of(CaseKind::Pair), of(CaseKind::Outside));
        let values: Vec<&ParameterScore> = single.iter().flat_map(|row| &row.values).collect();
        let right = |pick: fn(&CaseScore) -> Option<f64>| {
            median(single.iter().chain(&pairs).filter(|row| row.is_right()).filter_map(|row| pick(row)))
        };
        Ok(Self {
            schema: "palpate.challenge/1".to_owned(),
            seed,
            sealed_sha256: answers.sha256().to_owned(),
            cases: rows.len(),
            none: NoEffectCounts::of(&none),
            pairs: PairCounts::of(&pairs),
            outside: OutsideCounts::of(&outside),
            parameters: ParameterStatistics {
                median_error: median(values.iter().map(|value| value.error())),
                coverage: share(values.iter().filter(|value| value.covered).count(), values.len()),
            },
            residual_over_floor: ResidualStatistics {
                before_median: right(|row| row.answer.before),
                after_median: right(|row| row.answer.after),
            },
            seconds_median: median(rows.iter().map(|row| row.seconds)),
            single: SingleEffectCounts::of(&single),
            sources,
            recorded,
            left_out,
            rows,
            rows_sha256,
            answers: answers.lines().to_vec(),
        })
    }

    /// Checks a published score against itself: the answers against the commitment, what the rows say is true against the
    /// answers, the rows against their hash, and every count against the rows.
    ///
    /// # Errors
    /// Something was changed after it was scored, or the score was written before answers were published.
    pub fn check(&self) -> Result<()> {
        ensure!(!self.answers.is_empty(), "no answers: nothing in it can be checked against its commitment");
        let answers = OpenedAnswers::check(self.answers.clone(), &self.sealed_sha256)?;
        self.check_truths(&answers)?;
        let found = rows_hash(&self.rows, &self.sources, self.recorded.as_ref())?;
        ensure!(found == self.rows_sha256, "rows of SHA-256 {found}, where {} were scored", self.rows_sha256);
        let again = |set: &ExternalSetScore| ExternalSetScore::of(&set.name, set.rows.clone());
        let (sources, recorded) = (self.sources.iter().map(again).collect(), self.recorded.as_ref());
        let recorded = recorded.map(|recorded| RecordingScores::of(recorded.rows.clone()));
        let counted = Self::of(self.seed, &answers, self.rows.clone(), sources, recorded, self.left_out.clone())?;
        ensure!(
            serde_json::to_value(&counted)? == serde_json::to_value(self)?,
            "counts that are not those of its rows"
        );
        Ok(())
    }

    /// Every row has an answer of its own, and says what that says is true.
    fn check_truths(&self, answers: &OpenedAnswers) -> Result<()> {
        let mut rows = self.rows.iter();
        let mut external = self.sources.iter().flat_map(|set| set.rows.iter().map(move |row| (&set.name, row)));
        let (mut row, mut other) = (rows.next(), external.next());
        for case in answers.cases() {
            let answer = case.answer.clone();
            match case.origin {
                Origin::Drawn => {
                    let answer: DrawnAnswer = serde_json::from_value(answer)?;
                    if row.is_some_and(|row| row.states(&answer)) {
                        row = rows.next();
                    }
                }
                Origin::External => {
                    let answer: ExternalAnswer = serde_json::from_value(answer)?;
                    let states = |(set, row): (&String, &ExternalCaseScore)| *set == answer.set && row.states(&answer);
                    if other.is_some_and(states) {
                        other = external.next();
                    }
                }
                Origin::Recorded => {}
            }
        }
        if let Some(row) = row {
            bail!("case {} of seed {}: something else is said to be true than was committed to", row.index, row.seed);
        }
        if let Some((set, row)) = other {
            bail!("{set}/{}: something else is said to be true than was committed to", row.case);
        }
        let real = answers.cases().iter().filter(|case| case.origin == Origin::Recorded);
        let names: Vec<&str> = real.filter_map(|case| case.answer.get("recording")?.as_str()).collect();
        let rows = self.recorded.iter().flat_map(|recorded| &recorded.rows);
        for row in rows {
            ensure!(names.contains(&row.recording.as_str()), "{}: no answer was committed to", row.recording);
        }
        Ok(())
    }
}

/// SHA-256 of all rows as JSON.
fn rows_hash(rows: &[CaseScore], sources: &[ExternalSetScore], recorded: Option<&RecordingScores>) -> Result<String> {
    let others: Vec<_> = sources.iter().map(|set| (&set.name, &set.rows)).collect();
    let real = recorded.map(|recorded| &recorded.rows);
    Ok(hash(serde_json::to_string(&(rows, others, real))?.as_bytes()))
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::challenge::case_score::tests::diagnosis;
    use crate::challenge::commitment::CommittedCase;
    use serde_json::{Value, json};

    /// What is said of each case: kind, concealed, strength, named, alternatives.
    type Told = (&'static str, &'static [&'static str], f64, &'static [&'static str], &'static [&'static str]);

    const CASES: [Told; 14] = [
        ("none", &[], 0.0, &[], &[]),
        ("none", &[], 0.0, &["unknown"], &[]),
        ("none", &[], 0.0, &["adhesion"], &[]),
        ("single", &["adhesion"], 0.2, &[], &[]),
        ("single", &["adhesion"], 0.5, &["cogging"], &["adhesion", "backlash"]),
        ("single", &["adhesion"], 2.0, &["adhesion"], &[]),
        ("single", &["cogging"], 2.0, &["cogging"], &["backlash"]),
        ("single", &["cogging"], 5.0, &["cogging", "unknown"], &[]),
        ("single", &["cogging"], 5.0, &["unknown"], &[]),
        ("pair", &["adhesion", "cogging"], 3.0, &["adhesion", "cogging"], &[]),
        ("pair", &["adhesion", "cogging"], 3.0, &["adhesion"], &["cogging"]),
        ("outside", &["reflex"], 2.0, &["unknown"], &[]),
        ("outside", &["reflex"], 2.0, &["adhesion", "unknown"], &[]),
        ("outside", &["reflex"], 2.0, &["adhesion"], &[]),
    ];

    fn line(index: usize, (kind, truth, strength, ..): &Told) -> String {
        let effect = |name: &&str| json!({"name": name, "parameters": [], "strength_asked": strength});
        let answer = json!({
            "source": "own", "seed": 3, "index": index, "kind": kind, "strength": strength, "grade": "coarse",
            "reference": "poor", "effects": truth.iter().map(effect).collect::<Vec<_>>(), "channels": ["force_N"],
        });
        let case =
            CommittedCase { case: format!("case-{index:04}"), origin: Origin::Drawn, files: BTreeMap::new(), answer };
        serde_json::to_string(&case).unwrap()
    }

    /// The score of [`CASES`], the last of which did not come to an answer, and of two cases of another author.
    pub fn score() -> ChallengeScore {
        let mut lines: Vec<String> = CASES.iter().enumerate().map(|(index, case)| line(index, case)).collect();
        let other = |(case, truth): (&str, &[&str])| ExternalAnswer {
            set: "elsewhere".to_owned(),
            case: case.to_owned(),
            truth: truth.iter().map(|name| (*name).to_owned()).collect(),
            also: Vec::new(),
        };
        let others = [("000", &[][..]), ("001", &["adhesion"])].map(other);
        for answer in &others {
            let answer = serde_json::to_value(answer).unwrap();
            let case = CommittedCase { case: "x".to_owned(), origin: Origin::External, files: BTreeMap::new(), answer };
            lines.push(serde_json::to_string(&case).unwrap());
        }
        let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
        let answers = OpenedAnswers::check(lines, &hash(text.as_bytes())).unwrap();
        let row = |(index, (_, _, _, named, alternatives)): (usize, &Told)| {
            let answer: DrawnAnswer = serde_json::from_value(answers.cases()[index].answer.clone()).unwrap();
            CaseScore::score(&answer, Ok(&diagnosis(named, alternatives)), index as f64)
        };
        let rows = CASES.iter().enumerate().map(row).collect();
        let found = diagnosis(&["adhesion"], &[]);
        let others = others.iter().map(|answer| ExternalCaseScore::score(answer, Ok(&found), 1.0)).collect();
        let sources = vec![ExternalSetScore::of("elsewhere", others)];
        ChallengeScore::of(3, &answers, rows, sources, None, Vec::new()).unwrap()
    }

    #[test]
    fn every_count_is_the_one_that_is_counted_by_hand() {
        let score = score();
        assert_eq!((score.cases, score.seed), (14, 3));
        assert_eq!((score.none.n, score.none.false_alarms), (3, 2));
        let single = &score.single;
        assert_eq!((single.n, single.detected, single.named_rightly, single.within_rivals), (6, 5, 2, 4));
        // Names in answer and alternatives: 3, 1, 2, 2 and 1.
        assert!((single.mean_set_size - 9.0 / 5.0).abs() < 1e-12, "{}", single.mean_set_size);
        let bands: Vec<_> =
            single.by_strength.iter().map(|b| (b.from, b.to, b.n, b.detected, b.named_rightly)).collect();
        assert_eq!(bands, [(0.1, 0.316, 1, 0, 0), (0.316, 1.0, 1, 1, 0), (1.0, 3.16, 2, 2, 2), (3.16, 10.0, 2, 2, 0)]);
        let of = |name: &str| (single.by_effect[name].n, single.by_effect[name].named_rightly);
        assert_eq!((of("adhesion"), of("cogging"), single.by_effect.len()), ((3, 1), (3, 1), 2));
        assert_eq!((score.pairs.n, score.pairs.named_rightly), (2, 1));
        assert_eq!((score.outside.n, score.outside.owned), (3, 2));
        // Each diagnosis leaves 4.0 of the expected noise before and 1.2 after.
        assert_eq!((score.residual_over_floor.before_median, score.residual_over_floor.after_median), (4.0, 1.2));
        assert_eq!(score.seconds_median, 6.5);
        let [other] = score.sources.as_slice() else { panic!() };
        assert_eq!((other.cases, other.none.false_alarms, other.single.named_rightly), (2, 1, 1));
    }

    #[test]
    fn intervals_that_hold_the_truth_and_those_that_do_not_are_counted() {
        let mut row = score().rows[5].clone();
        let value = |value, covered| ParameterScore { name: String::new(), truth: 2.0, value, covered };
        row.values = vec![value(2.2, true), value(1.0, false), value(2.6, false), value(2.0, true)];
        let answers = OpenedAnswers::check(Vec::new(), &hash(b"")).unwrap();
        let score = ChallengeScore::of(3, &answers, vec![row], Vec::new(), None, Vec::new()).unwrap();
        assert_eq!(score.parameters.coverage, 0.5);
        // 0, 10, 30 and 50 %.
        assert!((score.parameters.median_error - 0.2).abs() < 1e-12, "{}", score.parameters.median_error);
    }

    /// The score with its JSON edited.
    fn edited(edit: impl Fn(&mut Value)) -> ChallengeScore {
        let mut value = serde_json::to_value(score()).unwrap();
        edit(&mut value);
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn a_score_that_was_read_back_passes_its_check() {
        edited(|_| ()).check().unwrap();
    }

    #[test]
    fn an_edited_score_is_refused() {
        type Edit = (&'static str, fn(&mut Value));
        let edits: [Edit; 11] = [
            ("an answer of the diagnosis", |score| score["rows"][4]["named"] = json!(["adhesion"])),
            ("an alternative", |score| score["rows"][3]["rivals"] = json!([["adhesion"]])),
            ("what was concealed", |score| score["rows"][4]["truth"] = json!(["cogging"])),
            ("how strong it was", |score| score["rows"][3]["strength"] = json!(2.0)),
            ("a row taken away", |score| drop(score["rows"].as_array_mut().unwrap().remove(2))),
            ("a row twice", |score| {
                let row = score["rows"][5].clone();
                score["rows"].as_array_mut().unwrap().push(row);
            }),
            ("a count", |score| score["none"]["false_alarms"] = json!(0)),
            ("an answer of another author's case", |score| score["sources"][0]["rows"][0]["named"] = json!([])),
            ("a count of them", |score| score["sources"][0]["none"]["false_alarms"] = json!(0)),
            ("a committed answer", |score| {
                let line = score["answers"][4].as_str().unwrap().replace("adhesion", "cogging");
                score["answers"][4] = json!(line);
            }),
            ("no answers", |score| score["answers"] = json!([])),
        ];
        for (what, edit) in edits {
            assert!(edited(edit).check().is_err(), "{what}");
        }
    }

    /// Whoever edits a row may write its hash anew, but the truth of it stays that of the commitment.
    #[test]
    fn a_truth_other_than_committed_to_is_refused_whatever_the_hash_of_the_rows() {
        let rewritten = |edit: fn(&mut ChallengeScore)| {
            let mut score = score();
            edit(&mut score);
            score.rows_sha256 = rows_hash(&score.rows, &score.sources, None).unwrap();
            format!("{:#}", score.check().unwrap_err())
        };
        let own = rewritten(|score| score.rows[4].truth = vec!["cogging".to_owned()]);
        assert!(own.contains("something else is said to be true"), "{own}");
        let other = rewritten(|score| score.sources[0].rows[0].truth = vec!["adhesion".to_owned()]);
        assert!(other.contains("elsewhere/000"), "{other}");
    }

    #[test]
    fn a_real_recording_is_scored_against_an_answer_of_its_own_name() {
        use crate::challenge::recordings::grade::Grade;
        use crate::challenge::recordings::specimen_score::tests::row;
        let line = |origin: &str, name: &str| {
            let answer = json!({"recording": name, "set": "elsewhere", "case": "x", "truth": [], "also": []});
            json!({"case": "x", "origin": origin, "files": {}, "answer": answer}).to_string()
        };
        let check = |lines: Vec<String>| {
            let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
            let answers = OpenedAnswers::check(lines, &hash(text.as_bytes())).unwrap();
            let real = RecordingScores::of(vec![row(Grade::Named, &["gravity_load"], None)]);
            ChallengeScore::of(3, &answers, Vec::new(), Vec::new(), Some(real), Vec::new()).unwrap().check()
        };
        check(vec![line("recorded", "arm/one")]).unwrap();
        for lines in [vec![line("recorded", "arm/two")], vec![line("external", "arm/one")]] {
            let error = check(lines).unwrap_err().to_string();
            assert!(error.contains("arm/one: no answer was committed to"), "{error}");
        }
    }
}
