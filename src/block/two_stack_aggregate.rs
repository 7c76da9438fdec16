//! The sums of a sliding window at constant cost, without subtraction.
//!
//! A sum from which samples are subtracted keeps their rounding error. Here samples are only added, and a sum is discarded as a whole: the
//! two-stack queue (Tangwongsan, Hirzel, Schneider, Low-Latency Sliding-Window Aggregation in Worst-Case Constant Time,
//! 2017), with samples taken in chunks so that it needs neither memory nor time in proportion to the window. From the oldest sample on the window is
//!
//! - what is left of the oldest chunk: one of its own suffix sums (`entries`), and less than a group of single samples;
//! - the whole chunks after it (`middle`), from suffix sums over chunks (`chunks`) and what was completed since (`after`);
//! - the newest chunk so far (`front`).
//!
//! While one chunk is drained, the entries of the next are summed backwards from the ring, two samples at every other update,
//! each into the place of an entry that is no longer needed. When the last chunk of the stack is being drained, the chunks
//! that are complete become the next stack: they are turned into suffix sums in place, some at every other update. They are
//! then seen about the latest estimate, too.

use crate::block::config::BlockConfig;
use crate::block::second_order::Moments;
use crate::block::window_sums::{CentredMoments, WindowSums};
use crate::contact::{Impedance, Observation};
use crate::window::Recent;

/// Entries of a chunk, at most.
const MAX_ENTRIES: u32 = 10;

/// Chunks in a window, at most.
const MAX_CHUNKS: u32 = 16;

/// Window below which all samples are summed at every update, which costs less there.
const MIN_WINDOW: u32 = 16;

/// Division of a window into chunks and groups; all zero for a short window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Division {
    window: u32,
    /// Samples between two entries, even.
    group: u32,
    /// Groups of a chunk.
    groups: u32,
    /// Samples of a chunk.
    chunk: u32,
}

impl Division {
    /// The smallest chunks that are no more in number than a chunk has samples, nor than there is room for.
    fn of(window: u16) -> Self {
        let window = u32::from(window);
        let room = |chunk: u32| chunk * chunk.min(MAX_CHUNKS) >= window;
        let (group, groups) = match (2..=MAX_ENTRIES).find(|groups| room(2 * groups)) {
            _ if window < MIN_WINDOW => (0, 0),
            Some(groups) => (2, groups),
            None => (2 * window.div_ceil(2 * MAX_ENTRIES * MAX_CHUNKS), MAX_ENTRIES),
        };
        Self { window, group, groups, chunk: group * groups }
    }
}

/// The sums `M` of a window, updated sample by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TwoStackAggregate<M> {
    division: Division,
    /// Samples in the window.
    fill: u32,
    /// What `middle`, `front` and the entries in use are summed about.
    centre: Impedance,
    /// What the stack is being turned to, and the entries of the next chunk are summed about.
    next_centre: Impedance,
    front: M,
    middle: M,
    after: M,
    /// The next chunk from its end on, as far as it has been summed.
    suffix: M,
    entries: [M; MAX_ENTRIES as usize],
    /// A ring, the next chunk to be drained at `head`.
    chunks: [M; MAX_CHUNKS as usize],
    /// Samples in `front`.
    newest: u32,
    /// Samples of the oldest chunk that have left.
    drained: u32,
    /// The entry in use, and how many samples come before it.
    entry: u32,
    single: u32,
    head: u32,
    /// Chunks of the stack that are not drained yet, those complete since, and those turned so far where it is being turned.
    stacked: u32,
    complete: u32,
    turned: u32,
    turning: bool,
    /// The entries in use lie in reverse.
    reversed: bool,
}

fn slot(index: u32) -> usize {
    (index % MAX_CHUNKS) as usize
}

impl<M: Moments> TwoStackAggregate<M> {
    /// A window of `division` in which nothing but emptiness has passed for so long that `coming` samples later it is as full
    /// of it as it can be.
    fn begin(&mut self, division: Division, centre: Impedance, coming: u32) {
        let chunk = division.chunk;
        let before = division.window - coming;
        let stacked = before.div_ceil(chunk) - 1;
        let drained = (stacked + 1) * chunk - before;
        (self.division, self.centre, self.next_centre) = (division, centre, centre);
        (self.stacked, self.drained) = (stacked, drained);
        self.entry = drained.div_ceil(division.group);
        self.single = self.entry * division.group - drained;
    }

