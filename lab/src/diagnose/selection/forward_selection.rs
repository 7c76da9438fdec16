//! Which physics is missing: one effect after the other, until what is left is what the sensors leave.

use rayon::prelude::*;

use super::cross_validation::held_out;
use crate::diagnose::bootstrap::fitted_model::Stand;
use crate::diagnose::bootstrap::null_distribution::Null;
use crate::diagnose::bootstrap::problem::Study;
use crate::diagnose::estimation::levenberg_marquardt::{self, Data};
use crate::diagnose::estimation::projection::{Remainder, Score};
use crate::diagnose::estimation::residual_summary::View;
use crate::diagnose::model::{Model, Term};
use crate::effects::Stage;

/// An effect that was tried on a stand: fitted in full, and judged on data it did not see.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// What was added.
    pub term: Term,
    /// The stand's model with it.
    pub model: Model,
    /// Fitted values.
    pub values: Vec<f64>,
    /// Whitened energy that is left.
    pub energy: f64,
    /// The same on data that the fit did not see; infinite where that was not asked.
    pub held_out: f64,
    /// Power over the floor's there, of force and effort.
    pub powers: [f64; 2],
    /// Energy that it takes from twins, where nothing is missing.
    pub by_chance: f64,
    /// Probability of as much by chance, for it alone.
    pub p_value: f64,
    /// Probability of as much by chance, among all effects.
    pub p_any: f64,
}

/// What was found on one stand.
pub struct Round {
    /// Where it stood.
    pub stand: Stand,
    /// Held-out energy of the stand's own model.
    pub held_out: f64,
    /// Power over the floor's there, of force and effort.
    pub powers: [f64; 2],
    /// What was tried, the best first.
    pub candidates: Vec<Candidate>,
    /// Whether there is structure beyond chance, by shapes without a name, by energy or by memory.
    pub structure: Structure,
}

/// Structure beyond chance.
#[derive(Debug, Clone, Copy)]
pub struct Structure {
    /// Probability of as much by chance.
    pub p_value: f64,
    /// Whitened energy over what twins leave.
    pub energy_ratio: f64,
    /// What found it.
    pub found_by: &'static str,
}

/// The whole search.
pub struct Search {
    /// Stands in turn; the last is the answer's.
    pub rounds: Vec<Round>,
}

/// Twins a stand is judged by, and the rows that many of them can have.
const TWINS: usize = 40;
const TWIN_ROWS: f64 = 1.2e6;

/// Effects at most.
const MOST_EFFECTS: usize = 4;

/// Candidates that are judged on held-out data.
const JUDGED: usize = 8;

/// Probability of a false alarm on a stand.
pub const ALARM: f64 = 0.002;

/// Least size of an effect: share of the residual's root mean square, in a channel it reaches, on data that its fit did not
/// see.
const PRACTICAL: f64 = 0.2;

/// Share of the energy from which an effect is believed, whatever the encoder's steps may leave of force and of effort.
const CONVINCING: [f64; 2] = [0.25, 0.05];

/// Least share of the energy above the floor that a further effect has to take.
const WORTHWHILE: f64 = 0.12;

/// Runs the search, telling `say` how it goes.
pub fn search(study: &Study, say: &dyn Fn(&str)) -> Search {
    let mut model = study.nominal.clone();
    let mut values = study.first_fit();
    let mut rounds: Vec<Round> = Vec::new();
    loop {
        say(&format!("twins of the model with {}", names(&model)));
        let before = rounds.last().map(|round| round.stand.whitener.clone());
        let mut stand = study.stand(&model, &values, twins(study), before.as_ref());
        let mut round = round(study, stand, say);
        for _ in 0..2 {
            let Some(better) = reconverged(study, &round) else { break };
            stand = study.stand(&model, &better, twins(study), before.as_ref());
            round = self::round(study, stand, say);
        }
        let more = model.terms.len() < MOST_EFFECTS && is_worth_more(study, &rounds, &round);
        let next = if more { acceptable(study, &round) } else { None };
        let taken = next.map(|candidate| refined(study, &round.stand, candidate));
        rounds.push(round);
        let Some(taken) = taken else { break };
        (model, values) = taken;
    }
    Search { rounds }
}

