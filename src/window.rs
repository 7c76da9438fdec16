//! A ring of the latest observations, and views of its newest part.
//!
//! `heapless::HistoryBuf` would hold the samples as well, but its `as_slices` indexes with a bounds check that can
//! panic, and nothing that the interrupt reaches may.

use crate::contact::Observation;

/// The latest `N` observations.
#[derive(Debug, Clone)]
pub struct Window<const N: usize> {
    samples: [Observation; N],
    next: usize,
    len: usize,
}

impl<const N: usize> Default for Window<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Window<N> {
    const EMPTY: Observation = Observation { penetration: 0.0, rate: 0.0, force: 0.0 };

    /// An empty ring.
    pub const fn new() -> Self {
        const { assert!(N > 0, "a window holds at least one sample") };
        Self { samples: [Self::EMPTY; N], next: 0, len: 0 }
    }

    /// Puts `sample` in, in place of the oldest where the ring is full.
    pub fn push(&mut self, sample: Observation) {
        // A ring of one, which a recursive law has, needs no place to be looked up.
        if N == 1 {
            (self.samples, self.len) = ([sample; N], 1);
            return;
        }
        if let Some(slot) = self.samples.get_mut(self.next) {
            *slot = sample;
        }
        self.next = if self.next + 1 < N { self.next + 1 } else { 0 };
        self.len = (self.len + 1).min(N);
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.len = 0;
        self.next = 0;
    }

    /// How many samples it holds.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// All samples that it holds.
    pub fn recent(&self) -> Recent<'_> {
        if N == 1 {
            return Recent { older: &[], newer: if self.len == 0 { &[] } else { &self.samples } };
        }
        let (older, newer) = if self.len <= self.next {
            (None, self.samples.get(self.next - self.len..self.next))
        } else if self.next == 0 {
            (None, self.samples.get(N - self.len..))
        } else {
            (self.samples.get(N - (self.len - self.next)..), self.samples.get(..self.next))
        };
        Recent { older: older.unwrap_or_default(), newer: newer.unwrap_or_default() }
    }
}

/// The newest samples of a ring, oldest first, in two runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recent<'a> {
    older: &'a [Observation],
    /// Empty only where it shows none, so that the newest is always found here.
    newer: &'a [Observation],
}

impl<'a> Recent<'a> {
    /// A view of plain samples, oldest first.
    pub const fn of(samples: &'a [Observation]) -> Self {
        Self { older: &[], newer: samples }
    }

    /// How many samples it shows.
    pub fn len(&self) -> usize {
        self.older.len() + self.newer.len()
    }

    /// Whether it shows none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The newest `count` of them, all where there are fewer.
    #[must_use]
    pub fn last(self, count: usize) -> Self {
        if self.len() <= count {
            return self;
        }
        let tail = |run: &'a [Observation], keep: usize| run.get(run.len().saturating_sub(keep)..).unwrap_or(run);
        Self { older: tail(self.older, count.saturating_sub(self.newer.len())), newer: tail(self.newer, count) }
    }

    /// The newest one.
    pub fn newest(&self) -> Option<Observation> {
        self.newer.last().copied()
    }

    /// The oldest one.
    pub fn oldest(&self) -> Option<Observation> {
        self.older.first().or(self.newer.first()).copied()
    }

    /// The older and the newer run of samples.
    #[inline(always)]
    pub(crate) fn runs(&self) -> (&'a [Observation], &'a [Observation]) {
        (self.older, self.newer)
    }

    /// A view of two runs of samples, of which the older is empty where the newer is.
    #[inline(always)]
    pub(crate) fn of_runs(older: &'a [Observation], newer: &'a [Observation]) -> Self {
        Self { older, newer }
    }

    /// The one `count` before the newest; the newest itself where that is zero.
    pub fn before_newest(&self, count: usize) -> Option<Observation> {
        let from_end = |run: &[Observation], count: usize| run.get(run.len().checked_sub(count + 1)?).copied();
        from_end(self.newer, count).or_else(|| from_end(self.older, count.checked_sub(self.newer.len())?))
    }

    /// Calls `visit` on each, oldest first.
    pub fn for_each(&self, mut visit: impl FnMut(&Observation)) {
        self.older.iter().for_each(&mut visit);
        self.newer.iter().for_each(&mut visit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use std::vec::Vec;

    fn forces(recent: Recent<'_>) -> Vec<f32> {
        let mut seen = Vec::new();
        recent.for_each(|o| seen.push(o.force));
        seen
    }

    #[test]
    fn a_ring_of_one_shows_the_latest_sample_alone() {
        let mut window = Window::<1>::new();
        assert!(window.is_empty() && window.recent().is_empty());
        for k in 0..3_u8 {
            window.push(Observation { force: f32::from(k), ..Observation::default() });
            assert_eq!((forces(window.recent()), window.len()), (Vec::from([f32::from(k)]), 1));
        }
        window.clear();
        assert!(window.is_empty() && window.recent().newest().is_none());
    }

    #[test]
    fn it_shows_the_latest_samples_in_order_however_often_it_went_round() {
        let mut window = Window::<5>::new();
        assert_eq!(window.recent().newest(), None);
        assert!(window.is_empty());
        for k in 0..23_u8 {
            window.push(Observation { force: f32::from(k), ..Observation::default() });
            for count in 0..7 {
                let shown = usize::from(k + 1).min(5).min(count);
                let expected: Vec<f32> = (usize::from(k) + 1 - shown..=usize::from(k)).map(|i| i as f32).collect();
                assert_eq!(forces(window.recent().last(count)), expected, "after {k}, last {count}");
            }
            assert_eq!(window.recent().newest().map(|o| o.force), Some(f32::from(k)));
            assert!(!window.is_empty() && !window.recent().is_empty());
            let oldest = k.saturating_sub(4);
            assert_eq!(window.recent().oldest().map(|o| o.force), Some(f32::from(oldest)));
            for back in 0..8 {
                let force = (back <= k - oldest).then(|| f32::from(k - back));
                assert_eq!(window.recent().before_newest(back.into()).map(|o| o.force), force, "{back} before {k}");
            }
        }
        window.clear();
        assert!(window.is_empty() && window.recent().is_empty());
    }
}
