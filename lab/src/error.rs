//! What is wrong with a user's input: place, finding, expectation.

use std::fmt::Display;

/// A file at fault, reported so that a person can act on it.
///
/// `place` names the file and the line, column or key; `found` what stands there; `expected` what should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: found {found}, expected {expected}")]
pub struct InputError {
    /// File, and line, column or key where there is one.
    pub place: String,
    /// What stands there.
    pub found: String,
    /// What was expected instead.
    pub expected: String,
}

impl InputError {
    /// An error at `place`.
    pub fn new(place: impl Display, found: impl Display, expected: impl Display) -> Self {
        Self { place: place.to_string(), found: found.to_string(), expected: expected.to_string() }
    }
}

/// A command line at fault: the option, what was found, what was expected. The exit status is 2.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{option}: found {found}, expected {expected}")]
pub struct UsageError {
    /// The option as it is spelt.
    pub option: String,
    /// What it was given.
    pub found: String,
    /// What was expected instead.
    pub expected: String,
}

impl UsageError {
    /// An error of `option`.
    pub fn new(option: impl Display, found: impl Display, expected: impl Display) -> Self {
        Self { option: option.to_string(), found: found.to_string(), expected: expected.to_string() }
    }
}