/// Energy, beside the price of its parameters, that a rival or a finer form has to take to stand in a term's place.
pub const BETTER: f64 = 8.0;

/// Share of what lies above the floor that a finer form has to take.
const FINER: f64 = 0.25;

/// Model and values of `candidate`, or of a finer form of its effect that does better.
fn refined(study: &Study, stand: &Stand, candidate: &Candidate) -> (Model, Vec<f64>) {
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let remainder = Remainder::of(data, &stand.model, &stand.values, &stand.scene);
    let finer = |term: &Term| term.refines() && term.name() == candidate.term.name();
    // Far from the floor any bend takes a little: a corner that is round takes most of what the sharp one left.
    let left = (candidate.energy - mean(stand)).max(0.0);
    let own = candidate.energy + candidate.term.price() - BETTER - FINER * left;
    let scores = remainder.scores(&stand.scene, &finer);
    let fitted = scores.iter().map(|score| {
        let score = remainder.polished(score, &stand.scene);
        let model = stand.model.with(score.term);
        let fit = study.search_fit(&data, stand, &model, &score.values);
        (score.term, model, fit)
    });
    let better = fitted.filter(|(term, model, fit)| {
        fit.energy + term.price() < own
            && !levenberg_marquardt::is_at_limit(term, model.trials(), &fit.values, &stand.scene)
    });
    let best = better.min_by(|a, b| a.2.energy.total_cmp(&b.2.energy));
    best.map_or_else(|| (candidate.model.clone(), candidate.values.clone()), |(_, model, fit)| (model, fit.values))
}

/// Power over the floor's that is left once something is named, below which nothing further is looked for: a residual five
/// per cent above what the sensors leave.
const ENOUGH: f64 = 1.1;

/// Share of the power that the first effects took, below which what is left is the difference between a law and nature.
const LAW: f64 = 0.005;

/// Whether what `round` leaves is worth another effect.
fn is_worth_more(study: &Study, before: &[Round], round: &Round) -> bool {
    let Some(first) = before.first() else { return true };
    let (start, left) = (first.structure.energy_ratio, study.trusted_ratio(&round.stand));
    left > ENOUGH && left - 1.0 > LAW * (start - left)
}

/// Puts the last stand of `search` on `model` instead.
pub fn exchange(study: &Study, search: &mut Search, model: &Model, values: &[f64], say: &dyn Fn(&str)) {
    let before = search.rounds.pop().map(|round| round.stand.whitener);
    let stand = study.stand(model, values, twins(study), before.as_ref());
    let fresh = round(study, stand, say);
    search.rounds.push(fresh);
}

/// "coulomb_friction and gravity_load".
pub fn names(model: &Model) -> String {
    if model.terms.is_empty() {
        return "no effect".to_owned();
    }
    model.terms.iter().map(Term::name).collect::<Vec<_>>().join(" and ")
}

fn twins(study: &Study) -> usize {
    let rows: usize = study.studio.trials.iter().map(|trial| trial.contact.len() + trial.drive.len()).sum();
    ((TWIN_ROWS / rows.max(1) as f64) as usize).clamp(16, TWINS)
}

/// Energy over that of the stand's own values below which they were not the best.
const CONVERGED: f64 = 0.97;

/// Better values of the round's own model, where what its candidates made of them shows that there are any: a null that has
/// not converged is evidence for whatever moves it on.
fn reconverged(study: &Study, round: &Round) -> Option<Vec<f64>> {
    let stand = &round.stand;
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let own = data.energy(&stand.model, &stand.values);
    let starts: Vec<&[f64]> = round.candidates.iter().take(6).map(|c| &c.values[..stand.values.len()]).collect();
    let fits = starts.par_iter().map(|start| levenberg_marquardt::fit(&data, &stand.model, start, &stand.scene));
    let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy))?;
    (best.energy < CONVERGED * own).then_some(best.values)
}

