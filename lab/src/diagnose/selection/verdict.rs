//! From the search to the verdict: what is named, what is left, what cannot be told apart.

use rayon::prelude::*;

use schemars::JsonSchema;
use serde::Serialize;

use super::cross_validation::{self, HeldOut};
use super::forward_selection::{self, FALSE_ALARM_RATE, SelectionPath, SelectionStep};
use crate::diagnose::bootstrap::fitted_model::FittedModel;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData, FitResult};
use crate::diagnose::estimation::projection::ProjectedResidual;
use crate::diagnose::model::{Model, Term, index};
use crate::diagnose::thresholds::verdict::{
    ALTERNATIVE_CHI2_MARGIN, ALTERNATIVE_REL_MARGIN, MAX_FITTED_ALTERNATIVES, MAX_RMS_OVER_NOISE, MIN_EXCESS_FRACTION,
    MIN_EXPLAINED_FRACTION, MIN_SUPPORT, MIN_SUPPORT_FAR_FROM_NOISE, STRUCTURE_POWER_RATIO, WORSE_RMS_RATIO,
    WRONG_VALUE_RMS_RATIO,
};
use crate::effects::Place;

/// What came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
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
pub struct Assessment {
    /// In a word.
    pub verdict: Verdict,
    /// The named effects, in order of evidence; empty unless the verdict is explained or partly so.
    pub named: Vec<NamedEffect>,
    /// What this data cannot tell from each of the named.
    pub alternatives: Vec<FittedAlternative>,
    /// Share of the whitened energy above the expected noise that the named effects take.
    pub share: f64,
    /// Whether structure is left.
    pub left: bool,
    /// The nominal model, fitted under the last stand's expected noise.
    pub nominal: FitResult,
    /// The rig file as given, without a fit.
    pub as_given: HeldOut,
    /// The nominal model on data it did not see.
    pub refitted: HeldOut,
    /// The last stand's model on data it did not see.
    pub improved: HeldOut,
}

