//! Contact detection: thresholds of force with hysteresis.

use crate::error::{ConfigError, require, require_not_negative};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Thresholds of force with hysteresis.
///
/// A threshold of zero would mark most of free space as contact, because sensors are noisy: contact begins with a
/// force above `on_force` at a penetration of at least zero, and ends after `off_samples` samples in a row that are
/// below `off_force` or outside the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ContactDetectorConfig {
    /// Force that begins a contact, about 2.5 standard deviations of the sensor's noise or more [N or N m].
    pub on_force: f32,
    /// Force below which a sample counts as away, at most `on_force` [N or N m].
    pub off_force: f32,
    /// Samples away in a row that end a contact, at least 1.
    pub off_samples: u16,
}

/// Whether there is contact, and for how many samples in a row the thresholds say otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactDetectorState {
    closed: bool,
    away: u16,
}

impl ContactDetectorState {
    /// There is contact.
    #[inline(always)]
    pub(crate) fn is_closed(&self) -> bool {
        self.closed
    }

    /// A sample of a contact that goes on: none in a row says otherwise.
    #[inline(always)]
    pub(crate) fn stay(&mut self) {
        self.away = 0;
    }
}

impl ContactDetectorConfig {
    /// For the paper's bench: 0.2 N on, 0.05 N off for 5 samples.
    pub const BENCH: Self = Self { on_force: 0.2, off_force: 0.05, off_samples: 5 };

    pub(crate) fn check(self) -> Result<(), ConfigError> {
        require_not_negative(self.off_force, "contact_detector.off_force")?;
        require(
            self.on_force.is_finite() && self.on_force >= self.off_force,
            "contact_detector.on_force",
            "a finite force, at least contact_detector.off_force",
        )?;
        require(self.off_samples > 0, "contact_detector.off_samples", "at least 1")
    }

    /// Takes the penetration and force of one sample, in the unit of the thresholds; whether the tool is in contact.
    pub fn update(self, state: &mut ContactDetectorState, penetration: f32, force: f32) -> bool {
        if state.closed {
            let away = force < self.off_force || penetration < 0.0;
            state.away = if away { state.away.saturating_add(1) } else { 0 };
            state.closed = state.away < self.off_samples;
        } else if force > self.on_force && penetration >= 0.0 {
            *state = ContactDetectorState { closed: true, away: 0 };
        }
        state.closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_neither_begins_nor_ends_a_contact() {
        let (detector, mut state) = (ContactDetectorConfig::BENCH, ContactDetectorState::default());
        assert!(!detector.update(&mut state, 0.01, 0.2), "on is above the threshold, not at it");
        assert!(!detector.update(&mut state, -0.001, 5.0), "a push outside the surface is not contact");
        assert!(detector.update(&mut state, 0.0, 0.21));
        for _ in 0..4 {
            assert!(detector.update(&mut state, 0.001, 0.0), "four samples away are a flicker");
        }
        assert!(detector.update(&mut state, 0.001, 0.06), "and one above the lower threshold forgives them");
        let left: usize = (0..5).map(|_| usize::from(!detector.update(&mut state, -0.001, 1.0))).sum();
        assert_eq!(left, 1, "the fifth sample outside the surface ends it");
    }

    #[test]
    fn a_contact_ends_below_its_lower_threshold_and_not_at_it() {
        let detector = ContactDetectorConfig { on_force: 1.0, off_force: 0.5, off_samples: 1 };
        for (penetration, force, stays) in [(0.0, 0.5, true), (0.0, 0.49, false), (-1e-6, 0.5, false)] {
            let mut state = ContactDetectorState { closed: true, away: 0 };
            assert_eq!(detector.update(&mut state, penetration, force), stays, "{penetration} {force}");
        }
    }

    #[test]
    fn thresholds_are_checked_at_their_limits() {
        for (on_force, off_force, off_samples, accepted) in [
            (0.5, 0.5, 1, true),
            (0.4, 0.5, 1, false),
            (f32::INFINITY, 0.5, 1, false),
            (0.5, -0.1, 1, false),
            (0.5, 0.5, 0, false),
        ] {
            let checked = ContactDetectorConfig { on_force, off_force, off_samples }.check();
            assert_eq!(checked.is_ok(), accepted, "{on_force} {off_force} {off_samples}");
        }
    }
}
