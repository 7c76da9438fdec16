//! A law with its state and its latest estimate, beside others on one stream.

use super::{ContactLoss, Event, Stream};
use crate::contact::Impedance;
use crate::quality::{Estimate, Flags, IntervalEstimator};
use crate::recursive::CusumRls;
use crate::update_law::UpdateLaw;

/// A law with its state and its latest estimate.
#[derive(Debug, Clone)]
pub struct EstimatorState<L: UpdateLaw> {
    law: L,
    state: L::State,
    last: Estimate,
}

impl<L: UpdateLaw> EstimatorState<L> {
    /// At the start.
    pub fn new(law: L) -> Self {
        Self { state: law.initial_state(), law, last: Estimate::UNKNOWN }
    }

    /// Resets it to the initial state.
    pub fn restart(&mut self) {
        self.state = self.law.initial_state();
        self.last = Estimate::UNKNOWN;
    }

    /// Replaces the law and resets its state.
    pub(crate) fn configure(&mut self, law: L) {
        self.law = law;
        self.restart();
    }

    /// The state of the law.
    pub fn state(&self) -> &L::State {
        &self.state
    }

    /// Updates with `event`, which `stream` has just returned.
    pub fn update<const N: usize>(&mut self, stream: &Stream<N>, event: &Event) -> Estimate {
        match self.settle(stream, event) {
            Some(estimate) => estimate,
            None => self.learn(stream, event.flags),
        }
    }

    /// The estimate of an event that brings no row, and what a loss of contact discards; `None` where there is a row to learn from.
    pub(crate) fn settle<const N: usize>(&mut self, stream: &Stream<N>, event: &Event) -> Option<Estimate> {
        if event.lost {
            match stream.contact_loss {
                ContactLoss::Everything => self.state = self.law.initial_state(),
                ContactLoss::Memory => self.law.reset_memory(&mut self.state),
                ContactLoss::Nothing => {}
            }
        }
        if !event.reading.contact {
            self.last = Estimate::UNKNOWN;
            let units = stream.front_end.config().units;
            return Some(Estimate {
                innovation: event.reading.observation.force * units.force,
                flags: Flags::NO_CONTACT | event.flags,
                ..Estimate::NO_CONTACT
            });
        }
        event.reading.restarted.then(|| Estimate {
            innovation: 0.0,
            flags: self.last.flags | event.flags | Flags::HELD,
            ..self.last
        })
    }

    /// Updates with the row that `stream` has just taken, in a contact that goes on.
    #[inline(always)]
    pub(crate) fn learn<const N: usize>(&mut self, stream: &Stream<N>, flags: Flags) -> Estimate {
        let step = self.law.update(&mut self.state, stream.recent());
        let estimate = stream.assessor.assess(&step);
        self.last = Estimate { flags: estimate.flags | flags, ..estimate };
        self.last
    }
}

impl EstimatorState<CusumRls> {
    /// [`Self::learn`] without the interval: K and B in SI, and the flags that need none.
    #[inline(always)]
    pub(crate) fn learn_estimate<const N: usize>(&mut self, stream: &Stream<N>, flags: Flags) -> (Impedance, Flags) {
        let o = stream.recent().newest().unwrap_or_default();
        let (fill, of_law) = self.law.learn(&mut self.state, &o);
        let estimate = self.state.recursion.estimate;
        let impedance = stream.assessor.in_si(estimate);
        let flags = of_law | flags | IntervalEstimator::doubts(estimate, fill);
        self.last = Estimate { impedance, fill, flags, ..Estimate::UNKNOWN };
        (impedance, flags)
    }

    /// Half-widths of the 95 % intervals of what was learnt, in SI.
    pub(crate) fn half_width<const N: usize>(&self, stream: &Stream<N>) -> Impedance {
        stream.assessor.half_width_in_si(self.state.recursion.estimate, &self.law.confidence(&self.state))
    }
}
