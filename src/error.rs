//! Settings that are refused, once, before the first sample.

use core::fmt;

/// A setting outside its range. The update itself cannot fail this way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConfigError {
    /// Name of the field.
    pub parameter: &'static str,
    /// The range it must lie in, in words.
    pub expected: &'static str,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: expected {}", self.parameter, self.expected)
    }
}

impl core::error::Error for ConfigError {}

/// `Err` unless `holds`; a NaN setting makes every comparison false and so is refused too.
pub fn require(holds: bool, parameter: &'static str, expected: &'static str) -> Result<(), ConfigError> {
    if holds { Ok(()) } else { Err(ConfigError { parameter, expected }) }
}

/// `Err` unless `value` is finite and above zero.
pub fn require_positive(value: f32, parameter: &'static str) -> Result<(), ConfigError> {
    require(value.is_finite() && value > 0.0, parameter, "a finite number above zero")
}

/// `Err` unless `value` is finite and not below zero.
pub fn require_not_negative(value: f32, parameter: &'static str) -> Result<(), ConfigError> {
    require(value.is_finite() && value >= 0.0, parameter, "a finite number, zero or above")
}
