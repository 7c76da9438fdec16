//! The contact's law with the effects added to it, and the layout of its values.

use std::ops::Range;

use super::scales::Scales;
use crate::diagnose::term::Term;
use crate::effects::{ExcitationStats, Limit};

/// Places of the nominal values.
pub mod index {
    /// Stiffness K.
    pub const STIFFNESS: usize = 0;
    /// Damping B.
    pub const DAMPING: usize = 1;
    /// Position of the surface in the first trial.
    pub const SURFACE: usize = 2;
    /// Force late against position, s: a part of a recorded row, which no clock settles.
    pub const TIMING: usize = 3;
    /// How many all trials share.
    pub const SHARED: usize = 4;
}

/// What every trial may have for itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnValues {
    /// The surface lies elsewhere in each trial, by more than an encoder's start within its step.
    pub surface: bool,
    /// The force sensor's zero is another one in each trial.
    pub zero: bool,
    /// Another spot of the same body: all contact forces are greater or less by one factor.
    pub scale: bool,
}

impl OwnValues {
    /// None of them.
    pub const NONE: Self = Self { surface: false, zero: false, scale: false };
}

/// The structure of the contact's law. Its values are a vector: the nominal ones, those of each trial, and those of each term in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactModel {
    /// Force both ways.
    pub bilateral: bool,
    /// Reading of the sensor without a force, by the rig file.
    pub force_zero: f64,
    /// Trials.
    pub trials: usize,
    /// What each trial has for itself.
    pub own: OwnValues,
    /// Effects.
    pub terms: Vec<Term>,
    /// Sizes of the recordings.
    pub scales: Scales,
}

