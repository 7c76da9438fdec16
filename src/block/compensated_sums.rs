//! The window's sums at a cost that does not depend on its length, without drift.
//!
//! The window is split into two runs of samples, each with sums about a nearby estimate: samples only leave the `older` run and
//! only enter the `newer` one. Once `older` is empty, `newer` equals the window; it becomes `older`, and a new run begins. No sum
//! is kept for longer than two windows, so rounding errors do not accumulate.
//!
//! Where the material changes, or at an outlier, large residuals must not be summed with small ones: when they are subtracted
//! again their rounding error stays, and powers of a residual about a distant estimate cancel. Therefore
//!
//! - an outlier ends the `newer` run, which is merged into `older`, and so does the first sample that is no outlier again;
//! - at intervals the centre of `newer` is checked. Where its least-squares solution explains most of the residual, its sums are
//!   rebuilt about that solution from the ring, one older sample at each update, and then replaced.

use crate::block::config::BlockConfig;
use crate::block::fourth_order::{FourthOrderSums, QuarticSums};
use crate::block::second_order::Moments;
use crate::block::solution::Solution;
use crate::block::window_sums::{CentredMoments, WindowSums};
use crate::contact::{Impedance, Observation};
use crate::window::Recent;

/// Moments of residuals about `centre`, and what rounding has kept out of them so far (Kahan's summation). Without it a sum
/// that loses its largest terms, as where a swing dies away, would be left with their rounding in the place of what stays.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Run<M> {
    centre: Impedance,
    moments: M,
    lost: M,
}

impl<M: Moments> Run<M> {
    fn about(centre: Impedance) -> Self {
        Self { centre, moments: M::default(), lost: M::default() }
    }

    #[inline(never)]
    fn add(&mut self, o: &Observation) {
        self.moments.kahan_add(&mut self.lost, &M::of(o, o.residual(self.centre)), 1.0);
    }

    #[inline(never)]
    fn remove(&mut self, o: &Observation) {
        self.moments.kahan_add(&mut self.lost, &M::of(o, o.residual(self.centre)), -1.0);
    }

    /// The moments about `estimate`.
    #[inline(always)]
    fn moments_about(&self, estimate: Impedance) -> M {
        self.moments.shifted(estimate.moved(-1.0, self.centre))
    }
}

/// Square of the multiple of the rms residual beyond which a sample is an outlier: 6, which Gaussian noise does not reach. What is
/// nearer costs the third power of 6 of a last digit at most.
const OUTLIER_RATIO_SQ: f32 = 36.0;

/// Samples that an rms needs.
const MIN_SAMPLES: u16 = 8;

/// Samples between two checks of the centre: enough for two unknowns, few enough to notice a change early.
const RECENTRE_INTERVAL: u16 = 32;

/// Share of the residual energy that the least-squares solution has to explain to become the new centre:
/// the residual about the centre is then twice that about the other.
const MIN_EXPLAINED_FRACTION: f32 = 0.75;

/// The sums `M` of a window, updated sample by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CompensatedSums<M> {
    older: Run<M>,
    newer: Run<M>,
    /// Replaces `newer` once it holds the same samples.
    rebuilt: Run<M>,
    /// The sample that leaves the window next.
    oldest: Observation,
    /// Mean square residual of the run before; zero where there was none.
    level: f32,
    /// Samples in the window.
    fill: u16,
    /// Samples in `newer`.
    covered: u16,
    /// Samples in `rebuilt`.
    caught_up: u16,
    /// Updates since `older` was last empty.
    age: u16,
    /// Updates since the last check of the centre.
    since: u16,
    /// `newer` began with an outlier.
    in_outliers: bool,
    /// `rebuilt` is being built.
    rebuilding: bool,
}

impl<M: Moments> CompensatedSums<M> {
    /// A window that was not followed sample by sample: all of it, about `centre`.
    #[cold]
    #[inline(never)]
    fn rebuild(&mut self, recent: &Recent<'_>, centre: Impedance) {
        *self = Self::default();
        self.begin(centre);
        recent.for_each(|o| self.newer.add(o));
        self.oldest = recent.oldest().unwrap_or_default();
        self.fill = u16::try_from(recent.len()).unwrap_or(u16::MAX);
        self.covered = self.fill;
    }

    /// `next` begins again, and is not being rebuilt.
    fn begin(&mut self, centre: Impedance) {
        self.newer = Run::about(centre);
        (self.covered, self.since, self.rebuilding) = (0, 0, false);
    }

    /// Merges the run into `older` where `newest` is an outlier of it, or the first sample that is none again.
    fn split_at_outlier(&mut self, newest: &Observation) {
        let (e, sums) = (newest.residual(self.newer.centre), self.newer.moments.second());
        let square = e * e;
        let out = if self.covered >= MIN_SAMPLES {
            square * f32::from(self.covered) > OUTLIER_RATIO_SQ * sums.residual_energy
        } else {
            !self.in_outliers && self.level > 0.0 && square > OUTLIER_RATIO_SQ * self.level
        };
        let back = self.in_outliers && square <= OUTLIER_RATIO_SQ * self.level;
        if out || back {
            self.split(out && !self.in_outliers, back);
        }
    }

    /// Merges the run into `older`; the next sample is the `first` outlier, a further one, or the first that is `back`.
    #[cold]
    #[inline(never)]
    fn split(&mut self, first: bool, back: bool) {
        if first && self.covered >= MIN_SAMPLES {
            self.level = self.newer.moments.second().residual_energy / f32::from(self.covered);
        }
        self.in_outliers = !back;
        if self.covered < self.fill {
            let joining = self.newer.moments_about(self.older.centre);
            self.older.moments.kahan_add(&mut self.older.lost, &joining, 1.0);
        } else {
            self.older = self.newer;
        }
        self.begin(self.newer.centre);
    }

