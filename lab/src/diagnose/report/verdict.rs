//! The verdict's word.

use schemars::JsonSchema;
use serde::Serialize;

use crate::diagnose::drive::outcome::Finding;

/// What came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The simulation leaves no more than the sensors do.
    NoMismatch,
    /// Only values are off.
    Parameters,
    /// Physics is missing, and named.
    Explained,
    /// Physics is named and something is left.
    PartlyExplained,
    /// Something is missing that no effect explains.
    Unknown,
}

/// The word of what was found of a channel.
#[must_use]
pub fn verdict(finding: Finding) -> Verdict {
    match finding {
        Finding::NoMismatch => Verdict::NoMismatch,
        Finding::Parameters => Verdict::Parameters,
        Finding::Explained => Verdict::Explained,
        Finding::PartlyExplained => Verdict::PartlyExplained,
        Finding::Unknown => Verdict::Unknown,
    }
}
