//! What a model leaves of a recording or a twin, and what effects could take of it.

use super::levenberg_marquardt::Data;
use super::projection::{Remainder, Score};
use super::residual_tests::{self, Texture};
use super::whitener::Whitener;
use crate::diagnose::model::{Channels, Model, Term};
use crate::diagnose::signals::filtered_trial::Trial;
use crate::effects::Scene;

/// What a model leaves of one set of trials, a recording or a twin.
#[derive(Debug, Clone)]
pub struct View {
    /// Whitened energy, once the model's own values have taken theirs.
    pub energy: f64,
    /// Mean square of the residual over its floor, before its memory is taken off, of force and effort: one where all is noise.
    pub powers: [f64; 2],
    /// What each effect could take; of a twin, the effects that are promising on the recording.
    pub scores: Vec<Score>,
    /// What shapes without a name could take.
    pub textures: Vec<Texture>,
    /// How much the rest remembers itself.
    pub memory: f64,
    /// By how much the model's values would have to move to fit these trials best.
    pub shift: Vec<f64>,
}

/// Effects that are worth a closer look, on the recording and on its twins.
const PROMISING: usize = 16;

impl View {
    /// The scores that are worth a closer look, the greatest first.
    pub fn promising(&self) -> impl Iterator<Item = &Score> {
        let mut scores: Vec<&Score> = self.scores.iter().collect();
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores.into_iter().take(PROMISING)
    }

    /// What `term` could take; `None` where that was not asked.
    #[must_use]
    pub fn gain(&self, term: &Term) -> Option<f64> {
        self.scores.iter().find(|score| score.term.is(term)).map(|score| score.gain)
    }
}

/// What `model` with `values` leaves of `trials`; `asked` says which effects are asked what they could take.
#[must_use]
pub fn view(
    trials: &[Trial],
    whitener: &Whitener,
    model: &Model,
    values: &[f64],
    scene: &Scene,
    asked: &dyn Fn(&Term) -> bool,
) -> View {
    let data = Data { trials, whitener, rows: None };
    let remainder = Remainder::of(data, model, values, scene);
    let forgetful = whitener.forgetful();
    let plain = Data { trials, whitener: &forgetful, rows: None }.residual(model, values, Channels::BOTH);
    View {
        powers: whitener.powers(&plain),
        energy: remainder.energy(),
        scores: remainder.scores(scene, asked),
        textures: residual_tests::textures(&remainder, data, model, values, scene),
        memory: residual_tests::memory(&remainder, data),
        shift: remainder.shift.clone(),
    }
}
