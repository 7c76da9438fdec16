//! The sums of a sliding window at constant cost, without drift: sums of whole numbers, from which a sample is removed to the bit.
//!
//! The window is one run of samples ([`ExactRun`]) with a centre, the estimate that residuals are taken about, and a scale, the powers
//! of two that make numbers whole. Both stay until they no longer suit.
//!
//! - Where the estimate has left the centre, or the samples have become small against the scale, another run is prepared beside it: every
//!   new sample enters both, and one older sample more enters the other at each update, until it holds the window and takes the place
//!   of the first.
//! - A sample that does not fit the scale begins another run at once, which holds the newest samples, while the first holds the others. At
//!   each update one sample is transferred, until the first is empty.

use crate::block::centre::{is_moderate, suits_better};
use crate::block::config::BlockConfig;
use crate::block::exact_run::ExactRun;
use crate::block::scale::{Scale, bits_for};
use crate::block::second_order::{Moments, SecondOrderSums};
use crate::block::second_use::SecondUse;
use crate::block::window_sums::{CentredMoments, WindowSums};
use crate::contact::{Impedance, Observation};
use crate::window::Recent;

/// Window below which all samples are summed at every update, which costs no more there.
const MIN_WINDOW: u16 = 16;

/// Updates between two checks, of the centre and of the scale in turn; half a window where that is shorter.
const CHECK_INTERVAL: u16 = 16;

/// Updates until the first check: so many samples tell two unknowns.
const FIRST_CHECK: u16 = 8;

/// The sums of a window, updated sample by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExactSums {
    run: ExactRun,
    second: ExactRun,
    /// The sample that leaves the window next; the default sample, which is nothing, while the window fills.
    leaving: Observation,
    /// Whole numbers are below this power of two.
    limit: i32,
    second_use: SecondUse,
    /// Samples in the window.
    fill: u16,
    /// Updates between two checks.
    check_interval: u16,
    /// The next check is that of the scale.
    scale_is_next: bool,
    /// The run is all of the window: no samples are being transferred, and the window is not a short one.
    is_whole: bool,
    /// Updates until one that has more to do: a check, a sample of a prepared run, or one that is transferred.
    usual_left: u16,
    /// Length of the window that an update goes on with: one more than `fill`, or all.
    expected: u16,
    /// Square of the rate in whole numbers whose rms holds B; infinite where the run does not tell the least-squares solution: with a prior,
    /// in a window that is too young or was so at the last check, and while samples are being transferred.
    rate_energy: f32,
    /// The same times the samples in the window.
    least_rate_energy: f32,
    /// [`BlockConfig::independence_floor`].
    independence_floor: f32,
}

impl ExactSums {
    /// A window that was not followed sample by sample: all of it, about `centre`.
    fn rebuild(&mut self, config: &BlockConfig, recent: &Recent<'_>, centre: Impedance) {
        let bits = bits_for(config.window);
        let centre = if is_moderate(centre) { centre } else { Impedance::ZERO };
        let mut scale = Scale::initial(bits);
        self.limit = 1 << bits;
        if !self.sum_anew(recent, centre, &scale) {
            recent.for_each(|o| scale = scale.coarser(o, o.residual(centre), bits));
            self.sum_anew(recent, centre, &scale);
        }
        self.fill = u16::try_from(recent.len()).unwrap_or(u16::MAX);
        self.check_interval = CHECK_INTERVAL.min(config.window / 2);
        self.independence_floor = config.independence_floor;
        (self.second_use, self.usual_left, self.scale_is_next) = (SecondUse::Unused, FIRST_CHECK, false);
    }

    /// Sums all of `recent`; whether every sample fits the scale.
    fn sum_anew(&mut self, recent: &Recent<'_>, centre: Impedance, scale: &Scale) -> bool {
        self.run.restart(centre, scale);
        let (mut fits, mut odd) = (true, None);
        recent.for_each(|o| match odd.take() {
            Some(before) => fits &= self.run.add(&before, o, self.limit),
            None => odd = Some(*o),
        });
        fits & self.run.add(&odd.unwrap_or_default(), &Observation::default(), self.limit)
    }

