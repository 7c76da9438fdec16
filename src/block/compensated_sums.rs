//! The window's sums at a cost that does not depend on its length, without drift.
//!
//! The window is two runs of samples, each with sums of its own about a nearby estimate: `tail`, the older run, which only
//! loses samples, and `next`, the newer one, which only gains them. Once the tail is empty `next` equals the window; it
//! becomes the tail, and a new run begins. No sum outlives two windows, so nothing drifts.
//!
//! Where the material changes, or a sample is far out, large misfits must not be summed with small ones: taken off again
//! they would leave their rounding behind, and powers of a misfit about an estimate that is far away cancel. So
//!
//! - a sample that is far out of what `next` holds ends that run, which joins the tail, and so does the first sample that
//!   is back;
//! - now and then `next` looks at itself. Where its least-squares solution explains most of its misfit, its sums are
//!   built again about that, from the ring, one older sample more at each update, and then take their place.

use crate::block::config::BlockConfig;
use crate::block::second_order::Moments;
use crate::block::solution::Solution;
use crate::block::window_sums::{Local, Memory};
use crate::contact::{Impedance, Observation};
use crate::window::Recent;

/// Moments of misfits about `centre`, and what rounding has kept out of them so far (Kahan's summation). Without it a sum
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
        self.moments.gather(&mut self.lost, &M::of(o, o.misfit(self.centre)), 1.0);
    }

    #[inline(never)]
    fn remove(&mut self, o: &Observation) {
        self.moments.gather(&mut self.lost, &M::of(o, o.misfit(self.centre)), -1.0);
    }

    /// The moments about `estimate`.
    #[inline(always)]
    fn seen_from(&self, estimate: Impedance) -> M {
        self.moments.shifted(estimate.moved(-1.0, self.centre))
    }
}

/// Square of the multiple of the rms misfit beyond which a sample is far out: 6, which Gaussian noise does not reach. What is
/// nearer costs the third power of 6 of a last digit at most.
const FAR: f32 = 36.0;

/// Samples from which on their rms means something.
const SOME: u16 = 8;

/// Samples between two looks of `next` at itself: enough for two unknowns, few enough to notice a change early.
const LOOK: u16 = 32;

/// Share of the misfit's energy above which another estimate is so much better than the centre that it takes its place:
/// the misfit about the centre is then twice that about the other.
const MOST: f32 = 0.75;

/// What is remembered of a window by a law that sums moments `M`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Running<M> {
    tail: Run<M>,
    next: Run<M>,
    /// What is to take the place of `next`, once it holds the same samples.
    rebuilt: Run<M>,
    /// Leaves the window next.
    oldest: Observation,
    /// Mean square misfit of the run before; zero where there was none.
    level: f32,
    /// Samples in the window.
    fill: u16,
    /// Samples in `next`.
    covered: u16,
    /// Samples in `rebuilt`.
    caught_up: u16,
    /// Updates since the tail was last empty.
    age: u16,
    /// Updates since the last look.
    since: u16,
    /// `next` began with a sample that was far out.
    apart: bool,
    /// `rebuilt` is being built.
    rebuilding: bool,
}

impl<M: Moments> Running<M> {
    /// A window that was not followed sample by sample: all of it, about `centre`.
    #[cold]
    #[inline(never)]
    fn anew(&mut self, recent: Recent<'_>, centre: Impedance) {
        *self = Self::default();
        self.begin(centre);
        recent.for_each(|o| self.next.add(o));
        self.oldest = recent.oldest().unwrap_or_default();
        self.fill = u16::try_from(recent.len()).unwrap_or(u16::MAX);
        self.covered = self.fill;
    }

    /// `next` begins again, and is not being rebuilt.
    fn begin(&mut self, centre: Impedance) {
        self.next = Run::about(centre);
        (self.covered, self.since, self.rebuilding) = (0, 0, false);
    }

    /// The run so far joins the tail where `newest` is far out of it, or is the first that is not.
    fn part(&mut self, newest: &Observation) {
        let (e, sums) = (newest.misfit(self.next.centre), self.next.moments.second());
        let square = e * e;
        let out = if self.covered >= SOME {
            square * f32::from(self.covered) > FAR * sums.misfit_energy
        } else {
            !self.apart && self.level > 0.0 && square > FAR * self.level
        };
        let back = self.apart && square <= FAR * self.level;
        if out || back {
            self.split(out && !self.apart, back);
        }
    }

