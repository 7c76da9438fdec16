//! How far a threshold could be moved without any decision of this process falling otherwise.
//!
//! A diagnosis is a program that is run once: as long as every comparison with a threshold comes out as it did, each later step is the
//! same, and so is the answer, to the byte. What a comparison is made with says at which factor it would come out otherwise. So most
//! variations of a threshold need not be run: their answer is known.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

use serde::{Deserialize, Serialize};

/// The factors, below and above one, between which nothing changes: both excluded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ThresholdMargin {
    /// The greatest factor below one that would change a comparison; 0 where none would, 1 where the number is reckoned with.
    pub below: f64,
    /// The smallest above one; `None` where none would.
    pub above: Option<f64>,
}

impl ThresholdMargin {
    /// Of a threshold that nothing was compared with.
    pub const UNUSED: Self = Self { below: 0.0, above: None };

    /// Whether the threshold times `factor` leaves every decision as it is.
    #[must_use]
    pub fn holds(&self, factor: f64) -> bool {
        self.below < factor && self.above.is_none_or(|above| factor < above)
    }

    /// What is left of it beside a comparison with `ratio` times the threshold.
    fn compared(self, ratio: f64) -> Self {
        let above = if ratio >= 1.0 && ratio.is_finite() {
            Some(self.above.map_or(ratio, |above| above.min(ratio)))
        } else {
            self.above
        };
        // What is no number or below zero compares alike with a threshold of any positive factor.
        let below = if ratio <= 1.0 { self.below.max(ratio) } else { self.below };
        Self { below, above }
    }
}

/// What was noted, by name of the threshold, where [`note_margins`] asked for it.
static NOTED: OnceLock<Mutex<BTreeMap<&'static str, ThresholdMargin>>> = OnceLock::new();

/// Notes margins from here on, for as long as this process runs.
pub fn note_margins() {
    NOTED.get_or_init(Mutex::default);
}

/// The margin of each threshold that was used since [`note_margins`].
#[must_use]
pub fn noted_margins() -> BTreeMap<&'static str, ThresholdMargin> {
    NOTED.get().map_or_else(BTreeMap::new, |noted| noted.lock().unwrap_or_else(PoisonError::into_inner).clone())
}

/// Notes that a number `ratio` times the nominal threshold was compared with it.
pub(crate) fn note_comparison(name: &'static str, ratio: f64) {
    note(name, |margin| margin.compared(ratio));
}

/// Notes that the threshold was reckoned with: what any factor changes is not known.
pub(crate) fn note_use(name: &'static str) {
    note(name, |margin| margin.compared(1.0));
}

fn note(name: &'static str, change: impl Fn(ThresholdMargin) -> ThresholdMargin) {
    if let Some(noted) = NOTED.get() {
        let mut noted = noted.lock().unwrap_or_else(PoisonError::into_inner);
        let margin = noted.entry(name).or_insert(ThresholdMargin::UNUSED);
        *margin = change(*margin);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_ends_where_the_nearest_comparison_on_either_side_would_come_out_otherwise() {
        let margin =
            [0.2, 0.6, 5.0, 1.4, -3.0, f64::NAN].into_iter().fold(ThresholdMargin::UNUSED, ThresholdMargin::compared);
        assert_eq!(margin, ThresholdMargin { below: 0.6, above: Some(1.4) });
        assert!(
            margin.holds(0.7) && margin.holds(1.3) && !margin.holds(0.6) && !margin.holds(0.5) && !margin.holds(1.4)
        );
        // Where the number is reckoned with or met exactly, no factor but one is known to change nothing.
        let used = margin.compared(1.0);
        assert!(!used.holds(1.001) && !used.holds(0.999));
        assert!(ThresholdMargin::UNUSED.holds(1e-9) && ThresholdMargin::UNUSED.holds(1e9));
    }
}
