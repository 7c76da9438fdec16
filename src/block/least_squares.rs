//! Block least squares (BLS) over a sliding window.

use core::marker::PhantomData;

use crate::block::config::BlockConfig;
use crate::block::exact_sums::ExactSums;
use crate::block::law::{BlockLaw, BlockState, Criterion, CriterionStep, WindowView};
use crate::block::second_order::Moments;
use crate::block::window_sums::WindowSums;
use crate::contact::Observation;
use crate::error::ConfigError;
use crate::window::Recent;

/// `theta = (sum phi phi')^-1 sum phi F` over the window (eq. 5-6), by the closed 2x2 inverse.
///
/// The sums are taken about an earlier estimate and solved for its correction, which is the same solution with less
/// rounding. Where penetration and rate are in line, or the tool holds still, K alone is solved for and B is held.
///
/// An update costs the same at any window.
pub type BlockLeastSquares = BlockLaw<LeastSquares<ExactSums>>;

/// `sum (F - phi' theta)^2`, solved outright.
#[derive(Debug, Clone, Copy)]
pub struct LeastSquares<M>(PhantomData<M>);

impl<M: WindowSums> BlockLaw<LeastSquares<M>> {
    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: BlockConfig) -> Result<Self, ConfigError> {
        Ok(Self { config: config.check()?, criterion: LeastSquares(PhantomData) })
    }
}

impl<M: WindowSums> Criterion for LeastSquares<M> {
    type WindowSums = M;

    fn advance(&self, view: &WindowView<'_, M>) -> CriterionStep {
        let (sums, solution) = (view.local.moments.second(), &view.solution);
        CriterionStep {
            to: view.least_squares(),
            noise_variance: solution.residual_variance(sums, view.samples),
            flags: solution.flags,
        }
    }

    #[inline(always)]
    fn update_estimate(&self, config: &BlockConfig, state: &mut BlockState<M>, recent: &Recent<'_>) {
        if !state.memory.push_usual(config, recent, &state.estimate) {
            self.update_unusual(config, state, recent.runs());
        } else if let Some(solution) = state.memory.least_squares() {
            state.estimate = solution;
        } else {
            self.advance_by_moments(config, state);
        }
    }
}

impl<M: WindowSums> LeastSquares<M> {
    /// [`Criterion::update_estimate`] where the window, the sums or the sample are out of the ordinary.
    #[cold]
    #[inline(never)]
    fn update_unusual(
        &self,
        config: &BlockConfig,
        state: &mut BlockState<M>,
        (older, newer): (&[Observation], &[Observation]),
    ) {
        let recent = &Recent::of_runs(older, newer);
        state.memory.push_unusual(config, (older, newer), state.estimate);
        if let Some(solution) = state.memory.least_squares() {
            state.estimate = solution;
        } else if recent.len() >= usize::from(config.minimum_fill) {
            state.estimate = self.advance_estimate(config, &state.memory, recent, state.estimate);
        }
    }

    /// By the sums in internal units: where the window is young, with a prior, and where B is held.
    #[cold]
    #[inline(never)]
    fn advance_by_moments(&self, config: &BlockConfig, state: &mut BlockState<M>) {
        let (mut local, samples) = state.memory.usual_moments();
        if samples >= config.minimum_fill {
            let solution = local.solution(f32::from(samples), config, state.estimate);
            let to = local.centre.moved(1.0, solution.correction);
            state.estimate = if to.is_finite() { to } else { state.estimate };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::update_law::UpdateLaw;
    use crate::window::Window;

    /// Follows `rows` by both ways of updating, in windows that are followed to the bit; how many of the estimates told B.
    fn told(config: BlockConfig, count: u16, row: impl Fn(u16) -> Observation) -> usize {
        let law = BlockLeastSquares::new(config).expect("sound settings");
        let mut ring = Window::<64>::new();
        let [mut whole, mut alone] = [law.initial_state(); 2];
        let tells = |k| {
            ring.push(row(k));
            let flags = law.update(&mut whole, ring.recent()).flags;
            law.update_estimate(&mut alone, ring.recent());
            assert_eq!(alone, whole, "window {}, update {k}", config.window);
            flags.is_empty()
        };
        (0..count).map(tells).filter(|&told| told).count()
    }

    /// A rate of one size and either sign beside a penetration that the signs do not follow.
    fn rows(rate: f32) -> impl Fn(u16) -> Observation {
        move |k| {
            let rate = if k % 3 == 0 { rate } else { -rate };
            let penetration = 0.01 + 1e-4 * f32::from(k * 37 % 64);
            Observation { penetration, rate, force: 300.0 * penetration + 5.0 * rate + 0.01 * f32::from(k * 29 % 16) }
        }
    }

    #[test]
    fn the_estimate_alone_is_that_of_the_whole_update_to_the_bit() {
        for window in [10, 16, 17, 40, 64] {
            for prior in [None, Some(crate::Prior::default())] {
                let config = BlockConfig { minimum_fill: 5, prior, ..BlockConfig::of(window) };
                assert_eq!(told(config, 400, rows(0.2)), 396, "window {window}");
                assert_eq!(told(config, 400, |k| rows(0.2 / f32::from(1 + k / 50))(k)), 396, "window {window}");
            }
        }
    }

    /// The sum of squares is compared with as many squares of the floor as the window has samples, at every length.
    #[test]
    fn a_rate_below_the_floor_holds_b_while_the_window_fills_and_when_it_is_full() {
        for window in [10, 16, 40, 64] {
            let config = BlockConfig { minimum_fill: 5, rate_floor: 0.2, ..BlockConfig::of(window) };
            assert_eq!(told(config, 200, rows(0.1995)), 0, "window {window}");
            assert_eq!(told(config, 200, rows(0.2005)), 196, "window {window}");
        }
    }
}
