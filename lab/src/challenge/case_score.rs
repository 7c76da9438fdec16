//! What came of one case.

use palpate_cases::SimulatorKind;
use palpate_cases::excitation::Excitation;
use palpate_cases::sensors::SensorGrade;
use palpate_cases::truth::CaseKind;
use serde::{Deserialize, Serialize};

use super::baselines::BaselineScore;
use super::diagnosed_answer::DiagnosedAnswer;
use super::diagnosis_json::DiagnosisJson;
use super::drawn_answer::DrawnAnswer;
use super::parameter_score;
use super::recordings::specimen_score::spaced;
use super::scored_case::{ScoredCase, UNKNOWN};

/// One case, scored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CaseScore {
    /// Of all cases.
    pub seed: u64,
    /// Place in the whole list.
    pub index: u64,
    /// Whose simulation played it.
    pub source: SimulatorKind,
    /// What it is about.
    pub kind: CaseKind,
    /// What was concealed.
    pub truth: Vec<String>,
    /// The strongest that was asked for.
    pub asked: f64,
    /// Of all effects together.
    pub strength: f64,
    /// Coarse or fine sensors.
    pub grade: SensorGrade,
    /// Rich or poor trajectories.
    #[serde(rename = "reference")]
    pub excitation: Excitation,
    /// Whether the effort is recorded.
    pub effort: bool,
    /// What the diagnosis answered.
    #[serde(flatten)]
    pub answer: DiagnosedAnswer,
    /// Parameters of the same law, where the answer is right.
    pub values: Vec<ParameterScore>,
    /// From the command's start to its end.
    pub seconds: f64,
    /// What others make of it, where they were asked.
    #[serde(default, rename = "others")]
    pub baselines: Vec<BaselineScore>,
    /// Why there is no answer.
    pub failure: Option<String>,
}

/// A parameter held against its truth.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ParameterScore {
    /// "hunt_crossley_damping alpha".
    pub name: String,
    /// In the case's own units.
    pub truth: f64,
    /// What the answer says.
    pub value: f64,
    /// Whether the 95 % interval holds the truth.
    pub covered: bool,
}

impl ParameterScore {
    /// |value / truth - 1|
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.value / self.truth - 1.0).abs()
    }
}

impl CaseScore {
    /// Compares the diagnosis of a case, or why there is none, with its `truth`.
    #[must_use]
    pub fn score(truth: &DrawnAnswer, diagnosis: Result<&DiagnosisJson, &str>, seconds: f64) -> Self {
        let mut row = Self {
            seed: truth.seed,
            index: truth.index,
            source: truth.source,
            kind: truth.kind,
            truth: truth.effects.iter().map(|effect| effect.name.clone()).collect(),
            asked: truth.effects.iter().map(|effect| effect.strength_asked).fold(0.0, f64::max),
            strength: truth.strength,
            grade: truth.grade,
            excitation: truth.excitation,
            effort: truth.channels.iter().any(|channel| channel.starts_with("effort")),
            answer: DiagnosedAnswer::default(),
            values: Vec::new(),
            seconds,
            baselines: Vec::new(),
            failure: None,
        };
        match diagnosis {
            Err(failure) => row.failure = Some(failure.to_owned()),
            Ok(diagnosis) => {
                row.answer = DiagnosedAnswer::of(diagnosis);
                if truth.kind == CaseKind::Single && row.is_right() {
                    row.values = parameter_score::compare(truth, &diagnosis.physics);
                }
            }
        }
        row
    }

    /// Whether what it says is true is what `answer` says.
    #[must_use]
    pub fn states(&self, answer: &DrawnAnswer) -> bool {
        let same = |row: Self| {
            let facts = |row: &Self| (row.seed, row.index, row.source, row.kind, row.asked, row.strength, row.effort);
            facts(&row) == facts(self)
                && (row.truth, row.grade, row.excitation) == (self.truth.clone(), self.grade, self.excitation)
        };
        same(Self::score(answer, Err(""), 0.0))
    }

    /// One effect of the list, at least as large as the expected noise.
    #[must_use]
    pub fn is_large(&self) -> bool {
        self.kind == CaseKind::Single && self.strength >= 1.0
    }

    /// Physics where nothing is missing.
    #[must_use]
    pub fn is_false_alarm(&self) -> bool {
        self.kind == CaseKind::None && self.is_detected()
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        format!(
            "{:6} {}/{}/{} {} -> {}; not ruled out: {}; strength {:.2}, {} sensors, {} motion, left {}, {:.1} s{}",
            self.mark(),
            self.seed,
            self.index,
            self.source.name(),
            spaced(&self.truth),
            spaced(&self.answer.named),
            listed(&self.answer.alternatives),
            self.strength,
            word(&self.grade),
            word(&self.excitation),
            self.answer.after.map_or_else(|| "unknown".to_owned(), |after| format!("{after:.2} of the expected noise")),
            self.seconds,
            self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default()
        )
    }
}

