//! From the search to the verdict: what is named, what is left, what cannot be told apart.

use rayon::prelude::*;

use serde::Serialize;

use super::cross_validation::{self, HeldOut};
use super::forward_selection::{self, ALARM, Round, Search};
use crate::diagnose::bootstrap::fitted_model::Stand;
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data, Fit};
use crate::diagnose::estimation::projection::Remainder;
use crate::diagnose::model::{Model, Term, index};
use crate::effects::Place;

/// What came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The simulation as given leaves what the sensors leave.
    NoMismatch,
    /// Other values, no other physics.
    Parameters,
    /// Named, and nothing is left.
    Explained,
    /// Named, and something is left.
    PartlyExplained,
    /// Something is missing that no effect of the list explains.
    Unknown,
}

/// What came out of a search.
pub struct Judgement {
    /// In a word.
    pub verdict: Verdict,
    /// The named effects, in order of evidence; empty unless the verdict is explained or partly so.
    pub named: Vec<Named>,
    /// What this data cannot tell from each of the named.
    pub rivals: Vec<Rival>,
    /// Share of the whitened energy above the floor that the named effects take.
    pub share: f64,
    /// Whether structure is left.
    pub left: bool,
    /// The nominal model, fitted under the last stand's floor.
    pub nominal: Fit,
    /// The rig file as given, without a fit.
    pub as_given: HeldOut,
    /// The nominal model on data it did not see.
    pub refitted: HeldOut,
    /// The last stand's model on data it did not see.
    pub improved: HeldOut,
}

/// A named effect.
#[derive(Debug, Clone)]
pub struct Named {
    /// Which.
    pub term: Term,
    /// Its place among the terms of the last model.
    pub at: usize,
    /// Probability of as much by chance among all effects.
    pub p_value: f64,
    /// Whitened energy that is there without it.
    pub gain: f64,
    /// The model without it on data it did not see.
    pub without: HeldOut,
}

/// What this data cannot tell from the answer.
#[derive(Debug, Clone)]
pub struct Rival {
    /// The effect that it would stand for.
    pub instead_of: Term,
    /// The rival.
    pub term: Term,
    /// Model and values with the rival in its place.
    pub model: Model,
    /// Fitted values of that model.
    pub fit: Fit,
    /// Energy that it takes by chance, beyond what the effect that it would stand for takes by chance.
    pub chance: f64,
}

/// Share of the energy above the floor that named effects have to take where something is left beside them.
const MOSTLY: f64 = 0.7;

/// Least excess of energy, over what twins leave, that is called structure.
const NOTABLE: f64 = 0.015;

/// Least power over the floor's that is called structure: a residual a seventh above what the sensors leave. What a contact
/// begins and ends with is only known to about a tenth.
const BEYOND: f64 = 1.3;

/// Root mean square over the floor's beyond which something is left, whatever its pattern.
const FAR: f64 = 2.0;

/// Growth of the root mean square from refitted to given values that is called a wrong value.
const WRONG_VALUES: f64 = 1.05;

/// Growth of the root mean square on unseen data in either channel that no explanation may bring.
const WORSE: f64 = 1.05;

/// Share of what is left without it on unseen data, of its power or of its whitened energy above what twins leave, that an effect
/// beside others has to take where structure is left.
const SUPPORTED: f64 = 0.25;

/// The same of its power where much is left: it has to halve it.
const HALF: f64 = 0.5;

/// Energy by which a rival may stand behind, for chance: 12 of a white energy is a probability of 5e-4 for one value.
const CLOSE: f64 = 12.0;

/// Share of an effect's own energy by which a rival may stand behind: laws are never quite those of nature.
const ALIKE: f64 = 0.06;

/// Rivals that are fitted in full.
const TRIED: usize = 10;

