//! Which physics is missing: one effect after the other, until what is left is what the sensors leave.

use rayon::prelude::*;

use super::cross_validation::cross_validate;
use crate::diagnose::bootstrap::fitted_model::FittedModel;
use crate::diagnose::bootstrap::null_distribution::NullDistribution;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData};
use crate::diagnose::estimation::projection::{EffectScore, ProjectedResidual};
use crate::diagnose::estimation::residual_summary::ResidualSummary;
use crate::diagnose::model::{Model, Term};
use crate::diagnose::thresholds::forward_selection::{
    CONVINCING_FRACTION, MAX_CROSS_VALIDATED, MAX_EFFECTS, MAX_REPLICATES, MIN_EFFECT_RMS_FRACTION, MIN_GAIN_FRACTION,
    MIN_REFINED_FORM_GAIN, MIN_REMAINING_FRACTION, RECONVERGENCE_RATIO, REPLICATE_ROW_BUDGET, SUFFICIENT_POWER_RATIO,
};
pub use crate::diagnose::thresholds::forward_selection::{FALSE_ALARM_RATE, REPLACEMENT_CHI2_MARGIN};
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
    /// Power over the expected noise's there, of force and effort.
    pub powers: [f64; 2],
    /// Energy that it takes from replicates, where nothing is missing.
    pub chance_gain: f64,
    /// Probability of as much by chance, for it alone.
    pub p_value: f64,
    /// Probability of as much by chance, among all effects.
    pub p_any: f64,
}

/// What was found on one stand.
pub struct SelectionStep {
    /// Where it stood.
    pub fitted_model: FittedModel,
    /// Held-out energy of the stand's own model.
    pub held_out: f64,
    /// Power over the expected noise's there, of force and effort.
    pub powers: [f64; 2],
    /// What was tried, the best first.
    pub candidates: Vec<Candidate>,
    /// Whether there is structure beyond chance, by shapes without a name, by energy or by memory.
    pub structure: RemainingStructure,
}

/// Structure beyond chance.
#[derive(Debug, Clone, Copy)]
pub struct RemainingStructure {
    /// Probability of as much by chance.
    pub p_value: f64,
    /// Whitened energy over what replicates leave.
    pub energy_ratio: f64,
    /// What found it.
    pub found_by: &'static str,
}

/// The whole search.
pub struct SelectionPath {
    /// Stands in turn; the last is the answer's.
    pub rounds: Vec<SelectionStep>,
}

/// Runs the search, telling `say` how it goes.
pub fn search(problem: &IdentificationProblem, say: &dyn Fn(&str)) -> SelectionPath {
    let mut model = problem.nominal.clone();
    let mut values = problem.initial_fit();
    let mut rounds: Vec<SelectionStep> = Vec::new();
    loop {
        say(&format!("twins of the model with {}", effect_names(&model)));
        let before = rounds.last().map(|round| round.fitted_model.whitener.clone());
        let mut fitted_model = problem.fit_with_replicates(&model, &values, replicate_count(problem), before.as_ref());
        let mut round = round(problem, fitted_model, say);
        for _ in 0..2 {
            let Some(better) = reconverge(problem, &round) else { break };
            fitted_model = problem.fit_with_replicates(&model, &better, replicate_count(problem), before.as_ref());
            round = self::round(problem, fitted_model, say);
        }
        let more = model.terms.len() < MAX_EFFECTS && is_worth_more(problem, &rounds, &round);
        let next = if more { acceptable(problem, &round) } else { None };
        let taken = next.map(|candidate| refine_form(problem, &round.fitted_model, candidate));
        rounds.push(round);
        let Some(taken) = taken else { break };
        (model, values) = taken;
    }
    SelectionPath { rounds }
}