/// Each set by its names.
fn listed(sets: &[Vec<String>]) -> String {
    let each: Vec<String> = sets.iter().map(|set| spaced(set)).collect();
    if each.is_empty() { "nothing".to_owned() } else { each.join(" or ") }
}

/// The word of a choice, as it stands in the JSON.
fn word(choice: &impl Serialize) -> String {
    serde_json::to_value(choice).ok().and_then(|word| Some(word.as_str()?.replace('_', " "))).unwrap_or_default()
}

impl ScoredCase for CaseScore {
    fn truth(&self) -> &[String] {
        &self.truth
    }

    fn answer(&self) -> &DiagnosedAnswer {
        &self.answer
    }

    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// The names of the answer are those of the truth, none more; outside of the list, the unknown alone.
    fn is_right(&self) -> bool {
        match self.kind {
            _ if self.failure.is_some() => false,
            CaseKind::Outside => self.answer.names_exactly(&[UNKNOWN.to_owned()]),
            _ => self.answer.names_exactly(&self.truth),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use serde_json::json;

    /// A case of `kind` that conceals `truth` of `strength`.
    pub fn answer(kind: &str, truth: &[&str], strength: f64) -> DrawnAnswer {
        let effect = |name: &&str| json!({"name": name, "parameters": [], "strength_asked": strength});
        let answer = json!({
            "source": "own", "seed": 1, "index": 7, "kind": kind, "strength": strength, "grade": "fine", "reference": "rich",
            "effects": truth.iter().map(effect).collect::<Vec<_>>(), "channels": ["position_m", "force_N", "effort_N"],
        });
        serde_json::from_value(answer).unwrap()
    }

    /// A diagnosis that names `named` and leaves `alternatives` open, names of each joined by `+`.
    pub fn diagnosis(named: &[&str], alternatives: &[&str]) -> DiagnosisJson {
        let physics: Vec<_> = named.iter().map(|name| json!({"name": name, "parameters": []})).collect();
        let alternatives: Vec<_> =
            alternatives.iter().map(|names| json!({"physics": names.split('+').collect::<Vec<_>>()})).collect();
        let fit = json!({"unit": "N", "noise_floor": 0.5, "refitted": 2.0, "improved": 0.6});
        let schema = super::super::diagnosis_json::SCHEMA;
        let all =
            json!({"schema": schema, "verdict": "explained", "physics": physics, "rivals": alternatives, "fit": fit});
        serde_json::from_value(all).unwrap()
    }

    type Names = &'static [&'static str];

    /// Kind, concealed, named, alternatives, and what holds of it.
    type Judged = (&'static str, Names, Names, Names, &'static str);

    /// Every kind of answer against every kind of truth: detected, right, within, false alarm, unknown reported.
    #[test]
    fn every_answer_against_every_truth() {
        let (one, two, outside): (Names, Names, Names) =
            (&["adhesion"][..], &["adhesion", "cogging"][..], &["reflex"][..]);
        let table: &[Judged] = &[
            ("none", &[], &[], &[], "right within"),
            ("none", &[], &["unknown"], &[], "detected alarm unknown"),
            ("none", &[], &["adhesion"], &[], "detected alarm"),
            ("none", &[], &["adhesion"], &["cogging"], "detected alarm"),
            ("single", one, &[], &[], ""),
            ("single", one, &[], &["adhesion"], ""),
            ("single", one, &["adhesion"], &[], "detected right within"),
            ("single", one, &["adhesion", "adhesion"], &[], "detected right within"),
            ("single", one, &["adhesion"], &["cogging"], "detected right within"),
            ("single", one, &["cogging"], &[], "detected"),
            ("single", one, &["cogging"], &["adhesion"], "detected within"),
            ("single", one, &["cogging"], &["backlash"], "detected"),
            ("single", one, &["unknown"], &[], "detected unknown"),
            ("single", one, &["unknown"], &["adhesion"], "detected within unknown"),
            ("single", one, &["adhesion", "cogging"], &[], "detected within"),
            ("single", one, &["adhesion", "unknown"], &[], "detected within unknown"),
            ("single", one, &["cogging", "unknown"], &[], "detected unknown"),
            ("pair", two, &[], &[], ""),
            ("pair", two, &["cogging", "adhesion"], &[], "detected right within"),
            ("pair", two, &["adhesion"], &[], "detected"),
            ("pair", two, &["adhesion"], &["backlash"], "detected"),
            ("pair", two, &["adhesion"], &["cogging"], "detected within"),
            ("pair", two, &["backlash"], &["adhesion+cogging"], "detected within"),
            ("pair", two, &["adhesion", "unknown"], &[], "detected unknown"),
            ("pair", two, &["adhesion", "cogging", "backlash"], &[], "detected within"),
            ("outside", outside, &[], &[], ""),
            ("outside", outside, &["unknown"], &[], "detected right within unknown"),
            ("outside", outside, &["unknown", "unknown"], &[], "detected right within unknown"),
            ("outside", outside, &["adhesion"], &[], "detected"),
            ("outside", outside, &["adhesion"], &["unknown"], "detected"),
            ("outside", outside, &["adhesion", "unknown"], &[], "detected unknown"),
        ];
        for (kind, truth, named, alternatives, expected) in table {
            let row = CaseScore::score(&answer(kind, truth, 2.0), Ok(&diagnosis(named, alternatives)), 1.0);
            let holds = [
                (row.is_detected(), "detected"),
                (row.is_right(), "right"),
                (row.is_within(), "within"),
                (row.is_false_alarm(), "alarm"),
                (row.is_owned(), "unknown"),
            ];
            let found: Vec<&str> = holds.into_iter().filter(|(is, _)| *is).map(|(_, word)| word).collect();
            assert_eq!(found.join(" "), *expected, "{kind} {truth:?}: {named:?} {alternatives:?}");
        }
    }

    #[test]
    fn no_answer_is_never_right() {
        for (kind, truth) in [("none", &[][..]), ("single", &["adhesion"]), ("outside", &["reflex"])] {
            let row = CaseScore::score(&answer(kind, truth, 2.0), Err("it broke"), 1.0);
            let is = [row.is_right(), row.is_within(), row.is_detected(), row.is_false_alarm(), row.is_owned()];
            assert_eq!(is, [false; 5], "{kind}");
            assert_eq!(row.failure.as_deref(), Some("it broke"));
        }
    }

    #[test]
    fn a_row_holds_what_answer_and_diagnosis_say() {
        let truth = answer("single", &["adhesion"], 0.7);
        let row = CaseScore::score(&truth, Ok(&diagnosis(&["adhesion"], &["cogging+backlash"])), 3.5);
        assert_eq!((row.answer.before, row.answer.after, row.seconds), (Some(4.0), Some(1.2), 3.5));
        assert_eq!((row.seed, row.index, row.strength, row.effort), (1, 7, 0.7, true));
        assert!(!row.is_large() && row.states(&truth));
        assert!(CaseScore::score(&answer("single", &["adhesion"], 1.0), Err(""), 0.0).is_large());
        assert!(!CaseScore::score(&answer("pair", &["adhesion", "cogging"], 1.0), Err(""), 0.0).is_large());
        for other in [
            answer("single", &["cogging"], 0.7),
            answer("single", &["adhesion"], 0.8),
            answer("pair", &["adhesion"], 0.7),
        ] {
            assert!(!row.states(&other), "{other:?}");
        }
        assert_eq!(row.answer.offered(), std::collections::BTreeSet::from(["adhesion", "backlash", "cogging"]));
    }

    /// A diagnosis that names `name` with a pull-off force.
    fn valued(name: &str) -> DiagnosisJson {
        let mut found = diagnosis(&[name], &[]);
        let parameter = json!({"name": "pull_off_force", "value": 2.2, "unit": "N", "ci95": [1.0, 3.0]});
        found.physics[0].parameters = vec![serde_json::from_value(parameter).unwrap()];
        found
    }

    #[test]
    fn values_are_scored_of_one_effect_that_is_named_rightly() {
        let mut truth = answer("single", &["adhesion"], 2.0);
        let parameter = json!({"name": "pull_off", "value": 2.0, "unit": "N"});
        truth.effects[0].parameters = vec![serde_json::from_value(parameter).unwrap()];
        let values = |truth: &DrawnAnswer, name| CaseScore::score(truth, Ok(&valued(name)), 1.0).values.len();
        assert_eq!((values(&truth, "adhesion"), values(&truth, "hysteresis")), (1, 0));
        let outside = DrawnAnswer { kind: CaseKind::Outside, ..truth };
        assert_eq!((values(&outside, "adhesion"), values(&outside, UNKNOWN)), (0, 0));
    }

    #[test]
    fn a_line_begins_with_what_came_of_it() {
        let truth = answer("single", &["adhesion"], 2.0);
        let line = |named: &[&str], alternatives: &[&str]| {
            CaseScore::score(&truth, Ok(&diagnosis(named, alternatives)), 1.0).line()
        };
        assert!(line(&["adhesion"], &[]).starts_with("right  1/7/own"), "{}", line(&["adhesion"], &[]));
        assert!(line(&["cogging"], &["adhesion"]).starts_with("within"));
        assert!(line(&["cogging"], &[]).starts_with("WRONG"));
        assert!(line(&[], &[]).starts_with("missed"));
        let broke = CaseScore::score(&truth, Err("it stopped"), 1.0).line();
        assert!(broke.starts_with("BROKE") && broke.ends_with(": it stopped"), "{broke}");
    }
}