/// A named effect.
#[derive(Debug, Clone)]
pub struct NamedEffect {
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
pub struct FittedAlternative {
    /// The effect that it would stand for.
    pub instead_of: Term,
    /// The alternative.
    pub term: Term,
    /// Model and values with the alternative in its place.
    pub model: Model,
    /// Fitted values of that model.
    pub fit: FitResult,
    /// Energy that it takes by chance, beyond what the effect that it would stand for takes by chance.
    pub chance: f64,
}

/// Judges `search`; exchanges an effect for a alternative that does better.
pub fn assess(problem: &IdentificationProblem, search: &mut SelectionPath, say: &dyn Fn(&str)) -> Option<Assessment> {
    say("what else would explain it");
    let alternatives = exchange_effects(problem, search, say)?;
    let last = search.rounds.last()?;
    let fitted_model = &last.fitted_model;
    let nominal = problem.fit(&problem.nominal, &search.rounds.first()?.fitted_model.values, &fitted_model.whitener);
    let taken = (nominal.energy - forward_selection::mean_replicate_energy(fitted_model)).max(f64::MIN_POSITIVE);
    let share = ((nominal.energy - fitted_model.summary.energy) / taken).clamp(0.0, 1.0);
    let held = |model: &Model, values: &[f64]| {
        cross_validation::cross_validate(problem, &fitted_model.whitener, model, values, &fitted_model.excitation)
    };
    let (refitted, improved) =
        (held(&problem.nominal, &nominal.values), held(&fitted_model.model, &fitted_model.values));
    let left = has_structure_left(problem, last, &improved);
    let verdict = match (fitted_model.model.terms.len() == problem.nominal.terms.len(), left) {
        (true, true) => Verdict::Unknown,
        (true, false) if has_wrong_values(problem, fitted_model, nominal.energy) => Verdict::Parameters,
        (true, false) => Verdict::NoMismatch,
        (false, _) if is_worse(problem, &refitted, &improved) => Verdict::Unknown,
        (false, false) => Verdict::Explained,
        (false, true) if share >= MIN_EXPLAINED_FRACTION => Verdict::PartlyExplained,
        (false, true) => Verdict::Unknown,
    };
    let is_named = matches!(verdict, Verdict::Explained | Verdict::PartlyExplained);
    let named = if is_named { named(problem, search) } else { Vec::new() };
    let alternatives = if is_named { unrefuted(fitted_model, &named, alternatives) } else { Vec::new() };
    let left = left || verdict == Verdict::Unknown;
    let as_given = cross_validation::as_given(problem, &fitted_model.whitener, &problem.nominal, &problem.given);
    Some(Assessment { verdict, named, alternatives, share, left, nominal, as_given, refitted, improved })
}

/// Exchanges effects for alternatives that do better, takes off those that are not needed; what then could stand for each.
fn exchange_effects(
    problem: &IdentificationProblem,
    search: &mut SelectionPath,
    say: &dyn Fn(&str),
) -> Option<Vec<FittedAlternative>> {
    let mut alternatives = Vec::new();
    for _ in 0..3 {
        alternatives = fit_alternatives(problem, search);
        let fitted_model = &search.rounds.last()?.fitted_model;
        let better = alternatives.iter().filter(|alternative| {
            penalized_energy(alternative) + forward_selection::REPLACEMENT_CHI2_MARGIN
                < fitted_model.summary.energy + alternative.instead_of.price()
        });
        let shown = |alternative: &&FittedAlternative| {
            !levenberg_marquardt::is_at_limit(
                &alternative.term,
                alternative.model.trials(),
                &alternative.fit.values,
                &fitted_model.excitation,
            )
        };
        let better = better.filter(shown);
        let Some(better) = better.min_by(|a, b| penalized_energy(a).total_cmp(&penalized_energy(b))).cloned() else {
            break;
        };
        say(&format!("{} explains more than {}", better.term.name(), better.instead_of.name()));
        forward_selection::replace_model(problem, search, &better.model, &better.fit.values, say);
    }
    if prune(problem, search, say) {
        alternatives = fit_alternatives(problem, search);
    }
    Some(alternatives)
}

/// Whether the model of the last `round` leaves structure, on data that it did not see (`improved`).
fn has_structure_left(problem: &IdentificationProblem, round: &SelectionStep, improved: &HeldOut) -> bool {
    let fitted_model = &round.fitted_model;
    let residual_test =
        fitted_model.summary.residual_tests.iter().map(|residual_test| residual_test.gain).fold(0.0, f64::max);
    let excess = (fitted_model.summary.energy - forward_selection::mean_replicate_energy(fitted_model))
        .max(residual_test)
        / fitted_model.summary.energy.max(f64::MIN_POSITIVE);
    // What replicates leave can differ in its pattern; where it is no larger, nothing that matters is left.
    let beyond = round.structure.p_value < FALSE_ALARM_RATE && excess > MIN_EXCESS_FRACTION;
    let (quantization_power, within_quantization) =
        (problem.quantization_power(&fitted_model.values), problem.within_quantization(fitted_model));
    [false, true].into_iter().zip(fitted_model.power_ratios()).any(|(effort, ratio)| {
        let Some(noise_model) = cross_validation::expected_noise_rms(problem, &fitted_model.whitener, effort) else {
            return false;
        };
        let times = cross_validation::rms(problem, &improved.residuals, effort) / noise_model.max(f64::MIN_POSITIVE);
        let channel = usize::from(effort);
        times > MAX_RMS_OVER_NOISE.max(quantization_power[channel].sqrt())
            || times > 1.0 && !within_quantization[channel] && ratio > STRUCTURE_POWER_RATIO && beyond
    })
}

/// Whether an explanation makes unseen data worse, whatever it does to seen ones.
fn is_worse(problem: &IdentificationProblem, refitted: &HeldOut, improved: &HeldOut) -> bool {
    let rms = |held: &HeldOut, effort| cross_validation::rms(problem, &held.residuals, effort);
    let grown = |effort| rms(improved, effort) > WORSE_RMS_RATIO * rms(refitted, effort);
    improved.energy > refitted.energy || grown(false) || grown(true)
}

/// Takes off, the least first, effects beside others without which unseen data are left as well or nearly so; whether there were
/// any.
///
/// Where the residual is far from the expected noise any bend of a curve takes something of it, and each effect that was taken up may
/// since have lost what it was taken up for.
fn prune(problem: &IdentificationProblem, search: &mut SelectionPath, say: &dyn Fn(&str)) -> bool {
    let mut any = false;
    while let Some(idle) = search.rounds.last().and_then(|round| least_needed_effect(problem, &round.fitted_model)) {
        say(&format!("without {}, which takes next to nothing", idle.term.name()));
        forward_selection::replace_model(problem, search, &idle.model, &idle.values, say);
        any = true;
    }
    any
}

/// An effect that is not needed.
struct RedundantEffect {
    term: Term,
    /// The model without it.
    model: Model,
    /// Fitted values of that.
    values: Vec<f64>,
}

/// The effect of several that takes the least of unseen data, if that is too little.
fn least_needed_effect(problem: &IdentificationProblem, fitted_model: &FittedModel) -> Option<RedundantEffect> {
    let known = problem.nominal.terms.len();
    if fitted_model.model.terms.len() < known + 2 {
        return None;
    }
    let ratio = problem.trusted_ratio(fitted_model);
    let (far, enough) = match ratio {
        _ if ratio > MAX_RMS_OVER_NOISE * MAX_RMS_OVER_NOISE => (true, MIN_SUPPORT_FAR_FROM_NOISE),
        _ if ratio > STRUCTURE_POWER_RATIO => (false, MIN_SUPPORT),
        _ => (false, 0.0),
    };
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let held = |model: &Model, values: &[f64]| {
        cross_validation::cross_validate(problem, &fitted_model.whitener, model, values, &fitted_model.excitation)
    };
    let (with, noise_model) =
        (held(&fitted_model.model, &fitted_model.values), forward_selection::mean_replicate_energy(fitted_model));
    let taken = (known..fitted_model.model.terms.len()).into_par_iter().map(|at| {
        let term = fitted_model.model.terms[at];
        let (model, values) = without_term(&fitted_model.model, &fitted_model.values, at);
        let values = levenberg_marquardt::fit(&data, &model, &values, &fitted_model.excitation).values;
        let without = held(&model, &values);
        let gone = cross_validation::explained_variance(problem, &without, &with, term.effect.spec().place);
        let white = (without.energy - with.energy) / (without.energy - noise_model).max(f64::MIN_POSITIVE);
        (if far { gone } else { gone.max(white) }, RedundantEffect { term, model, values })
    });
    taken.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gone, _)| *gone < enough).map(|(_, idle)| idle)
}