/// Model and values of `candidate`, or of a finer form of its effect that does better.
fn refine_form(
    problem: &IdentificationProblem,
    fitted_model: &FittedModel,
    candidate: &Candidate,
) -> (Model, Vec<f64>) {
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let projected = ProjectedResidual::of(data, &fitted_model.model, &fitted_model.values, &fitted_model.excitation);
    let finer = |term: &Term| term.refines() && term.name() == candidate.term.name();
    // Far from the expected noise any bend takes a little: a corner that is round takes most of what the sharp one left.
    let left = (candidate.energy - mean_replicate_energy(fitted_model)).max(0.0);
    let own = candidate.energy + candidate.term.price() - REPLACEMENT_CHI2_MARGIN - MIN_REFINED_FORM_GAIN * left;
    let scores = projected.scores(&fitted_model.excitation, &finer);
    let fitted = scores.iter().map(|score| {
        let score = projected.refine_start(score, &fitted_model.excitation);
        let model = fitted_model.model.with(score.term);
        let fit = problem.fit_from_surfaces(&data, fitted_model, &model, &score.values);
        (score.term, model, fit)
    });
    let better = fitted.filter(|(term, model, fit)| {
        fit.energy + term.price() < own
            && !levenberg_marquardt::is_at_limit(term, model.trials(), &fit.values, &fitted_model.excitation)
    });
    let best = better.min_by(|a, b| a.2.energy.total_cmp(&b.2.energy));
    best.map_or_else(|| (candidate.model.clone(), candidate.values.clone()), |(_, model, fit)| (model, fit.values))
}

/// Whether what `round` leaves is worth another effect.
fn is_worth_more(problem: &IdentificationProblem, before: &[SelectionStep], round: &SelectionStep) -> bool {
    let Some(first) = before.first() else { return true };
    let (start, left) = (first.structure.energy_ratio, problem.trusted_ratio(&round.fitted_model));
    left > SUFFICIENT_POWER_RATIO && left - 1.0 > MIN_REMAINING_FRACTION * (start - left)
}

/// Puts the last stand of `search` on `model` instead.
pub fn replace_model(
    problem: &IdentificationProblem,
    search: &mut SelectionPath,
    model: &Model,
    values: &[f64],
    say: &dyn Fn(&str),
) {
    let before = search.rounds.pop().map(|round| round.fitted_model.whitener);
    let fitted_model = problem.fit_with_replicates(model, values, replicate_count(problem), before.as_ref());
    let fresh = round(problem, fitted_model, say);
    search.rounds.push(fresh);
}

/// "coulomb_friction and gravity_load".
pub fn effect_names(model: &Model) -> String {
    if model.terms.is_empty() {
        return "no effect".to_owned();
    }
    model.terms.iter().map(Term::name).collect::<Vec<_>>().join(" and ")
}

fn replicate_count(problem: &IdentificationProblem) -> usize {
    let rows: usize = problem.sampler.trials.iter().map(|trial| trial.contact.len() + trial.drive.len()).sum();
    ((REPLICATE_ROW_BUDGET / rows.max(1) as f64) as usize).clamp(16, MAX_REPLICATES)
}

/// Better values of the round's own model, where what its candidates made of them shows that there are any: a null that has
/// not converged is evidence for whatever moves it on.
fn reconverge(problem: &IdentificationProblem, round: &SelectionStep) -> Option<Vec<f64>> {
    let fitted_model = &round.fitted_model;
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let own = data.energy(&fitted_model.model, &fitted_model.values);
    let starts: Vec<&[f64]> = round.candidates.iter().take(6).map(|c| &c.values[..fitted_model.values.len()]).collect();
    let fits = starts
        .par_iter()
        .map(|start| levenberg_marquardt::fit(&data, &fitted_model.model, start, &fitted_model.excitation));
    let best = fits.min_by(|a, b| a.energy.total_cmp(&b.energy))?;
    (best.energy < RECONVERGENCE_RATIO * own).then_some(best.values)
}

fn round(problem: &IdentificationProblem, fitted_model: FittedModel, say: &dyn Fn(&str)) -> SelectionStep {
    let structure = remaining_structure(&fitted_model);
    let held = cross_validate(
        problem,
        &fitted_model.whitener,
        &fitted_model.model,
        &fitted_model.values,
        &fitted_model.excitation,
    );
    say("every effect in turn");
    let candidates = candidates(problem, &fitted_model);
    SelectionStep { fitted_model, held_out: held.energy, powers: held.powers, candidates, structure }
}