    /// A window that was not followed sample by sample: all of it, about `centre`.
    #[cold]
    #[inline(never)]
    fn rebuild(&mut self, config: &BlockConfig, recent: Recent<'_>, centre: Impedance) {
        if self.fill > 0 {
            *self = Self::default();
        }
        let division = Division::of(config.window);
        let count = recent.len() as u32;
        if division.group == 0 {
            (self.division, self.fill) = (division, count);
            return;
        }
        // While the next chunk is empty, too, there is nothing to be summed ahead.
        let simple = count.min(division.window - 2 * division.chunk);
        self.begin(division, centre, simple);
        let mut seen = 0;
        recent.for_each(|o| {
            seen += 1;
            if seen > simple {
                self.prepare(recent, (count - seen) as usize);
                self.take(o);
                self.drain(centre);
            } else {
                self.take(o);
            }
        });
        self.fill = count;
    }

    /// Puts the newest sample in.
    #[inline(always)]
    fn take(&mut self, o: &Observation) {
        // At the update after the one that filled it, which has a chunk to begin where the window is a multiple of the chunk.
        if self.newest == self.division.chunk {
            self.complete();
        }
        self.front = self.front.with(&M::of(o, o.residual(self.centre)));
        self.newest += 1;
    }

    /// The newest chunk is complete.
    fn complete(&mut self) {
        let mut kept = self.front;
        self.middle = self.middle.with(&kept);
        if self.turning {
            kept = kept.shifted(self.turn());
        }
        self.after = self.after.with(&kept);
        if let Some(chunk) = self.chunks.get_mut(slot(self.head + self.stacked + self.complete)) {
            *chunk = kept;
        }
        self.complete += 1;
        self.front = M::default();
        self.newest = 0;
    }

    /// From the centre in use to the next.
    fn turn(&self) -> Impedance {
        self.next_centre.moved(-1.0, self.centre)
    }

    /// The oldest sample leaves.
    #[inline(always)]
    fn drain(&mut self, estimate: Impedance) {
        self.drained += 1;
        if self.single > 0 {
            self.single -= 1;
        } else {
            self.entry += 1;
            self.single = self.division.group - 1;
        }
        if self.drained == self.division.chunk {
            self.next_chunk(estimate);
        }
    }

    /// The oldest chunk has left, and the next is in use.
    fn next_chunk(&mut self, estimate: Impedance) {
        (self.drained, self.entry, self.single) = (0, 0, 0);
        self.reversed = !self.reversed;
        if self.turning {
            self.front = self.front.shifted(self.turn());
            self.centre = self.next_centre;
            self.turning = false;
        }
        self.head = (self.head + 1) % MAX_CHUNKS;
        self.stacked -= 1;
        if self.stacked > 0 {
            if let Some(stack) = self.chunks.get(slot(self.head)) {
                self.middle = self.after.with(stack);
            }
            return;
        }
        self.middle = self.after;
        (self.stacked, self.complete) = (self.complete, 0);
        self.after = M::default();
        (self.turning, self.turned, self.next_centre) = (true, 0, estimate);
    }

    /// What will be needed once the next chunk is drained, a little at every update; the newest sample that the queue has not
    /// taken yet is `later` samples before the newest of `recent`.
    #[inline(always)]
    fn prepare(&mut self, recent: Recent<'_>, later: usize) {
        if self.drained % 2 == 1 {
            self.sum_backwards(recent, later);
        } else if self.turning {
            self.turn_chunk();
            // The first time a chunk may have been completed as well. There are fewer than a chunk has samples.
            if self.drained > 0 {
                self.turn_chunk();
            }
        }
    }

    /// Two more samples of the next chunk.
    fn sum_backwards(&mut self, recent: Recent<'_>, later: usize) {
        let mut suffix = if self.drained == 1 { M::default() } else { self.suffix };
        let ahead = self.division.window - 2 * (self.division.chunk - self.drained);
        for o in recent.pair_before_newest(ahead as usize + later) {
            suffix = suffix.with(&M::of(&o, o.residual(self.next_centre)));
        }
        self.suffix = suffix;
        if self.single == 1 {
            let place = if self.reversed { self.division.groups - self.entry } else { self.entry - 1 };
            if let Some(entry) = self.entries.get_mut(place as usize) {
                *entry = suffix;
            }
        }
    }

    /// One more chunk of the stack becomes the sum of all from there on.
    fn turn_chunk(&mut self) {
        if self.turned == self.stacked {
            return;
        }
        let at = self.head + self.stacked - 1 - self.turned;
        let beyond = self.chunks.get(slot(at + 1)).copied().unwrap_or_default();
        let turn = self.turn();
        if let Some(chunk) = self.chunks.get_mut(slot(at)) {
            *chunk = chunk.shifted(turn);
            if self.turned > 0 {
                *chunk = chunk.with(&beyond);
            }
        }
        self.turned += 1;
    }

    /// The entry in use; `None` beyond the last.
    #[inline(always)]
    fn entry(&self) -> Option<&M> {
        if self.entry >= self.division.groups {
            return None;
        }
        let place = if self.reversed { self.division.groups - 1 - self.entry } else { self.entry };
        self.entries.get(place as usize)
    }
}

