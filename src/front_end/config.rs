//! The settings of the front end.

use crate::front_end::contact_detector::ContactDetectorConfig;
use crate::front_end::units::Units;
use crate::front_end::velocity::Velocity;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of the front end, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct FrontEndConfig {
    /// Nominal sample period, in seconds.
    pub period: f32,
    /// Position at which contact begins [m or rad].
    pub surface: f32,
    /// Cut-off of the low-pass, in Hz, at most 0.4 over `period`.
    pub cutoff: f32,
    /// How the rate is computed.
    pub velocity: Velocity,
    /// Glued or clamped: force both ways, always in contact, so contact is not detected.
    pub bilateral: bool,
    /// Contact thresholds.
    pub contact_detector: ContactDetectorConfig,
    /// Internal units.
    pub units: Units,
}

impl FrontEndConfig {
    /// The paper's bench at 1 kHz, with the matched filter: 20 Hz, SI inside.
    pub const BENCH: Self = Self {
        period: 1e-3,
        surface: 0.0,
        cutoff: 20.0,
        velocity: Velocity::Matched,
        bilateral: false,
        contact_detector: ContactDetectorConfig::BENCH,
        units: Units::SI,
    };
}
