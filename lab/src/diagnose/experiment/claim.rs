//! A model and its values, as one side of an argument.

use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::model::{Model, index};
use crate::effects::Scene;

/// A model with its values, as of the first trial alone.
#[derive(Debug, Clone)]
pub struct Claim {
    /// Its structure.
    pub model: Model,
    /// Its values.
    pub values: Vec<f64>,
    /// The measures of the recordings under it.
    pub scene: Scene,
}

impl Claim {
    /// `model` with `values` in a trial by itself.
    #[must_use]
    pub fn of(study: &Study, model: &Model, values: &[f64]) -> Self {
        let scene = study.scene(model, values);
        let mut own = values[..index::SHARED].to_vec();
        for (at, term) in model.terms.iter().enumerate() {
            own.extend(term.in_trial(&values[model.start_of(at)..], 0));
        }
        Self { model: Model { shifts: Vec::new(), ..model.clone() }, values: own, scene }
    }

    /// Its terms, with the nominal values of `other`: another place from which to search.
    #[must_use]
    pub fn about(&self, other: &Self) -> Vec<f64> {
        other.values[..index::SHARED].iter().chain(&self.values[index::SHARED..]).copied().collect()
    }
}