impl<M: Moments> WindowSums for TwoStackAggregate<M> {
    type CentredMoments = M;

    #[inline(always)]
    fn push(&mut self, config: &BlockConfig, recent: Recent<'_>, estimate: Impedance) {
        let expected = if self.fill < self.division.window { self.fill + 1 } else { self.fill };
        if self.fill == 0 || recent.len() != expected as usize {
            self.rebuild(config, recent, estimate);
            return;
        }
        self.fill = expected;
        if self.division.group > 0 {
            self.prepare(recent, 0);
            self.take(&recent.newest().unwrap_or_default());
            self.drain(estimate);
        }
    }

    #[inline(always)]
    fn centred_moments(&self, recent: Recent<'_>, estimate: Impedance) -> CentredMoments<M> {
        if self.division.group == 0 {
            let mut sums = M::default();
            recent.for_each(|o| sums = sums.with(&M::of(o, o.residual(estimate))));
            return CentredMoments { centre: estimate, moments: sums };
        }
        let mut sums = self.front.with(&self.middle);
        if let Some(entry) = self.entry() {
            sums = sums.with(entry);
        }
        // Those of them that are not from before the window began to fill.
        for index in 0..(self.single + self.fill).saturating_sub(self.division.window) {
            let o = recent.after_oldest(index as usize).unwrap_or_default();
            sums = sums.with(&M::of(&o, o.residual(self.centre)));
        }
        CentredMoments { centre: self.centre, moments: sums }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::second_order::SecondOrderSums;
    use crate::window::Window;

    /// Small whole numbers, whose sums are exact in whatever order.
    fn whole(k: u16) -> Observation {
        let digit = |base: u16| f32::from(k % base) - f32::from(base / 2);
        Observation { penetration: digit(7), rate: digit(11), force: digit(13) }
    }

    /// The queue against the window summed anew at each of `count` updates, the first of them on `known` samples.
    fn follows(window: u16, known: u16, count: u16) {
        const RING: usize = 2100;
        let config = BlockConfig { window, minimum_fill: 2, ..BlockConfig::default() };
        let (mut ring, mut queue) = (Window::<RING>::new(), TwoStackAggregate::<SecondOrderSums>::default());
        for k in 0..known + count {
            ring.push(whole(k));
            if k < known {
                continue;
            }
            let recent = ring.recent().last(window.into());
            // Whole numbers as well, so that every change of the centre is exact.
            let estimate = Impedance { stiffness: f32::from(k % 3), damping: f32::from(k % 2) };
            queue.push(&config, recent, estimate);
            let CentredMoments { centre, moments } = queue.centred_moments(recent, estimate);
            assert_eq!(moments, SecondOrderSums::over(recent, centre), "window {window}, {known} known, update {k}");
        }
    }

    #[test]
    fn it_holds_the_window_at_every_length_and_from_any_start() {
        for window in (2..=130).chain([144, 196, 256, 257, 288, 289, 300, 319, 320, 321, 640, 641, 1999, 2048]) {
            follows(window, 0, 5 * window);
        }
        for known in [1, 19, 40, 259, 260, 261, 280, 299, 300, 400] {
            follows(300, known, 1000);
        }
        for known in 1..=32 {
            follows(16, known, 90);
        }
    }

    #[test]
    fn every_window_is_divided_into_what_there_is_room_for() {
        for window in MIN_WINDOW as u16..=u16::MAX {
            let Division { group, groups, .. } = Division::of(window);
            let chunk = group * groups;
            assert!(group >= 2 && group.is_multiple_of(2) && (2..=MAX_ENTRIES).contains(&groups), "{window}");
            let chunks = u32::from(window).div_ceil(chunk);
            assert!(chunks <= MAX_CHUNKS && chunks <= chunk && 2 * chunk < u32::from(window), "{window}");
        }
    }

    #[test]
    fn a_window_that_was_not_followed_is_summed_anew() {
        let config = BlockConfig { window: 40, minimum_fill: 2, ..BlockConfig::default() };
        let mut ring = Window::<64>::new();
        for k in 0..64 {
            ring.push(whole(k));
        }
        let estimate = Impedance { stiffness: 1.0, damping: 2.0 };
        for followed in [40, 20, 3] {
            for length in [1, 2, 17, 25, 40] {
                if length == (followed + 1).min(40) {
                    continue;
                }
                let mut queue = TwoStackAggregate::<SecondOrderSums>::default();
                queue.push(&config, ring.recent().last(followed), Impedance::ZERO);
                let recent = ring.recent().last(length);
                queue.push(&config, recent, estimate);
                let CentredMoments { centre, moments } = queue.centred_moments(recent, estimate);
                assert_eq!(moments, SecondOrderSums::over(recent, centre), "{length} samples after {followed}");
            }
        }
    }
}
