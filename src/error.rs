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

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use std::string::ToString as _;

    #[test]
    fn a_setting_is_refused_by_its_sign_and_where_it_is_not_finite() {
        for (value, positive, not_negative) in [
            (1.0, true, true),
            (f32::MIN_POSITIVE, true, true),
            (0.0, false, true),
            (-1.0, false, false),
            (f32::INFINITY, false, false),
            (f32::NEG_INFINITY, false, false),
            (f32::NAN, false, false),
        ] {
            assert_eq!(require_positive(value, "a").is_ok(), positive, "{value}");
            assert_eq!(require_not_negative(value, "a").is_ok(), not_negative, "{value}");
        }
    }

    #[test]
    fn a_refusal_names_the_setting_and_what_is_expected() {
        let refused = require(false, "window", "at least 2 samples").unwrap_err();
        assert_eq!(refused.to_string(), "window: expected at least 2 samples");
    }
}