impl ContactModel {
    /// The same with one more effect.
    #[must_use]
    pub fn with(&self, term: Term) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more
    }

    /// Values that are no effect's.
    #[must_use]
    pub fn nominal_count(&self) -> usize {
        let each = usize::from(self.own.zero) + usize::from(self.own.scale);
        index::SHARED + self.trials.saturating_sub(1) * (1 + each)
    }

    /// Where the values of term `at` begin.
    #[must_use]
    pub fn first_value_of(&self, at: usize) -> usize {
        self.nominal_count() + self.terms[..at].iter().map(|term| self.count_of(term)).sum::<usize>()
    }

    /// The place of the value of term `at` that alone its law is linear in, zero where it is not there; `None` where its form has no such value, or
    /// several.
    #[must_use]
    pub fn size_of(&self, at: usize, excitation: &ExcitationStats) -> Option<usize> {
        let Term { effect, form } = self.terms[at];
        let start = effect.starts(form, excitation).into_iter().next()?;
        let [size] = start.linear_parameters[..] else { return None };
        let own = self.terms[at].all_parameters(self.trials);
        let is_alone = own.iter().filter(|parameter| parameter.name == own[size].name).count() == 1;
        is_alone.then(|| self.first_value_of(at) + size)
    }

    /// Whether it holds what `term` builds on, if that builds on anything.
    #[must_use]
    pub fn bears(&self, term: &Term) -> bool {
        let needed = term.foundations();
        needed.is_empty() || self.terms.iter().any(|own| term.builds_on(own))
    }

    /// Values of `term`.
    #[must_use]
    pub fn count_of(&self, term: &Term) -> usize {
        term.all_parameters(self.trials).len()
    }

    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.first_value_of(self.terms.len())
    }

    fn own_value(&self, values: &[f64], trial: usize, nth: usize) -> f64 {
        let others = self.trials - 1;
        if trial == 0 { 0.0 } else { values[index::SHARED + nth * others + trial - 1] }
    }

    /// Position of the surface in trial `trial`.
    #[must_use]
    pub fn surface(&self, values: &[f64], trial: usize) -> f64 {
        values[index::SURFACE] + self.own_value(values, trial, 0)
    }

    /// Zero of the sensor in trial `trial`, beside that of the rig file.
    #[must_use]
    pub fn zero(&self, values: &[f64], trial: usize) -> f64 {
        if self.own.zero { self.own_value(values, trial, 1) } else { 0.0 }
    }

    /// Places of the trials' own zeros.
    pub fn own_zeros(&self) -> Range<usize> {
        let others = self.trials - 1;
        let first = index::SHARED + others;
        if self.own.zero { first..first + others } else { first..first }
    }

    /// Factor of the contact's force in trial `trial`.
    #[must_use]
    pub fn scale(&self, values: &[f64], trial: usize) -> f64 {
        if self.own.scale { self.own_value(values, trial, 1 + usize::from(self.own.zero)).exp() } else { 1.0 }
    }

    /// The trial that value `at` belongs to alone; `None` where it is shared.
    #[must_use]
    pub fn owner(&self, at: usize) -> Option<usize> {
        let others = self.trials - 1;
        if at < index::SHARED || others == 0 {
            return None;
        }
        if at < self.nominal_count() {
            return Some(1 + (at - index::SHARED) % others);
        }
        let term = (0..self.terms.len()).rev().find(|term| at >= self.first_value_of(*term))?;
        let (first, own) = (self.first_value_of(term), self.terms[term].parameters());
        let offset = at - first;
        let each = own.iter().filter(|parameter| parameter.each_trial).count();
        if offset < own.len() {
            return own[offset].each_trial.then_some(0);
        }
        Some(1 + (offset - own.len()) / each)
    }

    /// Whether some effect of it may let the force fall.
    #[must_use]
    pub fn may_fall(&self) -> bool {
        self.terms.iter().any(|term| term.effect.may_fall(term.form))
    }

    /// Frequencies of the waves that its effects hold, with their harmonics, Hz.
    #[must_use]
    pub fn frequencies(&self, values: &[f64]) -> Vec<f64> {
        let terms = self.terms.iter().enumerate();
        let of = |(nth, term): (usize, &Term)| {
            let own = values[self.first_value_of(nth)..].iter().zip(term.parameters());
            let waves = own.filter(|(_, parameter)| parameter.limit == Limit::RepeatedCycles);
            let harmonics = term.effect.harmonics(term.form);
            waves.flat_map(move |(value, _)| (1..=harmonics).map(move |times| times as f64 * value)).collect::<Vec<_>>()
        };
        terms.flat_map(of).collect()
    }

    /// Frequency of term `nth`, Hz, where it is a line of the spectrum.
    #[must_use]
    pub fn line(&self, values: &[f64], nth: usize) -> Option<f64> {
        let named = self.terms[nth].parameters().iter().position(|parameter| parameter.name == "frequency")?;
        let is_line = !self.terms[nth].effect.lines().is_empty();
        is_line.then(|| values[self.first_value_of(nth) + named])
    }

    /// Deepest that the tool went below the surface, or farthest from it where it is clamped, m or rad.
    pub(super) fn deepest(&self, values: &[f64]) -> f64 {
        let [low, high] = self.scales.positions.map(|position| position - values[index::SURFACE]);
        if self.bilateral { high.max(-low) } else { high }
    }

    /// Whether each effect's values are what its statement says.
    #[must_use]
    pub fn is_as_stated(&self, values: &[f64]) -> bool {
        self.terms.iter().enumerate().all(|(nth, term)| {
            let start = self.first_value_of(nth);
            term.effect.is_itself(term.form, &values[start..start + self.count_of(term)], self.deepest(values))
        })
    }

    /// How often an effect of that name is held.
    #[must_use]
    pub fn times(&self, name: &str) -> usize {
        self.terms.iter().filter(|term| term.name() == name).count()
    }

    /// The names of its terms from number `first` on, each once.
    #[must_use]
    pub fn names(&self, first: usize) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = self.terms[first.min(self.terms.len())..].iter().map(Term::name).collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}