    /// The run so far joins the tail; the sample that comes is the `first` that is out, another, or the first that is `back`.
    #[cold]
    #[inline(never)]
    fn split(&mut self, first: bool, back: bool) {
        if first && self.covered >= SOME {
            self.level = self.next.moments.second().misfit_energy / f32::from(self.covered);
        }
        self.apart = !back;
        if self.covered < self.fill {
            let joining = self.next.seen_from(self.tail.centre);
            self.tail.moments.gather(&mut self.tail.lost, &joining, 1.0);
        } else {
            self.tail = self.next;
        }
        self.begin(self.next.centre);
    }

    /// Adds the newest sample to what is rebuilt, and one more of the ring; two where the contact is young.
    #[inline(never)]
    fn catch_up(&mut self, newest: &Observation, recent: Recent<'_>) {
        self.rebuilt.add(newest);
        self.caught_up += 1;
        let more = if self.fill < LOOK { 2 } else { 1 };
        for _ in 0..more {
            if self.caught_up < self.covered {
                let older = recent.before_newest(usize::from(self.caught_up)).unwrap_or_default();
                self.rebuilt.add(&older);
                self.caught_up += 1;
            }
        }
        if self.caught_up >= self.covered {
            self.next = self.rebuilt;
            (self.since, self.rebuilding) = (0, false);
        }
    }

    /// The tail is empty, and the run is the window.
    #[inline(never)]
    fn swap(&mut self, config: &BlockConfig) {
        self.tail = self.next;
        self.level = self.tail.moments.second().misfit_energy / f32::from(self.covered);
        self.begin(better(&self.tail, self.covered, config).unwrap_or(self.tail.centre));
        self.age = 0;
    }

    /// Updates from one look to the next.
    fn patience(&self, config: &BlockConfig) -> u16 {
        if self.fill < LOOK { SOME / 2 } else { LOOK.min(config.window / 4).max(SOME) }
    }

    /// Rebuilds `next` where another centre suits it better.
    #[inline(never)]
    fn look(&mut self, config: &BlockConfig) {
        self.since = 0;
        if let Some(centre) = better(&self.next, self.covered, config) {
            self.rebuilt = Run::about(centre);
            (self.caught_up, self.rebuilding, self.apart) = (0, true, false);
        }
    }
}

/// The least-squares solution of `run`, where it explains most of the misfit about the centre.
fn better<M: Moments>(run: &Run<M>, samples: u16, config: &BlockConfig) -> Option<Impedance> {
    let sums = run.moments.second();
    let correction = Solution::of(sums, f32::from(samples), config, run.centre).correction;
    let explained = correction.stiffness * sums.misfit.stiffness + correction.damping * sums.misfit.damping;
    let centre = run.centre.moved(1.0, correction);
    (explained > MOST * sums.misfit_energy && centre.is_finite()).then_some(centre)
}

impl<M: Moments> Memory for Running<M> {
    type Local = M;

    fn follow(&mut self, config: &BlockConfig, recent: Recent<'_>, estimate: Impedance) {
        let expected = if self.fill < config.window { self.fill + 1 } else { config.window };
        if self.fill == 0 || recent.len() != usize::from(expected) {
            self.anew(recent, estimate);
            return;
        }
        let newest = recent.newest().unwrap_or_default();
        if self.covered >= config.window {
            self.swap(config);
        }
        if self.fill == config.window {
            let oldest = self.oldest;
            self.tail.remove(&oldest);
        }
        self.age = self.age.saturating_add(1);
        if self.age < config.window.saturating_mul(2) {
            self.part(&newest);
        }
        self.fill = expected;
        self.oldest = recent.oldest().unwrap_or_default();
        self.next.add(&newest);
        self.covered += 1;
        self.since += 1;
        if self.rebuilding {
            self.catch_up(&newest, recent);
        } else if self.covered >= SOME && self.since >= self.patience(config) {
            self.look(config);
        }
    }

    fn local(&self, _: Recent<'_>, estimate: Impedance) -> Local<M> {
        Local { centre: estimate, moments: self.seen_from(estimate) }
    }
}

impl<M: Moments> Running<M> {
    /// The window's moments about `estimate`.
    #[inline(never)]
    pub fn seen_from(&self, estimate: Impedance) -> M {
        let mut moments = self.next.moments;
        if self.covered < self.fill {
            if self.tail.centre != self.next.centre {
                return self.tail.seen_from(estimate).with(&self.next.seen_from(estimate));
            }
            moments = moments.with(&self.tail.moments);
        }
        moments.shifted(estimate.moved(-1.0, self.next.centre))
    }
}