fn round(study: &Study, stand: Stand, say: &dyn Fn(&str)) -> Round {
    let structure = structure(&stand);
    let held = held_out(study, &stand.whitener, &stand.model, &stand.values, &stand.scene);
    say("every effect in turn");
    let candidates = candidates(study, &stand);
    Round { stand, held_out: held.energy, powers: held.powers, candidates, structure }
}

/// Null distributions of `scores`, in their order.
fn nulls(stand: &Stand, scores: &[&Score]) -> Vec<Null> {
    let null = |score: &&Score| {
        let gains: Vec<f64> = stand.twins.iter().map(|twin| twin.gain(&score.term).unwrap_or(0.0)).collect();
        Null::of(&gains, 2.0)
    };
    scores.iter().map(null).collect()
}

/// The distribution, over twins, of the farthest that any of `scores` lies beyond its own.
fn farthest(stand: &Stand, scores: &[&Score], nulls: &[Null]) -> Null {
    let of = |twin: &View| {
        let beyond = scores.iter().zip(nulls).map(|(own, null)| null.beyond(twin.gain(&own.term).unwrap_or(0.0)));
        beyond.fold(f64::NEG_INFINITY, f64::max)
    };
    Null::of(&stand.twins.iter().map(of).collect::<Vec<_>>(), 1.0)
}

fn candidates(study: &Study, stand: &Stand) -> Vec<Candidate> {
    let scores: Vec<&Score> = stand.view.promising().collect();
    let nulls = nulls(stand, &scores);
    let farthest = farthest(stand, &scores, &nulls);
    // The promising are the best of all that were asked: as if each had been drawn that many times.
    let draws = stand.view.scores.len() as f64 / scores.len().max(1) as f64;
    let data = Data { trials: &study.studio.trials, whitener: &stand.whitener, rows: None };
    let remainder = Remainder::of(data, &stand.model, &stand.values, &stand.scene);
    let own = stand.view.energy;
    let mut fitted: Vec<Candidate> = scores
        .par_iter()
        .zip(&nulls)
        .map(|(score, null)| {
            let score = &remainder.polished(score, &stand.scene);
            let model = stand.model.with(score.term);
            let fit = study.search_fit(&data, stand, &model, &score.values);
            // Twins were asked by projection alone: a search that goes on from there is not held against them in full.
            let gain = score.gain.max(0.5 * (stand.view.energy - fit.energy));
            let p_any = among(farthest.p_value(null.beyond(gain)), draws);
            let p_value = null.p_value(gain);
            Candidate {
                term: score.term,
                model,
                values: fit.values,
                energy: fit.energy,
                held_out: f64::INFINITY,
                powers: [f64::INFINITY; 2],
                by_chance: by_chance(stand, &score.term) + hidden(&score.term) * (own - fit.energy).max(0.0),
                p_value,
                p_any,
            }
        })
        .collect();
    fitted.sort_by(|a, b| (a.energy + a.by_chance).total_cmp(&(b.energy + b.by_chance)));
    let judged = JUDGED.min(fitted.len());
    fitted[..judged].par_iter_mut().for_each(|candidate| {
        let held = held_out(study, &stand.whitener, &candidate.model, &candidate.values, &stand.scene);
        (candidate.held_out, candidate.powers) = (held.energy, held.powers);
    });
    fitted.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    fitted
}

/// Held-out energy, and what a value more has to earn before it is believed over a simpler law.
fn rank(candidate: &Candidate) -> f64 {
    let free = candidate.term.parameters().iter().filter(|parameter| !parameter.fixed).count();
    candidate.held_out + 4.0 * free as f64 + 1.5 * candidate.by_chance
}

/// Share of its gain that is not believed of an effect: a hidden motor behind a link can follow much that is none.
pub fn hidden(term: &Term) -> f64 {
    if term.effect.card().stage == Stage::Transmission { 0.15 } else { 0.0 }
}