    fn bits(&self) -> u32 {
        self.limit.trailing_zeros()
    }

    /// After a change of the scale, and where an update is to come to a window of `length`.
    fn renew_least_rate_energy(&mut self, config: &BlockConfig, length: u16) {
        let is_told = self.is_whole && config.prior.is_none() && length >= config.minimum_fill;
        self.rate_energy = if is_told { self.run.rate_energy(config.rate_floor) } else { f32::INFINITY };
        self.least_rate_energy = f32::from(length) * self.rate_energy;
    }

    /// The window comes to a `length` that is not all of it. At the update that fills it there is a check, which sees to the rest.
    #[inline(always)]
    fn grow(&mut self, config: &BlockConfig, length: u16) {
        self.expected = length + 1;
        if self.expected == config.window {
            self.usual_left = 0;
        }
        self.least_rate_energy = f32::from(length) * self.rate_energy;
    }

    /// Takes in the newest sample, removes the oldest, and transfers the newest of the older run.
    fn transfer(&mut self, config: &BlockConfig, recent: &Recent<'_>, newest: &Observation) {
        let mut older = match self.second_use {
            SecondUse::Older(count) => count,
            _ => {
                let residual = newest.residual(self.run.centre);
                self.second = self.run;
                let scale = self.run.scale.coarser(newest, residual, self.bits());
                self.run.restart(self.run.centre, &scale);
                self.usual_left = 0;
                self.fill
            }
        };
        if self.fill == config.window {
            older -= 1;
        } else {
            self.fill += 1;
        }
        let mut transferred = Observation::default();
        if older > 0 {
            transferred = recent.before_newest(usize::from(self.fill - older)).unwrap_or_default();
            older -= 1;
        }
        self.second.remove(&self.leaving, &transferred);
        let fits = self.run.add(newest, &transferred, self.limit);
        self.second_use = SecondUse::Older(older);
        if older == 0 {
            self.release_second();
        }
        if !fits {
            // Twice within a window beyond the scale, by a factor of 128 each time.
            self.rebuild(config, recent, self.run.centre);
        }
    }

    /// Before an update: checks centre and scale, or goes on with the second run. `false` where the update is not a usual one.
    #[cold]
    #[inline(never)]
    fn maintain(
        &mut self,
        config: &BlockConfig,
        (older, newer): (&[Observation], &[Observation]),
        estimate: &Impedance,
    ) -> bool {
        let recent = &Recent::of_runs(older, newer);
        let newest = recent.newest().unwrap_or_default();
        let mut renewed = self.fill < config.window;
        match self.second_use {
            SecondUse::Unused => self.check(&newest, *estimate),
            SecondUse::Prepared(count) if count < self.fill => self.prepare(recent, &newest, count),
            SecondUse::Prepared(_) => {
                self.run = self.second;
                self.release_second();
                renewed = true;
            }
            SecondUse::Older(_) => return false,
        }
        if renewed {
            self.renew_least_rate_energy(config, self.expected);
        }
        true
    }

    fn release_second(&mut self) {
        (self.second_use, self.usual_left) = (SecondUse::Unused, self.check_interval - 1);
    }

    /// Two more samples of the run that is being prepared: the newest, and the newest of those that it does not hold.
    fn prepare(&mut self, recent: &Recent<'_>, newest: &Observation, count: u16) {
        let is_last = count + 1 >= self.expected;
        let older = if is_last { None } else { recent.before_newest(usize::from(count) + 1) };
        self.second_use = SecondUse::Prepared(count + 2);
        if !self.second.add(newest, &older.unwrap_or_default(), self.limit) {
            self.release_second();
        }
    }