/// Null distributions of `scores`, in their order.
fn null_distributions(fitted_model: &FittedModel, scores: &[&EffectScore]) -> Vec<NullDistribution> {
    let null = |score: &&EffectScore| {
        let gains: Vec<f64> =
            fitted_model.replicates.iter().map(|replicate| replicate.gain(&score.term).unwrap_or(0.0)).collect();
        NullDistribution::of(&gains, 2.0)
    };
    scores.iter().map(null).collect()
}

/// The distribution, over replicates, of the farthest that any of `scores` lies beyond its own.
fn max_deviation_null(
    fitted_model: &FittedModel,
    scores: &[&EffectScore],
    nulls: &[NullDistribution],
) -> NullDistribution {
    let of = |replicate: &ResidualSummary| {
        let beyond = scores.iter().zip(nulls).map(|(own, null)| null.beyond(replicate.gain(&own.term).unwrap_or(0.0)));
        beyond.fold(f64::NEG_INFINITY, f64::max)
    };
    NullDistribution::of(&fitted_model.replicates.iter().map(of).collect::<Vec<_>>(), 1.0)
}

fn candidates(problem: &IdentificationProblem, fitted_model: &FittedModel) -> Vec<Candidate> {
    let scores: Vec<&EffectScore> = fitted_model.summary.promising().collect();
    let nulls = null_distributions(fitted_model, &scores);
    let farthest = max_deviation_null(fitted_model, &scores, &nulls);
    // The promising are the best of all that were asked: as if each had been drawn that many times.
    let draws = fitted_model.summary.scores.len() as f64 / scores.len().max(1) as f64;
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let projected = ProjectedResidual::of(data, &fitted_model.model, &fitted_model.values, &fitted_model.excitation);
    let own = fitted_model.summary.energy;
    let mut fitted: Vec<Candidate> = scores
        .par_iter()
        .zip(&nulls)
        .map(|(score, null)| {
            let score = &projected.refine_start(score, &fitted_model.excitation);
            let model = fitted_model.model.with(score.term);
            let fit = problem.fit_from_surfaces(&data, fitted_model, &model, &score.values);
            // Replicates were asked by projection alone: a search that goes on from there is not held against them in full.
            let gain = score.gain.max(0.5 * (fitted_model.summary.energy - fit.energy));
            let p_any = sidak_correction(farthest.p_value(null.beyond(gain)), draws);
            let p_value = null.p_value(gain);
            Candidate {
                term: score.term,
                model,
                values: fit.values,
                energy: fit.energy,
                held_out: f64::INFINITY,
                powers: [f64::INFINITY; 2],
                chance_gain: chance_gain(fitted_model, &score.term)
                    + transmission_discount(&score.term) * (own - fit.energy).max(0.0),
                p_value,
                p_any,
            }
        })
        .collect();
    fitted.sort_by(|a, b| (a.energy + a.chance_gain).total_cmp(&(b.energy + b.chance_gain)));
    let judged = MAX_CROSS_VALIDATED.min(fitted.len());
    fitted[..judged].par_iter_mut().for_each(|candidate| {
        let held = cross_validate(
            problem,
            &fitted_model.whitener,
            &candidate.model,
            &candidate.values,
            &fitted_model.excitation,
        );
        (candidate.held_out, candidate.powers) = (held.energy, held.powers);
    });
    fitted.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    fitted
}

/// Held-out energy, and what a value more has to earn before it is believed over a simpler law.
fn rank(candidate: &Candidate) -> f64 {
    let free = candidate.term.parameters().iter().filter(|parameter| !parameter.fixed).count();
    candidate.held_out + 4.0 * free as f64 + 1.5 * candidate.chance_gain
}

/// Share of its gain that is not believed of an effect: a hidden motor behind a link can follow much that is none.
pub fn transmission_discount(term: &Term) -> f64 {
    if term.effect.spec().stage == Stage::Transmission { 0.15 } else { 0.0 }
}

/// The probability that the least of `draws` is as small as `p_value`.
fn sidak_correction(p_value: f64, draws: f64) -> f64 {
    -(draws * (-p_value).ln_1p()).exp_m1()
}

/// Mean energy that `term` takes from replicates: where they were not asked, that of white noise.
pub fn chance_gain(fitted_model: &FittedModel, term: &Term) -> f64 {
    let gains: Vec<f64> = fitted_model.replicates.iter().filter_map(|replicate| replicate.gain(term)).collect();
    if gains.is_empty() {
        return term.parameters().iter().filter(|parameter| !parameter.fixed).count() as f64;
    }
    gains.iter().sum::<f64>() / fitted_model.replicates.len() as f64
}

