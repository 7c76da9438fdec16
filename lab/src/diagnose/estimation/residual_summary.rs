//! What a model leaves of a recording or a replicate, and what effects could take of it.

use super::levenberg_marquardt::FitData;
use super::projection::{EffectScore, ProjectedResidual};
use super::residual_tests::{self, ResidualTest};
use super::whitener::Whitener;
use crate::diagnose::model::{Channels, Model, Term};
use crate::diagnose::signals::filtered_trial::AnalysisTrial;
use crate::diagnose::thresholds::residual_summary::MAX_PROMISING;
use crate::effects::ExcitationStats;

/// What a model leaves of one set of trials, a recording or a replicate.
#[derive(Debug, Clone)]
pub struct ResidualSummary {
    /// Whitened energy, once the model's own values have taken theirs.
    pub energy: f64,
    /// Mean square of the residual over its expected noise, before its autocorrelation is taken off, of force and effort: one where all is noise.
    pub powers: [f64; 2],
    /// What each effect could take; of a replicate, the effects that are promising on the recording.
    pub scores: Vec<EffectScore>,
    /// What shapes without a name could take.
    pub residual_tests: Vec<ResidualTest>,
    /// How much the rest is autocorrelated.
    pub memory: f64,
    /// By how much the model's values would have to move to fit these trials best.
    pub shift: Vec<f64>,
}

impl ResidualSummary {
    /// The scores that are worth a closer look, the greatest first.
    pub fn promising(&self) -> impl Iterator<Item = &EffectScore> {
        let mut scores: Vec<&EffectScore> = self.scores.iter().collect();
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores.into_iter().take(MAX_PROMISING)
    }

    /// What `term` could take; `None` where that was not asked.
    #[must_use]
    pub fn gain(&self, term: &Term) -> Option<f64> {
        self.scores.iter().find(|score| score.term.is(term)).map(|score| score.gain)
    }
}

/// What `model` with `values` leaves of `trials`; `asked` says which effects are asked what they could take.
#[must_use]
pub fn summarize(
    trials: &[AnalysisTrial],
    whitener: &Whitener,
    model: &Model,
    values: &[f64],
    excitation: &ExcitationStats,
    asked: &dyn Fn(&Term) -> bool,
) -> ResidualSummary {
    let data = FitData { trials, whitener, rows: None };
    let projected = ProjectedResidual::of(data, model, values, excitation);
    let without_autocorrelation = whitener.without_autocorrelation();
    let plain =
        FitData { trials, whitener: &without_autocorrelation, rows: None }.residual(model, values, Channels::BOTH);
    ResidualSummary {
        powers: whitener.powers(&plain),
        energy: projected.energy(),
        scores: projected.scores(excitation, asked),
        residual_tests: residual_tests::residual_tests(&projected, data, model, values, excitation),
        memory: residual_tests::memory(&projected, data),
        shift: projected.shift.clone(),
    }
}
