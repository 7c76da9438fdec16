//! What a recording shows before anything is fitted, or what limits an answer.

use schemars::JsonSchema;
use serde::Serialize;

/// Something to know.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Finding {
    /// What it is, for programs: "one_speed". Of a code there is at most one finding of the recordings.
    pub code: &'static str,
    /// Whether it casts doubt on the answer.
    pub grave: bool,
    /// File, channel or time it is about; empty where it is about all.
    pub place: String,
    /// The finding and what to do about it.
    pub text: String,
}