/// The best candidate of a round, if it is beyond chance and large enough to matter.
fn acceptable<'a>(problem: &IdentificationProblem, round: &'a SelectionStep) -> Option<&'a Candidate> {
    let [force, effort] = problem.within_quantization(&round.fitted_model);
    let left = round.fitted_model.summary.energy;
    let above = (left - mean_replicate_energy(&round.fitted_model)).max(0.0);
    let able = |candidate: &&Candidate| {
        let gain = left - candidate.energy - candidate.chance_gain;
        // What the encoder's steps leave follows no law: one that takes so much of it is no rounding.
        let convincing = CONVINCING_FRACTION
            .map(|share| gain > share * left && candidate.p_any < FALSE_ALARM_RATE * FALSE_ALARM_RATE);
        let model = &candidate.model;
        candidate.p_any < FALSE_ALARM_RATE
            && !levenberg_marquardt::is_at_limit(
                &candidate.term,
                model.trials(),
                &candidate.values,
                &round.fitted_model.excitation,
            )
            && candidate.held_out < round.held_out
            && is_large_enough(round, [force && !convincing[0], effort && !convincing[1]], candidate)
            && gain > MIN_GAIN_FRACTION * above
            && is_identifiable(problem, candidate)
    };
    round.candidates.iter().find(able)
}

/// Whether the recordings, as its own fit sees them, show what `candidate` is told by: a surface that was moved until nothing is
/// free any more says nothing of the sensor's zero.
fn is_identifiable(problem: &IdentificationProblem, candidate: &Candidate) -> bool {
    let (effect, form) = (candidate.term.effect, candidate.term.form);
    let excitation = problem.excitation_stats(&candidate.model, &candidate.values);
    !effect.starts(form, &excitation).is_empty() || effect.frequency_search(form, &excitation).is_some()
}

/// Whether `candidate` is large enough to matter: it takes something where there is more than replicates leave, and where that
/// is not the encoder's.
fn is_large_enough(round: &SelectionStep, within_quantization: [bool; 2], candidate: &Candidate) -> bool {
    let ratios = round.fitted_model.power_ratios();
    (0..2).any(|channel| {
        !within_quantization[channel]
            && ratios[channel] > 1.0
            && candidate.powers[channel]
                < (1.0 - MIN_EFFECT_RMS_FRACTION * MIN_EFFECT_RMS_FRACTION) * round.powers[channel]
    })
}

/// Mean energy that replicates leave.
pub fn mean_replicate_energy(fitted_model: &FittedModel) -> f64 {
    fitted_model.replicates.iter().map(|summary| summary.energy).sum::<f64>()
        / fitted_model.replicates.len().max(1) as f64
}

fn remaining_structure(fitted_model: &FittedModel) -> RemainingStructure {
    let figures = |summary: &ResidualSummary| {
        let mut all: Vec<(&'static str, f64)> = summary.residual_tests.iter().map(|t| (t.name, t.gain)).collect();
        all.push(("the power of the force", 1e3 * summary.powers[0]));
        all.push(("the power of the effort", 1e3 * summary.powers[1]));
        all.push(("memory", summary.memory));
        all
    };
    let own = figures(&fitted_model.summary);
    let replicates: Vec<_> = fitted_model.replicates.iter().map(figures).collect();
    let nulls: Vec<NullDistribution> = (0..own.len())
        .map(|at| NullDistribution::of(&replicates.iter().map(|replicate| replicate[at].1).collect::<Vec<_>>(), 2.0))
        .collect();
    let most = |all: &[(&'static str, f64)]| {
        let beyond = all.iter().zip(&nulls).map(|((name, figure), null)| (*name, null.beyond(*figure)));
        beyond.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("nothing", 0.0))
    };
    let null = NullDistribution::of(&replicates.iter().map(|replicate| most(replicate).1).collect::<Vec<_>>(), 1.0);
    let (found_by, beyond) = most(&own);
    RemainingStructure { p_value: null.p_value(beyond), energy_ratio: fitted_model.power_ratio(), found_by }
}