/// Judges `search`; exchanges an effect for a rival that does better.
pub fn judge(study: &Study, search: &mut Search, say: &dyn Fn(&str)) -> Option<Judgement> {
    say("what else would explain it");
    let rivals = settled(study, search, say)?;
    let last = search.rounds.last()?;
    let stand = &last.stand;
    let nominal = study.fit(&study.nominal, &search.rounds.first()?.stand.values, &stand.whitener);
    let taken = (nominal.energy - forward_selection::mean(stand)).max(f64::MIN_POSITIVE);
    let share = ((nominal.energy - stand.view.energy) / taken).clamp(0.0, 1.0);
    let held =
        |model: &Model, values: &[f64]| cross_validation::held_out(study, &stand.whitener, model, values, &stand.scene);
    let (refitted, improved) = (held(&study.nominal, &nominal.values), held(&stand.model, &stand.values));
    let left = is_left(study, last, &improved);
    let verdict = match (stand.model.terms.len() == study.nominal.terms.len(), left) {
        (true, true) => Verdict::Unknown,
        (true, false) if wrong_values(study, stand, nominal.energy) => Verdict::Parameters,
        (true, false) => Verdict::NoMismatch,
        (false, _) if is_worse(study, &refitted, &improved) => Verdict::Unknown,
        (false, false) => Verdict::Explained,
        (false, true) if share >= MOSTLY => Verdict::PartlyExplained,
        (false, true) => Verdict::Unknown,
    };
    let is_named = matches!(verdict, Verdict::Explained | Verdict::PartlyExplained);
    let named = if is_named { named(study, search) } else { Vec::new() };
    let rivals = if is_named { close(stand, &named, rivals) } else { Vec::new() };
    let left = left || verdict == Verdict::Unknown;
    let as_given = cross_validation::as_given(study, &stand.whitener, &study.nominal, &study.given);
    Some(Judgement { verdict, named, rivals, share, left, nominal, as_given, refitted, improved })
}

/// Exchanges effects for rivals that do better, takes off those that are not needed; what then could stand for each.
fn settled(study: &Study, search: &mut Search, say: &dyn Fn(&str)) -> Option<Vec<Rival>> {
    let mut rivals = Vec::new();
    for _ in 0..3 {
        rivals = rivals_of(study, search);
        let stand = &search.rounds.last()?.stand;
        let better = rivals
            .iter()
            .filter(|rival| worth(rival) + forward_selection::BETTER < stand.view.energy + rival.instead_of.price());
        let shown = |rival: &&Rival| {
            !levenberg_marquardt::is_at_limit(&rival.term, rival.model.trials(), &rival.fit.values, &stand.scene)
        };
        let better = better.filter(shown);
        let Some(better) = better.min_by(|a, b| worth(a).total_cmp(&worth(b))).cloned() else { break };
        say(&format!("{} explains more than {}", better.term.name(), better.instead_of.name()));
        forward_selection::exchange(study, search, &better.model, &better.fit.values, say);
    }
    if pruned(study, search, say) {
        rivals = rivals_of(study, search);
    }
    Some(rivals)
}

/// Whether the model of the last `round` leaves structure, on data that it did not see (`improved`).
fn is_left(study: &Study, round: &Round, improved: &HeldOut) -> bool {
    let stand = &round.stand;
    let texture = stand.view.textures.iter().map(|texture| texture.gain).fold(0.0, f64::max);
    let excess =
        (stand.view.energy - forward_selection::mean(stand)).max(texture) / stand.view.energy.max(f64::MIN_POSITIVE);
    // What twins leave can differ in its pattern; where it is no larger, nothing that matters is left.
    let beyond = round.structure.p_value < ALARM && excess > NOTABLE;
    let (doubts, doubtful) = (study.doubts(&stand.values), study.doubtful(stand));
    [false, true].into_iter().zip(stand.power_ratios()).any(|(effort, ratio)| {
        let Some(floor) = cross_validation::floor(study, &stand.whitener, effort) else { return false };
        let times = cross_validation::rms(study, &improved.rests, effort) / floor.max(f64::MIN_POSITIVE);
        let channel = usize::from(effort);
        times > FAR.max(doubts[channel].sqrt()) || times > 1.0 && !doubtful[channel] && ratio > BEYOND && beyond
    })
}

