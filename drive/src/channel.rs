//! Plausibility of sensor readings: stuck values and jumps.

/// Plausibility state of one sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlausibilityMonitor {
    last: Option<i32>,
    /// Ticks of unchanged readings.
    same: u16,
    /// Ticks since its last reading.
    silent: u16,
}

/// Result of the check of one reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plausibility {
    /// Unchanged for too long.
    pub stuck: bool,
    /// Further from the last one than the maximum speed allows.
    pub jumped: bool,
}

impl PlausibilityMonitor {
    /// No reading this time.
    pub fn miss(&mut self, elapsed: u8) {
        self.silent = self.silent.saturating_add(u16::from(elapsed));
    }

    /// A reading: stuck where it has been the same for `stuck_after` ticks (0: never), jumped where it moved by more than
    /// `step` counts a tick. The next reading is held against this one in any case, so a new position is accepted at its second reading.
    pub fn take(&mut self, reading: i32, elapsed: u8, stuck_after: u16, step: i32) -> Plausibility {
        let ticks = self.silent.saturating_add(u16::from(elapsed));
        self.silent = 0;
        let last = self.last.replace(reading);
        self.same = if last == Some(reading) { self.same.saturating_add(ticks) } else { 0 };
        let way = last.map_or(0, |last| reading.saturating_sub(last).saturating_abs());
        Plausibility {
            stuck: stuck_after > 0 && self.same >= stuck_after,
            jumped: way > step.saturating_mul(i32::from(ticks)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_is_stuck_from_its_limit_on_and_never_where_there_is_none() {
        let stuck = |stuck_after| {
            let mut monitor = PlausibilityMonitor::default();
            [(); 5].map(|()| monitor.take(7, 1, stuck_after, 0).stuck)
        };
        assert_eq!(stuck(0), [false; 5]);
        assert_eq!(stuck(1), [false, true, true, true, true]);
        assert_eq!(stuck(3), [false, false, false, true, true]);
    }

    #[test]
    fn a_reading_may_move_by_its_step_a_tick_and_no_further() {
        for (elapsed, way, jumped) in [(1, 10, false), (1, 11, true), (1, -11, true), (3, 30, false), (3, -31, true)] {
            let mut monitor = PlausibilityMonitor::default();
            monitor.take(100, 1, 0, 10);
            assert_eq!(monitor.take(100 + way, elapsed, 0, 10).jumped, jumped, "{way} in {elapsed}");
        }
    }
}
