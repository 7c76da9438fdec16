//! What a diagnosis said of one case, before anything is known of its true answer.

use serde::{Deserialize, Serialize};

use super::baselines::BaselineScore;
use super::diagnosis_json::DiagnosisJson;
use super::recordings::specimen_score::ResidualPair;

/// One diagnosis that has ended.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CaseResult {
    /// Folder of the case below that of the run.
    pub case: String,
    /// From the command's start to its end.
    pub seconds: f64,
    /// What it wrote.
    pub diagnosis: Option<DiagnosisJson>,
    /// Why it wrote nothing.
    pub failure: Option<String>,
    /// What the baselines found, where they were asked.
    #[serde(default)]
    pub baselines: Vec<BaselineScore>,
    /// Residuals on trials that were kept back, or why there are none; for real recordings.
    #[serde(default)]
    pub held_out: Option<Result<ResidualPair, String>>,
}

impl CaseResult {
    /// Of a command that took `seconds`.
    #[must_use]
    pub fn new(case: &str, diagnosis: Result<DiagnosisJson, String>, seconds: f64) -> Self {
        let (diagnosis, failure) = match diagnosis {
            Ok(diagnosis) => (Some(diagnosis), None),
            Err(failure) => (None, Some(failure)),
        };
        Self { case: case.to_owned(), seconds, diagnosis, failure, baselines: Vec::new(), held_out: None }
    }

    /// The diagnosis, or why there is none.
    ///
    /// # Errors
    /// There is none.
    pub fn diagnosis(&self) -> Result<&DiagnosisJson, &str> {
        self.diagnosis.as_ref().ok_or_else(|| self.failure.as_deref().unwrap_or("no answer"))
    }

    /// For people who watch a run, who are not told the true answers either.
    #[must_use]
    pub fn line(&self) -> String {
        match self.diagnosis() {
            Ok(diagnosis) => format!("{}: {:?}, {:.1} s", self.case, diagnosis.names(), self.seconds),
            Err(failure) => format!("{}: no answer, {:.1} s: {failure}", self.case, self.seconds),
        }
    }
}