/// Whether an explanation makes unseen data worse, whatever it does to seen ones.
fn is_worse(study: &Study, refitted: &HeldOut, improved: &HeldOut) -> bool {
    let rms = |held: &HeldOut, effort| cross_validation::rms(study, &held.rests, effort);
    let grown = |effort| rms(improved, effort) > WORSE * rms(refitted, effort);
    improved.energy > refitted.energy || grown(false) || grown(true)
}

/// Takes off, the least first, effects beside others without which unseen data are left as well or nearly so; whether there were
/// any.
///
/// Where the residual is far from the floor any bend of a curve takes something of it, and each effect that was taken up may
/// since have lost what it was taken up for.
fn pruned(study: &Study, search: &mut Search, say: &dyn Fn(&str)) -> bool {
    let mut any = false;
    while let Some(idle) = search.rounds.last().and_then(|round| idle(study, &round.stand)) {
        say(&format!("without {}, which takes next to nothing", idle.term.name()));
        forward_selection::exchange(study, search, &idle.model, &idle.values, say);
        any = true;
    }
    any
}

/// An effect that is not needed.
struct Idle {
    term: Term,
    /// The model without it.
    model: Model,
    /// Fitted values of that.
    values: Vec<f64>,
}

/// The effect of several that takes the least of unseen data, if that is too little.
fn idle(study: &Study, stand: &Stand) -> Option<Idle> {
    let known = study.nominal.terms.len();
    if stand.model.terms.len() < known + 2 {
        return None;
    }
    let ratio = study.trusted_ratio(stand);
    let (far, enough) = match ratio {
        _ if ratio > FAR * FAR => (true, HALF),
        _ if ratio > BEYOND => (false, SUPPORTED),
        _ => (false, 0.0),
    };
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let held =
        |model: &Model, values: &[f64]| cross_validation::held_out(study, &stand.whitener, model, values, &stand.scene);
    let (with, floor) = (held(&stand.model, &stand.values), forward_selection::mean(stand));
    let taken = (known..stand.model.terms.len()).into_par_iter().map(|at| {
        let term = stand.model.terms[at];
        let (model, values) = without(&stand.model, &stand.values, at);
        let values = levenberg_marquardt::fit(&data, &model, &values, &stand.scene).values;
        let without = held(&model, &values);
        let gone = cross_validation::gone(study, &without, &with, term.effect.card().place);
        let white = (without.energy - with.energy) / (without.energy - floor).max(f64::MIN_POSITIVE);
        (if far { gone } else { gone.max(white) }, Idle { term, model, values })
    });
    taken.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gone, _)| *gone < enough).map(|(_, idle)| idle)
}

/// Whether the given values leave more than the fitted ones, beyond an encoder's start within its step.
fn wrong_values(study: &Study, stand: &Stand, fitted: f64) -> bool {
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let half = 0.5 * study.studio.raws.iter().map(|raw| raw.figures.position.resolution).fold(0.0, f64::max);
    let moved = stand.values[index::SURFACE] - study.given[index::SURFACE];
    let mut values = study.given.clone();
    // Timings and where each trial's encoder starts are no values of the rig file.
    for at in [index::FORCE_TIMING, index::EFFORT_TIMING].into_iter().chain(index::SHARED..study.nominal.nominals()) {
        values[at] = stand.values[at];
    }
    values[index::SURFACE] += moved.clamp(-half, half);
    let given = data.energy(&study.nominal, &values);
    given > WRONG_VALUES * WRONG_VALUES * fitted && given > fitted + 30.0
}

fn worth(rival: &Rival) -> f64 {
    rival.fit.energy + rival.term.price() + 1.5 * rival.chance
}

