//! A model and its values, as one side of an argument.

use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::model::{Model, index};
use crate::effects::ExcitationStats;

/// A model with its values, as of the first trial alone.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    /// Its structure.
    pub model: Model,
    /// Its values.
    pub values: Vec<f64>,
    /// The measures of the recordings under it.
    pub excitation: ExcitationStats,
}

impl Hypothesis {
    /// `model` with `values` in a trial by itself.
    #[must_use]
    pub fn of(problem: &IdentificationProblem, model: &Model, values: &[f64]) -> Self {
        let excitation = problem.excitation_stats(model, values);
        let mut own = values[..index::SHARED].to_vec();
        for (at, term) in model.terms.iter().enumerate() {
            own.extend(term.in_trial(&values[model.first_value_of(at)..], 0));
        }
        Self { model: Model { surface_shifts: Vec::new(), ..model.clone() }, values: own, excitation }
    }

    /// Its terms, with the nominal values of `other`: another place from which to search.
    #[must_use]
    pub fn about(&self, other: &Self) -> Vec<f64> {
        other.values[..index::SHARED].iter().chain(&self.values[index::SHARED..]).copied().collect()
    }
}