    /// Has another run prepared where the samples have become small against the scale, or the estimate is a better centre.
    fn check(&mut self, newest: &Observation, estimate: Impedance) {
        let mean_squares = |run: &ExactRun| run.mean_squares(newest, f32::from(self.fill));
        let (mut centre, mut scale) = (None, None);
        if self.scale_is_next {
            scale = self.run.scale.finer(&mean_squares(&self.run), self.bits());
        } else if is_moderate(estimate) && suits_better(estimate, &self.run) {
            centre = Some(estimate);
        }
        self.scale_is_next = !self.scale_is_next;
        self.usual_left = self.check_interval - 1;
        if centre.is_some() || scale.is_some() {
            self.second.restart(centre.unwrap_or(self.run.centre), &scale.unwrap_or(self.run.scale));
            (self.second_use, self.usual_left) = (SecondUse::Prepared(0), 0);
        }
    }

    /// The sums while samples are being transferred, and of a short window.
    #[cold]
    #[inline(never)]
    fn unusual_moments(&self, recent: &Recent<'_>) -> SecondOrderSums {
        if self.fill == 0 {
            return SecondOrderSums::over(recent, self.run.centre);
        }
        let turn = self.run.centre.moved(-1.0, self.second.centre);
        self.second.moments().shifted(turn).with(&self.run.moments())
    }
}

impl WindowSums for ExactSums {
    type CentredMoments = SecondOrderSums;

    #[inline(always)]
    fn push(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: Impedance) {
        if !self.push_usual(config, recent, &estimate) {
            self.push_unusual(config, recent.runs(), estimate);
        }
    }

    /// One run, a window as long as it was expected, and a sample that fits the scale.
    #[inline(always)]
    fn push_usual(&mut self, config: &BlockConfig, recent: &Recent<'_>, estimate: &Impedance) -> bool {
        let (older, newer) = recent.runs();
        let length = older.len() + newer.len();
        let (true, [.., newest]) = (length == usize::from(self.expected), newer) else { return false };
        if let Some(left) = self.usual_left.checked_sub(1) {
            self.usual_left = left;
        } else if !self.maintain(config, (older, newer), estimate) {
            return false;
        }
        let mut next = &Observation { penetration: 0.0, rate: 0.0, force: 0.0 };
        if length < usize::from(config.window) {
            self.grow(config, length as u16);
        } else if let [oldest, ..] = if older.is_empty() { newer } else { older } {
            next = oldest;
        }
        let Some(new) = self.run.fitting(newest, self.limit) else {
            self.expected = length as u16;
            return false;
        };
        self.fill = length as u16;
        self.run.replace(new, &mut self.leaving, next);
        true
    }

    /// An update at the begin of a window, while samples are being transferred, or with a sample that does not fit the scale.
    #[cold]
    #[inline(never)]
    fn push_unusual(
        &mut self,
        config: &BlockConfig,
        (older, newer): (&[Observation], &[Observation]),
        estimate: Impedance,
    ) {
        let recent = &Recent::of_runs(older, newer);
        if config.window < MIN_WINDOW {
            self.run.centre = estimate;
            return;
        }
        if self.fill == 0 || recent.len() != usize::from(self.expected) {
            self.rebuild(config, recent, estimate);
        } else {
            self.transfer(config, recent, &recent.newest().unwrap_or_default());
        }
        let full = self.fill == config.window;
        self.leaving = recent.oldest().filter(|_| full).unwrap_or_default();
        self.expected = if full { self.fill } else { self.fill + 1 };
        self.is_whole = !matches!(self.second_use, SecondUse::Older(_));
        self.renew_least_rate_energy(config, self.fill);
    }

    #[inline(always)]
    fn centred_moments(&self, recent: &Recent<'_>, _: Impedance) -> CentredMoments<SecondOrderSums> {
        let moments = if self.is_whole { self.run.moments() } else { self.unusual_moments(recent) };
        CentredMoments { centre: self.run.centre, moments }
    }

    #[inline(always)]
    fn least_squares(&self) -> Option<Impedance> {
        self.run.plain_least_squares(self.independence_floor, self.least_rate_energy)
    }

    fn usual_moments(&self) -> (CentredMoments<SecondOrderSums>, u16) {
        (CentredMoments { centre: self.run.centre, moments: self.run.moments() }, self.fill)
    }
}

#[cfg(test)]
mod tests;
