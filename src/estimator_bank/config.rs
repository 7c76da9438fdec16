//! The settings of all estimators side by side.

use crate::block::BlockConfig;
use crate::estimator_bank::method::Method;
use crate::estimator_bank::methods::Methods;
use crate::recursive::{EwrlsConfig, GradientConfig, ResetRlsConfig, SprlsConfig};
use crate::stream::StreamConfig;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Longest window of an [`EstimatorBank`](crate::EstimatorBank), samples: 24 kB of the 128 kB of an STM32F405.
pub const BANK_WINDOW: usize = 2048;

/// Settings of an [`EstimatorBank`](crate::EstimatorBank).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct EstimatorBankConfig {
    /// What all share.
    pub stream: StreamConfig,
    /// Which of them run.
    pub methods: Methods,
    /// Of `rls`.
    pub rls: EwrlsConfig,
    /// Of `ewrls`.
    pub ewrls: EwrlsConfig,
    /// Of `sprls`.
    pub sprls: SprlsConfig,
    /// Of `reset_rls`.
    pub reset_rls: ResetRlsConfig,
    /// Of `gradient`.
    pub gradient: GradientConfig,
    /// Of all block methods; the window, also the longest of `adaptive_bls`, is at most [`BANK_WINDOW`]. `cusum_rls` and
    /// `directional_rls` run with their defaults.
    pub block: BlockConfig,
}

impl EstimatorBankConfig {
    /// Every method at its own defaults behind `stream`.
    #[must_use]
    pub fn all_methods(stream: StreamConfig) -> Self {
        Self {
            stream,
            methods: Method::ALL.into_iter().fold(Methods::default(), Methods::with),
            rls: EwrlsConfig::rls(),
            ewrls: EwrlsConfig::default(),
            sprls: SprlsConfig::default(),
            reset_rls: ResetRlsConfig::default(),
            gradient: GradientConfig::default(),
            block: BlockConfig::default(),
        }
    }
}
