//! Block least squares over a window that is shortened where the material has changed.

use crate::block::config::BlockConfig;
use crate::block::exact_sums::ExactSums;
use crate::block::law::BlockState;
use crate::block::least_squares::BlockLeastSquares;
use crate::change_detector::{ChangeConfig, ChangeState};
use crate::error::{ConfigError, require};
use crate::prior::Prior;
use crate::quality::Flags;
use crate::quality::Step;
use crate::update_law::UpdateLaw;
use crate::window::Recent;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of [`AdaptiveWindow`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct AdaptiveWindowConfig {
    /// Of the block law; its window is the longest.
    pub block: BlockConfig,
    /// Samples that the window is cut to at a change, at least 2 and at most `block.window`.
    pub shortest: u16,
    /// When to cut it.
    pub change: ChangeConfig,
}

impl Default for AdaptiveWindowConfig {
    /// 300 samples, cut to 20; the default prior in the place of a minimum fill.
    fn default() -> Self {
        Self::of(300)
    }
}

impl AdaptiveWindowConfig {
    /// At most `window` samples, cut to 20 (or all, where there are fewer).
    pub fn of(window: u16) -> Self {
        let block = BlockConfig { minimum_fill: 2, prior: Some(Prior::default()), ..BlockConfig::of(window) };
        Self { block, shortest: window.min(20), change: ChangeConfig::default() }
    }
}

/// [`BlockLeastSquares`] whose window is cut to its newest samples at a change, and grows again from there.
///
/// An update costs what one of [`BlockLeastSquares`] costs, but at a change, where the short window is summed anew.
#[derive(Debug, Clone, Copy)]
pub struct AdaptiveWindow {
    law: BlockLeastSquares,
    shortest: u16,
    change: ChangeConfig,
}

/// State of [`AdaptiveWindow`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AdaptiveWindowState {
    /// Of the block law.
    pub block: BlockState<ExactSums>,
    change: ChangeState,
    length: u16,
}

impl AdaptiveWindow {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: AdaptiveWindowConfig) -> Result<Self, ConfigError> {
        let law = BlockLeastSquares::new(config.block)?;
        let fits = (2..=config.block.window).contains(&config.shortest);
        require(fits, "shortest", "at least 2 samples and at most the window")?;
        Ok(Self { law, shortest: config.shortest, change: config.change.check()? })
    }
}

impl UpdateLaw for AdaptiveWindow {
    type State = AdaptiveWindowState;

    fn initial_state(&self) -> AdaptiveWindowState {
        AdaptiveWindowState::default()
    }

    fn reset_memory(&self, state: &mut AdaptiveWindowState) {
        self.law.reset_memory(&mut state.block);
        (state.change, state.length) = (ChangeState::default(), 0);
    }

    fn window(&self) -> usize {
        self.law.window()
    }

    fn update(&self, state: &mut AdaptiveWindowState, recent: Recent<'_>) -> Step {
        let innovation = recent.newest().unwrap_or_default().residual(state.block.estimate);
        let changed = self.change.update(&mut state.change, innovation);
        state.length = if changed { self.shortest } else { state.length.saturating_add(1) };
        let mut step = self.law.update(&mut state.block, recent.last(usize::from(state.length)));
        step.flags.set(Flags::CHANGED, changed);
        step
    }
}
