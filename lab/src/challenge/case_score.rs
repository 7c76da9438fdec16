//! What came of one case.

use std::collections::BTreeSet;

use palpate_cases::excitation::Excitation;
use palpate_cases::sensors::SensorGrade;
use palpate_cases::truth::CaseKind;
use palpate_cases::{SimulatorKind, Truth};
use serde::{Deserialize, Serialize};

use super::baselines::BaselineScore;
use super::diagnosis_json::DiagnosisJson;
use super::parameter_score;

/// The name under which an answer owns that nothing of its list explains the rest.
pub const UNKNOWN: &str = "unknown";

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
    /// The answer.
    pub named: Vec<String>,
    /// What the answer says that the data do not tell from it.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Vec<String>>,
    /// The verdict, in its word.
    pub verdict: Option<String>,
    /// Held-out residual over the floor, values refitted.
    pub before: Option<f64>,
    /// The same with the named physics.
    pub after: Option<f64>,
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

fn set(names: &[String]) -> BTreeSet<&str> {
    names.iter().map(String::as_str).collect()
}

impl CaseScore {
    /// Holds what was `told` of a case, or why nothing was, against its `truth`.
    #[must_use]
    pub fn score(truth: &Truth, diagnosis: Result<DiagnosisJson, String>, seconds: f64) -> Self {
        let mut row = Self {
            seed: truth.seed,
            index: truth.index,
            source: truth.source,
            kind: truth.kind,
            truth: truth.effects.iter().map(|effect| effect.name.to_owned()).collect(),
            asked: truth.effects.iter().map(|effect| effect.strength_asked).fold(0.0, f64::max),
            strength: truth.strength,
            grade: truth.grade,
            excitation: truth.excitation,
            effort: truth.channels.iter().any(|channel| channel.starts_with("effort")),
            named: Vec::new(),
            alternatives: Vec::new(),
            verdict: None,
            before: None,
            after: None,
            values: Vec::new(),
            seconds,
            baselines: Vec::new(),
            failure: None,
        };
        match diagnosis {
            Err(failure) => row.failure = Some(failure),
            Ok(diagnosis) => {
                row.named = diagnosis.physics.iter().map(|physics| physics.name.clone()).collect();
                row.alternatives =
                    diagnosis.alternatives.iter().map(|alternative| alternative.physics.clone()).collect();
                row.before = diagnosis.fit.over_floor(diagnosis.fit.refitted);
                row.after = diagnosis.fit.over_floor(diagnosis.fit.improved);
                if truth.kind == CaseKind::Single && row.is_right() {
                    row.values = parameter_score::compare(truth, &diagnosis.physics);
                }
                row.verdict = Some(diagnosis.verdict);
            }
        }
        row
    }

    /// One effect of the list, at least as large as the floor.
    #[must_use]
    pub fn is_large(&self) -> bool {
        self.kind == CaseKind::Single && self.strength >= 1.0
    }

    /// Physics named, or owned as unknown.
    #[must_use]
    pub fn is_detected(&self) -> bool {
        !self.named.is_empty()
    }

    /// Physics where nothing is missing.
    #[must_use]
    pub fn is_false_alarm(&self) -> bool {
        self.kind == CaseKind::None && self.is_detected()
    }

    /// Whether the unknown is owned.
    #[must_use]
    pub fn is_owned(&self) -> bool {
        self.named.iter().any(|name| name == UNKNOWN)
    }

    /// The names of the answer are those of the truth, none more; outside of the list, the unknown alone.
    #[must_use]
    pub fn is_right(&self) -> bool {
        match self.kind {
            _ if self.failure.is_some() => false,
            CaseKind::Outside => set(&self.named) == BTreeSet::from([UNKNOWN]),
            _ => set(&self.named) == set(&self.truth),
        }
    }

    /// The truth is among the names of the answer and its rivals.
    #[must_use]
    pub fn is_within(&self) -> bool {
        let hidden = set(&self.truth);
        self.is_right() || (!hidden.is_empty() && self.is_detected() && hidden.is_subset(&self.offered()))
    }

    /// Every name in the answer and its rivals.
    #[must_use]
    pub fn offered(&self) -> BTreeSet<&str> {
        self.named.iter().chain(self.alternatives.iter().flatten()).map(String::as_str).collect()
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        let mark = match () {
            () if self.failure.is_some() => "BROKE",
            () if self.is_right() => "right",
            () if self.is_within() => "within",
            () if self.is_detected() => "WRONG",
            () => "missed",
        };
        format!(
            "{mark:6} {}/{}/{} {:?} -> {:?} rivals {:?}, strength {:.2}, {:?} {:?}, after {:.2} of the floor, {:.1} s{}",
            self.seed,
            self.index,
            self.source.name(),
            self.truth,
            self.named,
            self.alternatives,
            self.strength,
            self.grade,
            self.excitation,
            self.after.unwrap_or(f64::NAN),
            self.seconds,
            self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default()
        )
    }
}
