//! How it stands with the simulation, or with a part of it.

use schemars::JsonSchema;
use serde::Serialize;

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