/// Whether the given values leave more than the fitted ones, beyond an encoder's start within its step.
fn has_wrong_values(problem: &IdentificationProblem, fitted_model: &FittedModel, fitted: f64) -> bool {
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let half =
        0.5 * problem.sampler.uniform_trials.iter().map(|raw| raw.figures.position.resolution).fold(0.0, f64::max);
    let moved = fitted_model.values[index::SURFACE] - problem.given[index::SURFACE];
    let mut values = problem.given.clone();
    // Timings and where each trial's encoder starts are no values of the rig file.
    for at in
        [index::FORCE_TIMING, index::EFFORT_TIMING].into_iter().chain(index::SHARED..problem.nominal.nominal_count())
    {
        values[at] = fitted_model.values[at];
    }
    values[index::SURFACE] += moved.clamp(-half, half);
    let given = data.energy(&problem.nominal, &values);
    given > WRONG_VALUE_RMS_RATIO * WRONG_VALUE_RMS_RATIO * fitted && given > fitted + 30.0
}

fn penalized_energy(alternative: &FittedAlternative) -> f64 {
    alternative.fit.energy + alternative.term.price() + 1.5 * alternative.chance
}

/// Every effect in the place of each term of `fitted_model`'s model, fitted.
fn fit_alternatives(problem: &IdentificationProblem, search: &SelectionPath) -> Vec<FittedAlternative> {
    let (Some(first), Some(last)) = (search.rounds.first(), search.rounds.last()) else { return Vec::new() };
    let fitted_model = &last.fitted_model;
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let mut alternatives = Vec::new();
    for at in problem.nominal.terms.len()..fitted_model.model.terms.len() {
        let (base, values) = without_term(&fitted_model.model, &fitted_model.values, at);
        let fitted = levenberg_marquardt::fit(&data, &base, &values, &fitted_model.excitation);
        let projected = ProjectedResidual::of(data, &base, &fitted.values, &fitted_model.excitation);
        let mut scores = projected.scores(&fitted_model.excitation, &|term| !term.refines());
        scores.retain(|score| base.terms.iter().all(|term| term.name() != score.term.name()));
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores.truncate(MAX_FITTED_ALTERNATIVES);
        let own = fitted_model.model.terms[at];
        // What was not looked into does not explain the other channel.
        let drive = |term: &Term| term.effect.spec().place == Place::Drive;
        if drive(&own) && problem.within_quantization(fitted_model)[0] {
            scores.retain(|score| drive(&score.term));
        }
        let tried = scores.par_iter().filter(|score| !score.term.is(&own));
        alternatives.par_extend(tried.map(|score| {
            let model = base.with(score.term);
            let start: Vec<f64> = fitted.values.iter().chain(&score.values).copied().collect();
            let fit = levenberg_marquardt::fit(&data, &model, &start, &fitted_model.excitation);
            let taken = (fitted.energy - fit.energy).max(0.0);
            let chance = |term: &Term| {
                forward_selection::chance_gain(&first.fitted_model, term)
                    + forward_selection::transmission_discount(term) * taken
            };
            let chance = chance(&score.term) - chance(&own);
            FittedAlternative { instead_of: own, term: score.term, model, fit, chance }
        }));
    }
    alternatives
}

