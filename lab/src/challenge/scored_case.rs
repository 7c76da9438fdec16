//! A case whose answer has been held against the truth, drawn by us or made by another author.

use super::diagnosed_answer::DiagnosedAnswer;

/// The name under which an answer reports that nothing of its list explains the rest.
pub const UNKNOWN: &str = "unknown";

/// A case with its answer and its truth.
pub trait ScoredCase {
    /// Effects that it conceals.
    fn truth(&self) -> &[String];

    /// What the diagnosis answered.
    fn answer(&self) -> &DiagnosedAnswer;

    /// Why there is no answer.
    fn failure(&self) -> Option<&str>;

    /// The names are those of the truth, none more, or of what is equally right.
    fn is_right(&self) -> bool;

    /// Something is named, or reported as unknown.
    fn is_detected(&self) -> bool {
        !self.answer().named.is_empty()
    }

    /// Whether the unknown is reported.
    fn is_owned(&self) -> bool {
        self.answer().named.iter().any(|name| name == UNKNOWN)
    }

    /// The whole truth is among the names of the answer and its alternatives.
    fn is_within(&self) -> bool {
        let offered = self.answer().offered();
        let is_hidden = !self.truth().is_empty() && self.is_detected();
        self.is_right() || (is_hidden && self.truth().iter().all(|name| offered.contains(name.as_str())))
    }

    /// How it came out, in a word of six letters at the most.
    fn mark(&self) -> &'static str {
        match () {
            () if self.failure().is_some() => "BROKE",
            () if self.is_right() => "right",
            () if self.is_within() => "within",
            () if self.is_detected() => "WRONG",
            () => "missed",
        }
    }
}