    /// Adds the newest sample to what is rebuilt, and one more of the ring; two where the contact is young.
    #[inline(never)]
    fn catch_up(&mut self, newest: &Observation, recent: &Recent<'_>) {
        self.rebuilt.add(newest);
        self.caught_up += 1;
        let more = if self.fill < RECENTRE_INTERVAL { 2 } else { 1 };
        for _ in 0..more {
            if self.caught_up < self.covered {
                let older = recent.before_newest(usize::from(self.caught_up)).unwrap_or_default();
                self.rebuilt.add(&older);
                self.caught_up += 1;
            }
        }
        if self.caught_up >= self.covered {
            self.newer = self.rebuilt;
            (self.since, self.rebuilding) = (0, false);
        }
    }

    /// `older` is empty, and the run is the window.
    #[inline(never)]
    fn swap(&mut self, config: &BlockConfig) {
        self.older = self.newer;
        self.level = self.older.moments.second().residual_energy / f32::from(self.covered);
        self.begin(better_centre(&self.older, self.covered, config).unwrap_or(self.older.centre));
        self.age = 0;
    }

    /// Updates from one check of the centre to the next.
    fn recentre_interval(&self, config: &BlockConfig) -> u16 {
        if self.fill < RECENTRE_INTERVAL {
            MIN_SAMPLES / 2
        } else {
            RECENTRE_INTERVAL.min(config.window / 4).max(MIN_SAMPLES)
        }
    }

    /// Rebuilds `next` where another centre suits it better_centre.
    #[inline(never)]
    fn recentre_if_better(&mut self, config: &BlockConfig) {
        self.since = 0;
        if let Some(centre) = better_centre(&self.newer, self.covered, config) {
            self.rebuilt = Run::about(centre);
            (self.caught_up, self.rebuilding, self.in_outliers) = (0, true, false);
        }
    }
}

/// The least-squares solution of `run`, where it explains most of the residual about the centre.
fn better_centre<M: Moments>(run: &Run<M>, samples: u16, config: &BlockConfig) -> Option<Impedance> {
    let sums = run.moments.second();
    let correction = Solution::of(sums, f32::from(samples), config, run.centre).correction;
    let explained = correction.stiffness * sums.residual.stiffness + correction.damping * sums.residual.damping;
    let centre = run.centre.moved(1.0, correction);
    (explained > MIN_EXPLAINED_FRACTION * sums.residual_energy && centre.is_finite()).then_some(centre)
}

impl<M: Moments> WindowSums for CompensatedSums<M> {
    type CentredMoments = M;

    fn push(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: Impedance) {
        let expected = if self.fill < config.window { self.fill + 1 } else { config.window };
        if self.fill == 0 || recent.len() != usize::from(expected) {
            self.rebuild(recent, estimate);
            return;
        }
        let newest = recent.newest().unwrap_or_default();
        if self.covered >= config.window {
            self.swap(config);
        }
        if self.fill == config.window {
            self.older.remove(&self.oldest);
        }
        self.age = self.age.saturating_add(1);
        if u32::from(self.age) < 2 * u32::from(config.window) {
            self.split_at_outlier(&newest);
        }
        self.fill = expected;
        self.oldest = recent.oldest().unwrap_or_default();
        self.newer.add(&newest);
        self.covered += 1;
        self.since += 1;
        if self.rebuilding {
            self.catch_up(&newest, recent);
        } else if self.covered >= MIN_SAMPLES && self.since >= self.recentre_interval(config) {
            self.recentre_if_better(config);
        }
    }

    fn centred_moments(&self, _: &Recent<'_>, estimate: Impedance) -> CentredMoments<M> {
        CentredMoments { centre: estimate, moments: self.moments_about(estimate) }
    }
}

impl<M: Moments> CompensatedSums<M> {
    /// The window's moments about `estimate`.
    #[inline(never)]
    pub fn moments_about(&self, estimate: Impedance) -> M {
        let mut moments = self.newer.moments;
        if self.covered < self.fill {
            if self.older.centre != self.newer.centre {
                return self.older.moments_about(estimate).with(&self.newer.moments_about(estimate));
            }
            moments = moments.with(&self.older.moments);
        }
        moments.shifted(estimate.moved(-1.0, self.newer.centre))
    }
}

impl CompensatedSums<FourthOrderSums> {
    /// The window's sums of fourth order about `estimate`, as [`Self::moments_about`] has them.
    #[inline(never)]
    pub fn quartic_about(&self, estimate: Impedance) -> QuarticSums {
        let (older, newer) = (self.older.moments.quartic(), self.newer.moments.quartic());
        let from_newer = estimate.moved(-1.0, self.newer.centre);
        if self.covered >= self.fill {
            return newer.shifted(from_newer);
        }
        if self.older.centre != self.newer.centre {
            return older.shifted(estimate.moved(-1.0, self.older.centre)).with(&newer.shifted(from_newer));
        }
        newer.with(older).shifted(from_newer)
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
                let mut sums = CompensatedSums::<SecondOrderSums>::default();
                sums.push(&config, &ring.recent().last(followed), Impedance::ZERO);
                let recent = ring.recent().last(length);
                sums.push(&config, &recent, estimate);
                let got = sums.moments_about(estimate);
                assert_eq!(got, SecondOrderSums::over(&recent, estimate), "{length} samples after {followed}");
            }
        }
    }
}
