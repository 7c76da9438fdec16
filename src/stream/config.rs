//! Settings of a stream, and the same validated.

use crate::error::ConfigError;
use crate::front_end::{FrontEnd, FrontEndConfig};
use crate::quality::{IntervalEstimator, SensorResolution};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What is discarded at a loss of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum ContactLoss {
    /// Estimate, covariance and window: each contact begins as the first did.
    #[default]
    Everything,
    /// Covariance and window; the next contact begins from the last estimate.
    Memory,
    /// Nothing: the next contact goes on where this one ended.
    Nothing,
}

/// Settings of a [`Stream`](crate::Stream).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct StreamConfig {
    /// Position, velocity, contact.
    pub front_end: FrontEndConfig,
    /// What the sensors resolve, for the intervals.
    pub sensors: SensorResolution,
    /// What is discarded at a loss of contact.
    pub contact_loss: ContactLoss,
    /// Samples after which a movement is half forgotten, for [`Flags::LITTLE_MOVEMENT`](crate::Flags::LITTLE_MOVEMENT); at least 1.
    pub movement_memory: u16,
}

impl StreamConfig {
    /// The paper's bench: matched filter, 0.1 mm a count, 0.09 N of noise, everything forgotten at a loss.
    pub const BENCH: Self = Self {
        front_end: FrontEndConfig::BENCH,
        sensors: SensorResolution { position_resolution: 1e-4, force_noise: 0.09 },
        contact_loss: ContactLoss::Everything,
        movement_memory: 300,
    };
}

/// Validated settings with the constants derived from them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ValidatedStreamConfig {
    pub(super) front_end: FrontEnd,
    pub(super) assessor: IntervalEstimator,
    pub(super) contact_loss: ContactLoss,
    pub(super) four_counts: f32,
    pub(super) half_movement_decay: f32,
}

impl ValidatedStreamConfig {
    pub(crate) fn new(config: StreamConfig) -> Result<Self, ConfigError> {
        let front_end = FrontEnd::new(config.front_end)?;
        config.sensors.check()?;
        crate::error::require(config.movement_memory > 0, "movement_memory", "at least 1 sample")?;
        Ok(Self {
            front_end,
            assessor: IntervalEstimator::new(&front_end, config.sensors),
            contact_loss: config.contact_loss,
            four_counts: 4.0 * config.sensors.position_resolution / config.front_end.units.penetration,
            half_movement_decay: 0.5 * core::f32::consts::LN_2 / f32::from(config.movement_memory),
        })
    }
}