/// The probability that the least of `draws` is as small as `p_value`.
fn among(p_value: f64, draws: f64) -> f64 {
    -(draws * (-p_value).ln_1p()).exp_m1()
}

/// Mean energy that `term` takes from twins: where they were not asked, that of white noise.
pub fn by_chance(stand: &Stand, term: &Term) -> f64 {
    let gains: Vec<f64> = stand.twins.iter().filter_map(|twin| twin.gain(term)).collect();
    if gains.is_empty() {
        return term.parameters().iter().filter(|parameter| !parameter.fixed).count() as f64;
    }
    gains.iter().sum::<f64>() / stand.twins.len() as f64
}

/// The best candidate of a round, if it is beyond chance and large enough to matter.
fn acceptable<'a>(study: &Study, round: &'a Round) -> Option<&'a Candidate> {
    let [force, effort] = study.doubtful(&round.stand);
    let left = round.stand.view.energy;
    let above = (left - mean(&round.stand)).max(0.0);
    let able = |candidate: &&Candidate| {
        let gain = left - candidate.energy - candidate.by_chance;
        // What the encoder's steps leave follows no law: one that takes so much of it is no rounding.
        let convincing = CONVINCING.map(|share| gain > share * left && candidate.p_any < ALARM * ALARM);
        let model = &candidate.model;
        candidate.p_any < ALARM
            && !levenberg_marquardt::is_at_limit(&candidate.term, model.trials(), &candidate.values, &round.stand.scene)
            && candidate.held_out < round.held_out
            && is_practical(round, [force && !convincing[0], effort && !convincing[1]], candidate)
            && gain > WORTHWHILE * above
            && is_shown(study, candidate)
    };
    round.candidates.iter().find(able)
}

/// Whether the recordings, as its own fit sees them, show what `candidate` is told by: a surface that was moved until nothing is
/// free any more says nothing of the sensor's zero.
fn is_shown(study: &Study, candidate: &Candidate) -> bool {
    let (effect, form) = (candidate.term.effect, candidate.term.form);
    let scene = study.scene(&candidate.model, &candidate.values);
    !effect.starts(form, &scene).is_empty() || effect.tones(form, &scene).is_some()
}

/// Whether `candidate` is large enough to matter: it takes something where there is more than twins leave, and where that
/// is not the encoder's.
fn is_practical(round: &Round, doubtful: [bool; 2], candidate: &Candidate) -> bool {
    let ratios = round.stand.power_ratios();
    (0..2).any(|channel| {
        !doubtful[channel]
            && ratios[channel] > 1.0
            && candidate.powers[channel] < (1.0 - PRACTICAL * PRACTICAL) * round.powers[channel]
    })
}

/// Mean energy that twins leave.
pub fn mean(stand: &Stand) -> f64 {
    stand.twins.iter().map(|view| view.energy).sum::<f64>() / stand.twins.len().max(1) as f64
}

fn structure(stand: &Stand) -> Structure {
    let figures = |view: &View| {
        let mut all: Vec<(&'static str, f64)> = view.textures.iter().map(|t| (t.name, t.gain)).collect();
        all.push(("the power of the force", 1e3 * view.powers[0]));
        all.push(("the power of the effort", 1e3 * view.powers[1]));
        all.push(("memory", view.memory));
        all
    };
    let own = figures(&stand.view);
    let twins: Vec<_> = stand.twins.iter().map(figures).collect();
    let nulls: Vec<Null> =
        (0..own.len()).map(|at| Null::of(&twins.iter().map(|twin| twin[at].1).collect::<Vec<_>>(), 2.0)).collect();
    let most = |all: &[(&'static str, f64)]| {
        let beyond = all.iter().zip(&nulls).map(|((name, figure), null)| (*name, null.beyond(*figure)));
        beyond.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("nothing", 0.0))
    };
    let null = Null::of(&twins.iter().map(|twin| most(twin).1).collect::<Vec<_>>(), 1.0);
    let (found_by, beyond) = most(&own);
    Structure { p_value: null.p_value(beyond), energy_ratio: stand.power_ratio(), found_by }
}