/// A model without one of its terms.
fn without_term(model: &Model, values: &[f64], at: usize) -> (Model, Vec<f64>) {
    let mut fewer = model.clone();
    let term = fewer.terms.remove(at);
    let start = model.first_value_of(at);
    let mut kept = values.to_vec();
    kept.drain(start..start + term.all_parameters(model.trials()).len());
    (fewer, kept)
}

fn named(problem: &IdentificationProblem, search: &SelectionPath) -> Vec<NamedEffect> {
    let Some(last) = search.rounds.last() else { return Vec::new() };
    let fitted_model = &last.fitted_model;
    let data = FitData { trials: &problem.sampler.trials, whitener: &fitted_model.whitener, rows: None };
    let mut named: Vec<NamedEffect> = (problem.nominal.terms.len()..fitted_model.model.terms.len())
        .into_par_iter()
        .map(|at| {
            let term = fitted_model.model.terms[at];
            let (base, values) = without_term(&fitted_model.model, &fitted_model.values, at);
            let fitted = levenberg_marquardt::fit(&data, &base, &values, &fitted_model.excitation);
            let without = cross_validation::cross_validate(
                problem,
                &fitted_model.whitener,
                &base,
                &fitted.values,
                &fitted_model.excitation,
            );
            // The round in which it was found, or the one whose choice it replaced.
            let found =
                search.rounds.iter().flat_map(|round| &round.candidates).filter(|c| c.term.name() == term.name());
            let p_value = found.map(|candidate| candidate.p_any).fold(f64::INFINITY, f64::min).min(FALSE_ALARM_RATE);
            NamedEffect { term, at, p_value, gain: fitted.energy - fitted_model.summary.energy, without }
        })
        .collect();
    named.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    named
}

/// Those alternatives that the data do not refute; one an effect.
fn unrefuted(
    fitted_model: &FittedModel,
    named: &[NamedEffect],
    mut alternatives: Vec<FittedAlternative>,
) -> Vec<FittedAlternative> {
    let rows: f64 = fitted_model.whitener.origins().len() as f64;
    let inflation = (forward_selection::mean_replicate_energy(fitted_model) / rows.max(1.0)).max(1.0);
    alternatives.sort_by(|a, b| a.fit.energy.total_cmp(&b.fit.energy));
    let mut kept: Vec<FittedAlternative> = Vec::new();
    for alternative in alternatives {
        let gain = named.iter().find(|n| n.term.name() == alternative.instead_of.name()).map_or(0.0, |n| n.gain);
        let margin = ALTERNATIVE_CHI2_MARGIN * inflation + ALTERNATIVE_REL_MARGIN * gain;
        let other = named.iter().all(|n| n.term.name() != alternative.term.name());
        let fresh = kept.iter().all(|k| k.term.name() != alternative.term.name());
        // What leaves almost as much as nothing at all is no alternative.
        let explains = alternative.fit.energy < fitted_model.summary.energy + 0.7 * gain;
        if other && fresh && explains && alternative.fit.energy - fitted_model.summary.energy < margin {
            kept.push(alternative);
        }
    }
    kept
}
