//! Change detection: a cumulative sum (CUSUM) of the squared innovation.

use crate::error::{ConfigError, require, require_positive};
use crate::math::{larger, smaller};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Settings of the detector (E. S. Page, Biometrika 41 (1954) 100):
///
/// ```text
/// g = max(0, g + min(e^2 / s^2, clip) - allowance),   changed where g > threshold
/// ```
/// where e is the innovation and s its usual size: the root of its running mean square over `memory` samples, of which no
/// sample counts for more than `clip` of them, and never less than `noise`. So a contact that the model fits badly raises its
/// own bar, and one spike adds 22 of the 120 that it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ChangeConfig {
    /// Least usual size of an innovation, internal units of force (N on the bench).
    pub noise: f32,
    /// Squared multiple of the usual size below which the sum falls.
    pub allowance: f32,
    /// The most that one sample counts for.
    pub clip: f32,
    /// The sum above which a change is reported.
    pub threshold: f32,
    /// Samples after a start or a change that are ignored while the estimate converges.
    pub settling: u16,
    /// Samples over which the usual size is averaged.
    pub memory: u16,
}

impl Default for ChangeConfig {
    /// 0.05 N, 3, 25, 120; 20 samples of rest, a memory of 300.
    fn default() -> Self {
        Self { noise: 0.05, allowance: 3.0, clip: 25.0, threshold: 120.0, settling: 20, memory: 300 }
    }
}

/// State of the detector.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChangeState {
    sum: f32,
    mean_square: f32,
    since: u16,
}

impl ChangeConfig {
    pub(crate) fn check(self) -> Result<Self, ConfigError> {
        require_positive(self.noise, "change.noise")?;
        require(
            self.allowance >= 1.0 && self.allowance < self.clip,
            "change.allowance",
            "at least 1 and below change.clip",
        )?;
        require(self.clip.is_finite(), "change.clip", "a finite number above change.allowance")?;
        require_positive(self.threshold, "change.threshold")?;
        require(self.memory >= 2, "change.memory", "at least 2 samples")?;
        Ok(self)
    }

    /// Takes the innovation of one sample, in internal units; whether the material has changed. NaN is ignored.
    pub fn update(&self, state: &mut ChangeState, innovation: f32) -> bool {
        if state.since < self.settling || innovation.is_nan() {
            state.since = state.since.saturating_add(1);
            return false;
        }
        let usual = larger(state.mean_square, self.noise * self.noise);
        let ratio = smaller(innovation * innovation / usual, self.clip);
        state.mean_square += (ratio * usual - state.mean_square) / f32::from(self.memory);
        state.sum = larger(state.sum + ratio - self.allowance, 0.0);
        let changed = state.sum > self.threshold;
        if changed {
            (state.sum, state.since) = (0.0, 0);
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alarms(innovation: impl Fn(u32) -> f32, samples: u32) -> u32 {
        let (change, mut state) = (ChangeConfig::default(), ChangeState::default());
        (0..samples).map(|k| u32::from(change.update(&mut state, innovation(k)))).sum()
    }

    #[test]
    fn a_change_is_seen_and_a_spike_and_a_bad_model_are_not() {
        assert_eq!(
            alarms(|k| if k < 500 { 0.04 } else { 1.0 }, 500 + 8),
            1,
            "22 a sample: in the sixth it is beyond 120"
        );
        assert_eq!(alarms(|k| if k == 500 { 9.0 } else { 0.04 }, 2000), 0, "one spike");
        assert_eq!(alarms(|k| 0.08 * if k % 2 == 0 { 1.0 } else { -1.0 }, 5000), 0, "a residual within the allowance");
        assert_eq!(alarms(|_| f32::NAN, 500), 0, "what is no number is no change");
    }

    /// The sum, the mean square and the alarm of the printed formula, in double precision.
    #[test]
    fn the_detector_is_its_formula() {
        let config = ChangeConfig { noise: 0.5, allowance: 2.0, clip: 8.0, threshold: 9.0, settling: 2, memory: 4 };
        let innovations = [9.0, 9.0, 0.25, 1.0, 2.0, 1.0, 0.0, 4.0, 4.0, 4.0, 9.0, 9.0, 1.0, 5.0, 1e3, 1e3, 1e3, 0.5];
        let (mut sum, mut mean_square, mut since, mut alarms) = (0.0_f64, 0.0_f64, 0, 0);
        let mut state = ChangeState::default();
        for (row, innovation) in innovations.into_iter().enumerate() {
            let changed = config.update(&mut state, innovation);
            let mut expected = false;
            if since < 2 {
                since += 1;
            } else {
                let usual = mean_square.max(0.25);
                let ratio = (f64::from(innovation).powi(2) / usual).min(8.0);
                mean_square += (ratio * usual - mean_square) / 4.0;
                sum = (sum + ratio - 2.0).max(0.0);
                expected = sum > 9.0;
                if expected {
                    (sum, since) = (0.0, 0);
                    alarms += 1;
                }
            }
            assert_eq!(changed, expected, "row {row}");
            let close = |found: f32, expected: f64| (f64::from(found) - expected).abs() <= 1e-5 * expected.abs();
            assert!(close(state.sum, sum) && close(state.mean_square, mean_square), "row {row}: {state:?}");
        }
        assert_eq!(alarms, 3);
    }

    #[test]
    fn a_sum_at_its_threshold_is_no_change_yet() {
        for (threshold, changed) in [(6.0, false), (5.5, true)] {
            let config = ChangeConfig { noise: 1.0, allowance: 2.0, clip: 8.0, threshold, settling: 0, memory: 4 };
            assert_eq!(config.update(&mut ChangeState::default(), 4.0), changed, "8 less 2 against {threshold}");
        }
    }

    #[test]
    fn settings_of_the_detector_are_checked_at_their_limits() {
        let d = ChangeConfig::default();
        for (config, accepted) in [
            (d, true),
            (ChangeConfig { noise: 0.0, ..d }, false),
            (ChangeConfig { allowance: 1.0, ..d }, true),
            (ChangeConfig { allowance: 0.99, ..d }, false),
            (ChangeConfig { allowance: 25.0, ..d }, false),
            (ChangeConfig { allowance: 24.9, ..d }, true),
            (ChangeConfig { clip: f32::INFINITY, ..d }, false),
            (ChangeConfig { threshold: 0.0, ..d }, false),
            (ChangeConfig { memory: 1, ..d }, false),
            (ChangeConfig { memory: 2, ..d }, true),
        ] {
            assert_eq!(config.check().ok(), accepted.then_some(config), "{config:?}");
        }
    }
}
