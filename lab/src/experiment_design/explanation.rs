//! Explanations of the same recordings as rigs: the answer of a diagnosis and each of its alternatives.

use nalgebra::DVector;
use rayon::prelude::*;

use super::discrimination::{LinearizedResponse, Noise, prior, range, steps, whitened};
use super::loop_model::LoopModel;
use super::prediction::predict;
use super::recorded::MAX_RECORDED_ROWS;
use crate::effects::{self, Effect, ExcitationStats, to_table};
use crate::recording::Recording;
use crate::rig::Rig;

/// The name of what no listed effect explains.
pub const UNKNOWN: &str = "unknown";

/// Alternatives that a design considers.
const MAX_ALTERNATIVES: usize = 4;

/// Places from which an alternative's values are searched in full.
const MAX_STARTS: usize = 2;

/// Steps of the search of an alternative's values.
const MAX_ITERATIONS: usize = 8;

/// Share of the misfit that a step has to take for the search to go on.
const LEAST_PROGRESS: f64 = 1e-3;

/// What could be behind the recordings.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// Names of its effects beyond the rig file's.
    pub physics: Vec<String>,
    /// The rig with them, values fitted.
    pub rig: Rig,
}

/// `answer`, first, and for each of `alternatives`, sets of names, the rig that responds to a recorded reference as the answer does: the
/// recordings cannot tell them from each other, so neither can what the answer makes of them. Alternatives whose values cannot be
/// found so (those that repeat along time or way, of which the answer has no trace) are left out.
#[must_use]
pub fn explanations(
    answer: Explanation,
    alternatives: &[Vec<String>],
    trials: &[Recording],
    closed_loop: &LoopModel,
    noise: &Noise,
) -> Vec<Explanation> {
    let reference = trials.iter().filter_map(|trial| trial.reference.as_ref()).max_by_key(|reference| reference.len());
    let Some(reference) = reference.map(|reference| &reference[..reference.len().min(MAX_RECORDED_ROWS)]) else {
        return vec![answer];
    };
    let Ok(shown) = predict(&answer.rig, closed_loop, reference) else { return vec![answer] };
    let response = whitened(&shown, noise);
    let target = Target { closed_loop, noise, reference, response, travel: range(&shown.position) };
    let stats = excitation_stats(&answer.rig, trials);
    let alternatives: Vec<&Vec<String>> = alternatives.iter().take(MAX_ALTERNATIVES).collect();
    let fitted = alternatives.into_par_iter().filter_map(|names| target.alternative(&answer, names, &stats));
    let fitted: Vec<Explanation> = fitted.collect();
    std::iter::once(answer.clone()).chain(fitted).collect()
}

/// The response that alternatives are fitted to.
struct Target<'a> {
    closed_loop: &'a LoopModel,
    noise: &'a Noise,
    reference: &'a [f64],
    response: DVector<f64>,
    travel: f64,
}

