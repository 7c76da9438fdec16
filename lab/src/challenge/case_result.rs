//! What a diagnosis said of one case, before anything is known of its true answer.

use serde::{Deserialize, Serialize};

use super::baselines::BaselineScore;
use super::diagnosis_json::DiagnosisJson;
use super::recordings::specimen_score::ResidualPair;
use super::recordings::specimen_score::spaced;

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

    /// For people who watch a run, who do not see the true answers either.
    #[must_use]
    pub fn line(&self) -> String {
        match self.diagnosis() {
            Ok(diagnosis) => format!("{}: {}, {:.1} s", self.case, spaced(&diagnosis.names()), self.seconds),
            Err(failure) => format!("{}: no answer, {:.1} s: {failure}", self.case, self.seconds),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_the_names_or_why_there_is_none_and_no_truth() {
        let found = crate::challenge::case_score::tests::diagnosis(&["adhesion"], &["cogging"]);
        assert_eq!(CaseResult::new("case-1", Ok(found), 1.5).line(), "case-1: adhesion, 1.5 s");
        let broke = CaseResult::new("case-2", Err("it stopped".to_owned()), 2.5);
        assert_eq!(broke.line(), "case-2: no answer, 2.5 s: it stopped");
        let lost = CaseResult { failure: None, ..broke };
        assert_eq!(lost.diagnosis().err(), Some("no answer"));
    }
}
