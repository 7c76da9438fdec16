//! What came of one case.

use std::collections::BTreeSet;

use palpate_cases::reference;
use palpate_cases::sensors::Grade;
use palpate_cases::truth::Kind;
use palpate_lab::diagnose::answer::Verdict;
use serde::Serialize;

/// The name under which an answer owns that nothing of its list explains the rest.
const UNKNOWN: &str = "unknown";

/// One case, scored.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    pub seed: u64,
    pub index: u64,
    pub kind: Kind,
    /// What was concealed.
    pub truth: Vec<String>,
    /// The strongest that was asked for.
    pub asked: f64,
    /// Of all effects together.
    pub strength: f64,
    pub grade: Grade,
    pub reference: reference::Kind,
    /// Whether the effort is recorded.
    pub effort: bool,
    /// The answer.
    pub named: Vec<String>,
    /// What the answer says that the data do not tell from it.
    pub rivals: Vec<Vec<String>>,
    pub verdict: Option<Verdict>,
    /// Held-out residual over the floor, values refitted.
    pub before: Option<f64>,
    /// The same with the named physics.
    pub after: Option<f64>,
    /// Parameters of the same law, where the answer is right.
    pub values: Vec<Compared>,
    pub seconds: f64,
    /// Why there is no answer.
    pub failure: Option<String>,
}

/// A parameter held against its truth.
#[derive(Debug, Clone, Serialize)]
pub struct Compared {
    /// "hunt_crossley_damping alpha".
    pub name: String,
    pub truth: f64,
    pub value: f64,
    /// Whether the 95 % interval holds the truth.
    pub covered: bool,
}

impl Compared {
    /// |value / truth - 1|
    pub fn error(&self) -> f64 {
        (self.value / self.truth - 1.0).abs()
    }
}

fn set(names: &[String]) -> BTreeSet<&str> {
    names.iter().map(String::as_str).collect()
}

impl Row {
    /// Physics named, or owned as unknown.
    pub fn is_detected(&self) -> bool {
        !self.named.is_empty()
    }

    /// Physics where nothing is missing.
    pub fn is_false_alarm(&self) -> bool {
        self.kind == Kind::None && self.is_detected()
    }

    /// Whether the unknown is owned.
    pub fn is_owned(&self) -> bool {
        self.named.iter().any(|name| name == UNKNOWN)
    }

    /// The names of the answer are those of the truth, none more; outside of the list, the unknown alone.
    pub fn is_right(&self) -> bool {
        match self.kind {
            _ if self.failure.is_some() => false,
            Kind::Outside => set(&self.named) == BTreeSet::from([UNKNOWN]),
            _ => set(&self.named) == set(&self.truth),
        }
    }

    /// The truth is among the names of the answer and its rivals.
    pub fn is_within(&self) -> bool {
        let hidden = set(&self.truth);
        self.is_right() || (!hidden.is_empty() && self.is_detected() && hidden.is_subset(&self.offered()))
    }

    /// Every name in the answer and its rivals.
    pub fn offered(&self) -> BTreeSet<&str> {
        self.named.iter().chain(self.rivals.iter().flatten()).map(String::as_str).collect()
    }

    /// For people who watch.
    pub fn line(&self) -> String {
        let mark = match () {
            () if self.failure.is_some() => "BROKE",
            () if self.is_right() => "right",
            () if self.is_within() => "within",
            () if self.is_detected() => "WRONG",
            () => "missed",
        };
        format!(
            "{mark:6} {}/{} {:?} -> {:?} rivals {:?}, strength {:.2}, {:?} {:?}, after {:.2} of the floor, {:.1} s{}",
            self.seed,
            self.index,
            self.truth,
            self.named,
            self.rivals,
            self.strength,
            self.grade,
            self.reference,
            self.after.unwrap_or(f64::NAN),
            self.seconds,
            self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default()
        )
    }
}
