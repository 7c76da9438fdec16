//! What a diagnosis answered in one case, as a score keeps it.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::diagnosis_json::DiagnosisJson;

/// The answer in one case; empty where there is none.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DiagnosedAnswer {
    /// Effects that are named.
    pub named: Vec<String>,
    /// Alternatives that the diagnosis cannot distinguish from its answer.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Vec<String>>,
    /// The verdict, in its word.
    pub verdict: Option<String>,
    /// Held-out residual over the expected noise, values refitted.
    pub before: Option<f64>,
    /// The same with the named physics.
    pub after: Option<f64>,
}

impl DiagnosedAnswer {
    /// That of `diagnosis`.
    #[must_use]
    pub fn of(diagnosis: &DiagnosisJson) -> Self {
        Self {
            named: diagnosis.names(),
            alternatives: diagnosis.alternative_names(),
            verdict: Some(diagnosis.verdict.clone()),
            before: diagnosis.fit.over_floor(diagnosis.fit.refitted),
            after: diagnosis.fit.over_floor(diagnosis.fit.improved),
        }
    }

    /// Whether exactly `names` are named.
    #[must_use]
    pub fn names_exactly(&self, names: &[String]) -> bool {
        set(&self.named) == set(names)
    }

    /// Every name in the answer and its alternatives.
    #[must_use]
    pub fn offered(&self) -> BTreeSet<&str> {
        self.named.iter().chain(self.alternatives.iter().flatten()).map(String::as_str).collect()
    }
}

fn set(names: &[String]) -> BTreeSet<&str> {
    names.iter().map(String::as_str).collect()
}