impl Target<'_> {
    /// The rig of `answer` with the effects `names` in place of its own.
    fn alternative(&self, answer: &Explanation, names: &[String], stats: &ExcitationStats) -> Option<Explanation> {
        let names: Vec<String> = names.iter().filter(|name| *name != UNKNOWN).cloned().collect();
        let mut rig = answer.rig.clone();
        // What the rig file knew already stays; of the named effects, only those that the alternative has as well.
        rig.effects.retain(|table| !answer.physics.contains(&table.name) || names.contains(&table.name));
        let missing = names.iter().filter(|name| rig.effects.iter().all(|table| table.name != **name));
        let missing = missing.map(|name| effects::find(name)).collect::<Option<Vec<&'static dyn Effect>>>()?;
        let mut starts: Vec<Rig> = missing.into_iter().try_fold(vec![rig], |rigs, effect| {
            let points = effect.starts(0, stats);
            let with = |rig: &Rig, values: &[f64]| {
                let mut rig = rig.clone();
                rig.effects.push(to_table(effect, 0, rig.coordinate, values, None));
                rig
            };
            let all: Vec<Rig> = rigs
                .iter()
                .flat_map(|rig| points.iter().map(|point| with(rig, &point.values)).collect::<Vec<_>>())
                .collect();
            (!all.is_empty()).then_some(all)
        })?;
        starts.sort_by_cached_key(|rig| ordered(self.misfit(rig)));
        let fitted = starts.iter().take(MAX_STARTS).map(|start| self.fit(start));
        let (_, rig) = fitted.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Explanation { physics: names, rig })
    }

    fn misfit(&self, rig: &Rig) -> f64 {
        let Ok(shown) = predict(rig, self.closed_loop, self.reference) else { return f64::INFINITY };
        let response = whitened(&shown, self.noise);
        if response.len() == self.response.len() { (response - &self.response).norm_squared() } else { f64::INFINITY }
    }

    /// Damped Gauss-Newton steps from `start`, every free value of the rig moved: the misfit and the rig.
    fn fit(&self, start: &Rig) -> (f64, Rig) {
        let mut best = (self.misfit(start), start.clone());
        let mut damping = 1.0;
        for _ in 0..MAX_ITERATIONS {
            let steps = steps(&best.1, self.travel);
            let Ok(here) = LinearizedResponse::new(&best.1, &steps, self.closed_loop, self.reference, self.noise)
            else {
                break;
            };
            let gradient = here.sensitivity.tr_mul(&(&self.response - &here.response));
            let before = best.0;
            // A step that is too long is tried again shorter, without the sensitivities being taken anew.
            for _ in 0..4 {
                let Some(solver) = (here.information() + prior(steps.len()) * damping).cholesky() else { break };
                let moves = solver.solve(&gradient);
                let moved = steps.iter().zip(moves.iter()).fold(best.1.clone(), |rig, ((parameter, step), by)| {
                    let value = parameter.get(&rig).unwrap_or(0.0);
                    parameter.set(&rig, value + step * by)
                });
                let misfit = self.misfit(&moved);
                if misfit < best.0 {
                    best = (misfit, moved);
                    damping *= 0.2;
                    break;
                }
                damping *= 10.0;
            }
            if best.0 > (1.0 - LEAST_PROGRESS) * before {
                break;
            }
        }
        best
    }
}

/// A misfit as a key: those of positive floats are in the order of their bits.
fn ordered(misfit: f64) -> u64 {
    misfit.max(0.0).to_bits()
}

/// The measures of `trials` under `rig`, from which the values of an effect are searched.
pub(super) fn excitation_stats(rig: &Rig, trials: &[Recording]) -> ExcitationStats {
    let surface = rig.surface();
    let positions = || trials.iter().flat_map(|trial| trial.position.iter().copied());
    let (low, high) = positions().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let peak = |pick: fn(&Recording) -> Option<&Vec<f64>>| {
        trials.iter().filter_map(pick).flatten().fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let duration = trials.iter().map(|trial| trial.time[trial.time.len() - 1] - trial.time[0]).fold(0.0, f64::max);
    let sample = trials.first().map_or(1e-3, Recording::period);
    let span = (0.02 / sample).round().max(1.0) as usize;
    let (mut squares, mut count) = (0.0, 0.0f64);
    for trial in trials {
        for at in span..trial.position.len() {
            let inside = rig.contact.is_none() || trial.position[at] > surface;
            let velocity = (trial.position[at] - trial.position[at - span]) / (span as f64 * sample);
            if inside {
                (squares, count) = (squares + velocity * velocity, count + 1.0);
            }
        }
    }
    let speed = (squares / count.max(1.0)).sqrt().max((high - low) / duration.max(sample));
    let contact = rig.contact;
    let pull = ExcitationStats::greatest_pull(trials.iter().filter_map(|trial| trial.force.as_ref()).flatten());
    let rows = trials.iter().filter_map(|trial| Some(trial.force.as_ref()?.iter().zip(&trial.position)));
    let heights = rows.flatten().map(|(force, position)| (*force, surface - position));
    ExcitationStats {
        depth: if contact.is_some() { (high - surface).max(1e-3 * (high - low)) } else { 0.0 },
        speed,
        acceleration: speed * std::f64::consts::TAU,
        force: peak(|trial| trial.force.as_ref()),
        pull,
        half_pull_height: ExcitationStats::half_pull_height(pull, heights),
        effort: peak(|trial| trial.effort.as_ref()),
        travel: (low, high),
        duration,
        step: 5.0 * sample,
        sample,
        stiffness: contact.map_or(0.0, |contact| contact.stiffness),
        inertia: rig.drive.map_or(0.0, |drive| drive.inertia),
        visits: 3,
        releases: 3,
        way_back: 1.0,
        free_span: 0.5,
        longest_contact: 0.2,
        has_force: trials.iter().any(|trial| trial.force.is_some()),
        has_effort: trials.iter().any(|trial| trial.effort.is_some()),
        is_rotary: rig.coordinate == crate::rig::Coordinate::Rotary,
        is_bilateral: contact.is_some_and(|contact| contact.bilateral),
    }
}
