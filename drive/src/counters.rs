//! Event counters: written by the interrupt alone, readable anywhere.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::faults::Faults;

/// Counters. The interrupt is their only writer, so a load and a store replace a read-modify-write.
#[derive(Debug, Default)]
pub struct Counters {
    faults: [AtomicU32; Faults::COUNT],
    ticks: AtomicU32,
    used: AtomicU32,
    restarts: AtomicU32,
    refused_tares: AtomicU32,
}

fn count(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

impl Counters {
    /// All zero.
    pub const fn new() -> Self {
        Self {
            faults: [const { AtomicU32::new(0) }; Faults::COUNT],
            ticks: AtomicU32::new(0),
            used: AtomicU32::new(0),
            restarts: AtomicU32::new(0),
            refused_tares: AtomicU32::new(0),
        }
    }

    pub(super) fn tick(&self, faults: Faults, used: bool) {
        count(&self.ticks);
        if used {
            count(&self.used);
        }
        if faults.is_empty() {
            return;
        }
        for (bit, counter) in self.faults.iter().enumerate() {
            if faults.bits() >> bit & 1 != 0 {
                count(counter);
            }
        }
    }

    pub(super) fn restart(&self) {
        count(&self.restarts);
    }

    pub(super) fn refused_tare(&self) {
        count(&self.refused_tares);
    }

    /// Ticks at which each fault occurred, in the order of their bits.
    pub fn faults(&self) -> [u32; Faults::COUNT] {
        core::array::from_fn(|bit| self.faults.get(bit).map_or(0, |counter| counter.load(Ordering::Relaxed)))
    }

    /// Ticks, samples used, resets of the estimator, refused tares.
    pub fn others(&self) -> [u32; 4] {
        [&self.ticks, &self.used, &self.restarts, &self.refused_tares].map(|counter| counter.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_counts_its_own_faults_and_no_other() {
        let counters = Counters::new();
        assert_eq!(counters.faults(), [0; Faults::COUNT]);
        counters.tick(Faults::FORCE_RANGE | Faults::CLOCK, false);
        counters.tick(Faults::FORCE_RANGE, true);
        counters.tick(Faults::empty(), true);
        let expected = core::array::from_fn(|bit| match Faults::from_bits_retain(1 << bit) {
            Faults::FORCE_RANGE => 2,
            Faults::CLOCK => 1,
            _ => 0,
        });
        assert_eq!(counters.faults(), expected);
        assert_eq!(counters.others(), [3, 2, 0, 0]);
    }
}
