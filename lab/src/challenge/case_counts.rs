//! How many cases came out how, of ours and of another author.

use serde::{Deserialize, Serialize};

use super::scored_case::ScoredCase;

/// Cases in which nothing is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct NoEffectCounts {
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub false_alarms: usize,
}

/// Cases with two effects of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairCounts {
    /// How many.
    pub n: usize,
    /// Both and nothing else.
    pub named_rightly: usize,
}

/// Cases with an effect that the list does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutsideCounts {
    /// How many.
    pub n: usize,
    /// Called unknown.
    pub owned: usize,
}

impl NoEffectCounts {
    /// The counts of `rows`.
    #[must_use]
    pub fn of<C: ScoredCase>(rows: &[&C]) -> Self {
        Self { n: rows.len(), false_alarms: count(rows, |row| row.is_detected() && !row.is_right()) }
    }
}

impl PairCounts {
    /// The counts of `rows`.
    #[must_use]
    pub fn of<C: ScoredCase>(rows: &[&C]) -> Self {
        Self { n: rows.len(), named_rightly: count(rows, C::is_right) }
    }
}

impl OutsideCounts {
    /// The counts of `rows`.
    #[must_use]
    pub fn of<C: ScoredCase>(rows: &[&C]) -> Self {
        Self { n: rows.len(), owned: count(rows, |row| row.is_right() || row.is_owned()) }
    }
}

/// How many of `rows` are so.
#[must_use]
pub fn count<C>(rows: &[&C], is: fn(&C) -> bool) -> usize {
    rows.iter().filter(|row| is(row)).count()
}
