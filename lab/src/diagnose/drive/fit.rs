//! Maximum likelihood: the values of a law and the density of its disturbance, in turns.

use super::levenberg_marquardt::{Ended, search_values};
use super::likelihood::Data;
use super::model::{Model, index};
use super::noise::Noise;
use super::noise_search::search_noise;

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What was fitted.
    pub model: Model,
    /// Its values.
    pub values: Vec<f64>,
    /// The random part.
    pub noise: Noise,
    /// ln of the likelihood, nats.
    pub log_likelihood: f64,
    /// How the search ended.
    pub ended: Ended,
}

impl Fit {
    /// Whether its inertia is one that is not believed, where that of `other` is: it is no law of the drive then. The force that it leaves is told in
    /// parts of that inertia, so of a body that weighs next to nothing it is little, however badly its motion is followed.
    #[must_use]
    pub fn loses_inertia_of(&self, other: &Self) -> bool {
        let is_believed = |fit: &Self| fit.model.has_believed_inertia(&fit.values);
        is_believed(other) && !is_believed(self)
    }

    /// What the force that it leaves is multiplied by to be told beside that of `other`: where it loses that one's inertia for a smaller one, the
    /// force that would move the believed body as much.
    #[must_use]
    pub fn force_beside(&self, other: &Self) -> f64 {
        let inertia = |fit: &Self| fit.values[index::INERTIA];
        if self.loses_inertia_of(other) { (inertia(other) / inertia(self)).max(1.0) } else { 1.0 }
    }

    /// ln of the likelihood of each scored row of `data`, but for a constant, under the noise as it stands.
    #[must_use]
    pub fn row_log_likelihoods(&self, data: &Data<'_>) -> Vec<f64> {
        data.row_log_likelihoods(&self.model, &self.values, &self.noise)
    }
}

/// How long a fit may take: turns of values and noise, and steps of the values in the first turn and in each later one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Turns.
    pub turns: usize,
    /// Steps in the first.
    pub first_steps: usize,
    /// Steps in each later one.
    pub later_steps: usize,
}

impl Effort {
    /// Enough to compare one start with another.
    pub const QUICK: Self = Self { turns: 1, first_steps: 6, later_steps: 0 };
    /// To the end, for one body.
    pub const FULL: Self = Self { turns: 3, first_steps: 12, later_steps: 6 };
    /// To the end, for two bodies that were followed on a stretch before.
    pub const LINKED: Self = Self { turns: 4, first_steps: 6, later_steps: 4 };
}

/// Gain of a turn below which values and noise stand, nats.
const SETTLED_GAIN: f64 = 0.5;

/// Fits `model` from `start` and `noise`, values and noise in turns.
#[must_use]
pub fn fit(data: &Data<'_>, model: &Model, start: &[f64], noise: Noise, effort: Effort) -> Fit {
    let (mut values, mut noise) = (start.to_vec(), noise);
    let mut log_likelihood = f64::NEG_INFINITY;
    let mut ended = Ended::OutOfSteps;
    for turn in 0..effort.turns {
        let steps = if turn == 0 { effort.first_steps } else { effort.later_steps };
        search_values(data, model, &mut values, &noise, steps);
        let reached = search_noise(data, model, &values, &mut noise);
        let gain = reached - log_likelihood;
        log_likelihood = reached;
        if gain < SETTLED_GAIN {
            ended = Ended::Converged;
            break;
        }
    }
    Fit { model: model.clone(), values, noise, log_likelihood, ended }
}
