//! The settings of all estimators side by side, checked: what a drive takes over in its interrupt, where nothing may fail.

use crate::block::{AdaptiveWindow, AdaptiveWindowConfig};
use crate::block::{BlockLeastMeanFourth, Direction};
use crate::block::{BlockLeastMeanSquare, BlockLeastSquares};
use crate::error::{ConfigError, require};
use crate::estimator_bank::config::{BANK_WINDOW, EstimatorBankConfig};
use crate::estimator_bank::methods::Methods;
use crate::estimator_bank::validated_laws::ValidatedLaws;
use crate::recursive::{CusumRls, CusumRlsConfig};
use crate::recursive::{DirectionalRls, DirectionalRlsConfig};
use crate::recursive::{Ewrls, Gradient, ResetRls, Sprls};
use crate::stream::ValidatedStreamConfig;

/// Validated settings of an [`EstimatorBank`](crate::EstimatorBank), without any state.
#[derive(Debug, Clone, Copy)]
pub struct ValidatedBankConfig {
    pub(super) methods: Methods,
    pub(super) stream: ValidatedStreamConfig,
    pub(super) laws: ValidatedLaws,
}

impl ValidatedBankConfig {
    /// Checks all settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: &EstimatorBankConfig) -> Result<Self, ConfigError> {
        require(usize::from(config.block.window) <= BANK_WINDOW, "window", "at most 2048 samples")?;
        let fourth = |direction| BlockLeastMeanFourth::new(config.block, direction);
        let laws = ValidatedLaws {
            rls: Ewrls::new(config.rls)?,
            ewrls: Ewrls::new(config.ewrls)?,
            sprls: Sprls::new(config.sprls)?,
            reset_rls: ResetRls::new(config.reset_rls)?,
            gradient: Gradient::new(config.gradient)?,
            bls: BlockLeastSquares::new(config.block)?,
            blms: BlockLeastMeanSquare::new(config.block)?,
            blmf: fourth(Direction::SteepestDescent)?,
            newton_blmf: fourth(Direction::Newton)?,
            cusum_rls: CusumRls::new(CusumRlsConfig::default())?,
            adaptive_bls: AdaptiveWindow::new(AdaptiveWindowConfig::of(config.block.window))?,
            directional_rls: DirectionalRls::new(DirectionalRlsConfig::default())?,
        };
        Ok(Self { methods: config.methods, stream: ValidatedStreamConfig::new(config.stream)?, laws })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::BlockConfig;
    use crate::stream::StreamConfig;

    #[test]
    fn a_window_longer_than_the_ring_is_refused() {
        let validated = |window| {
            let stream = StreamConfig::BENCH;
            let block = BlockConfig::of(window);
            ValidatedBankConfig::new(&EstimatorBankConfig { block, ..EstimatorBankConfig::all_methods(stream) })
        };
        let longest = BANK_WINDOW as u16;
        assert!(validated(longest).is_ok());
        let refused = validated(longest + 1).expect_err("too long");
        assert_eq!(refused.parameter, "window");
    }
}
