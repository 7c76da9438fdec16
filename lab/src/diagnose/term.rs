//! An effect in a model, by one of its laws.

use crate::effects::{Effect, Foundation, Parameter};

/// An effect in a model.
#[derive(Clone, Copy)]
pub struct Term {
    /// What acts.
    pub effect: &'static dyn Effect,
    /// By which law.
    pub form: usize,
}

impl Term {
    /// Its parameters.
    #[must_use]
    pub fn parameters(&self) -> &'static [Parameter] {
        self.effect.spec().forms[self.form].parameters
    }

    /// Its parameters and, after them, for each trial but the first those that each trial has for itself.
    #[must_use]
    pub fn all_parameters(&self, trials: usize) -> Vec<Parameter> {
        let each = self.parameters().iter().filter(|parameter| parameter.each_trial);
        let more = (1..trials).flat_map(|_| each.clone());
        self.parameters().iter().chain(more).copied().collect()
    }

    /// Values in the layout of [`Term::all_parameters`] from those of its own parameters: alike in every trial.
    #[must_use]
    pub fn spread(&self, own: &[f64], trials: usize) -> Vec<f64> {
        let each = self.parameters().iter().zip(own).filter(|(parameter, _)| parameter.each_trial);
        let more = (1..trials).flat_map(|_| each.clone().map(|(_, value)| *value));
        own.iter().copied().chain(more).collect()
    }

    /// Values of its own parameters in trial `trial`, from those in the layout of [`Term::all_parameters`].
    #[must_use]
    pub fn in_trial(&self, all: &[f64], trial: usize) -> Vec<f64> {
        let parameters = self.parameters();
        let each = parameters.iter().filter(|parameter| parameter.each_trial).count();
        let mut next = parameters.len() + trial.saturating_sub(1) * each;
        let mut pick = |at: usize| {
            if trial == 0 || !parameters[at].each_trial {
                return all[at];
            }
            next += 1;
            all[next - 1]
        };
        (0..parameters.len()).map(&mut pick).collect()
    }

    /// Laws of which one has to be there for it to differ from a simpler one.
    #[must_use]
    pub fn foundations(&self) -> &'static [Foundation] {
        self.effect.builds_on(self.form)
    }

    /// Whether it builds on `lower`.
    #[must_use]
    pub fn builds_on(&self, lower: &Self) -> bool {
        self.foundations().iter().any(|law| law.is(lower.name(), lower.form))
    }

    /// Whether both are the same law of the same effect.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        self.name() == other.name() && self.form == other.form
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.effect.spec().name
    }
}

impl PartialEq for Term {
    fn eq(&self, other: &Self) -> bool {
        self.is(other)
    }
}

impl std::fmt::Debug for Term {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.name(), self.effect.spec().forms[self.form].name)
    }
}