/// Every effect in the place of each term of `stand`'s model, fitted.
fn rivals_of(study: &Study, search: &Search) -> Vec<Rival> {
    let (Some(first), Some(last)) = (search.rounds.first(), search.rounds.last()) else { return Vec::new() };
    let stand = &last.stand;
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let mut rivals = Vec::new();
    for at in study.nominal.terms.len()..stand.model.terms.len() {
        let (base, values) = without(&stand.model, &stand.values, at);
        let fitted = levenberg_marquardt::fit(&data, &base, &values, &stand.scene);
        let remainder = Remainder::of(data, &base, &fitted.values, &stand.scene);
        let mut scores = remainder.scores(&stand.scene, &|term| !term.refines());
        scores.retain(|score| base.terms.iter().all(|term| term.name() != score.term.name()));
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores.truncate(TRIED);
        let own = stand.model.terms[at];
        // What was not looked into does not explain the other channel.
        let drive = |term: &Term| term.effect.card().place == Place::Drive;
        if drive(&own) && study.doubtful(stand)[0] {
            scores.retain(|score| drive(&score.term));
        }
        let tried = scores.par_iter().filter(|score| !score.term.is(&own));
        rivals.par_extend(tried.map(|score| {
            let model = base.with(score.term);
            let start: Vec<f64> = fitted.values.iter().chain(&score.values).copied().collect();
            let fit = levenberg_marquardt::fit(&data, &model, &start, &stand.scene);
            let taken = (fitted.energy - fit.energy).max(0.0);
            let chance = |term: &Term| {
                forward_selection::by_chance(&first.stand, term) + forward_selection::hidden(term) * taken
            };
            let chance = chance(&score.term) - chance(&own);
            Rival { instead_of: own, term: score.term, model, fit, chance }
        }));
    }
    rivals
}

/// A model without one of its terms.
fn without(model: &Model, values: &[f64], at: usize) -> (Model, Vec<f64>) {
    let mut fewer = model.clone();
    let term = fewer.terms.remove(at);
    let start = model.start_of(at);
    let mut kept = values.to_vec();
    kept.drain(start..start + term.all_parameters(model.trials()).len());
    (fewer, kept)
}

fn named(study: &Study, search: &Search) -> Vec<Named> {
    let Some(last) = search.rounds.last() else { return Vec::new() };
    let stand = &last.stand;
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let mut named: Vec<Named> = (study.nominal.terms.len()..stand.model.terms.len())
        .into_par_iter()
        .map(|at| {
            let term = stand.model.terms[at];
            let (base, values) = without(&stand.model, &stand.values, at);
            let fitted = levenberg_marquardt::fit(&data, &base, &values, &stand.scene);
            let without = cross_validation::held_out(study, &stand.whitener, &base, &fitted.values, &stand.scene);
            // The round in which it was found, or the one whose choice it replaced.
            let found =
                search.rounds.iter().flat_map(|round| &round.candidates).filter(|c| c.term.name() == term.name());
            let p_value = found.map(|candidate| candidate.p_any).fold(f64::INFINITY, f64::min).min(ALARM);
            Named { term, at, p_value, gain: fitted.energy - stand.view.energy, without }
        })
        .collect();
    named.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    named
}

/// Those rivals that the data do not refute; one an effect.
fn close(stand: &Stand, named: &[Named], mut rivals: Vec<Rival>) -> Vec<Rival> {
    let rows: f64 = stand.whitener.origins().len() as f64;
    let inflation = (forward_selection::mean(stand) / rows.max(1.0)).max(1.0);
    rivals.sort_by(|a, b| a.fit.energy.total_cmp(&b.fit.energy));
    let mut kept: Vec<Rival> = Vec::new();
    for rival in rivals {
        let gain = named.iter().find(|n| n.term.name() == rival.instead_of.name()).map_or(0.0, |n| n.gain);
        let margin = CLOSE * inflation + ALIKE * gain;
        let other = named.iter().all(|n| n.term.name() != rival.term.name());
        let fresh = kept.iter().all(|k| k.term.name() != rival.term.name());
        // What leaves almost as much as nothing at all is no rival.
        let explains = rival.fit.energy < stand.view.energy + 0.7 * gain;
        if other && fresh && explains && rival.fit.energy - stand.view.energy < margin {
            kept.push(rival);
        }
    }
    kept
}
