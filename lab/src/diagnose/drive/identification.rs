//! From trials to the law of their drive.

use std::f64::consts::TAU;

use super::candidates::is_likelier;
use super::criteria::{COARSER, LOWEST_BAND_HZ, MOST_COARSE};
use super::denoised::denoised;
use super::fit::Fit;
use super::held_out::rms;
use super::judgement::judged;
use super::law::{DriveLaw, Side};
use super::likelihood::Data;
use super::model::index;
use super::nominal::{NominalDrive, encoder_variance, missing_under, nominal_fit, punctual_and_lagged, scales};
use super::outcome::Outcome;
use super::outside_force::outside_forces;
use super::selection::{Chosen, Search};
use super::term::Term;
use super::trial::DriveTrial;
use crate::diagnose::verdict::Verdict;

/// Identifies the drive of `trials`; `None` where they show no motion or are too short.
///
/// Where the encoder moves from row to row as no force on the inertia could move it (the nominal law leaves more than the whole effort),
/// and no law is found, it is not on the body that the law moves: between them is what rattles or bends. The slower motion is looked at
/// then, as if the encoder were coarser by steps, until that shows a law; the rest stays unknown. Before that, where the inertia ended where its
/// search did, the rig file's is tried in its place.
#[must_use]
pub fn identify(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    let as_they_are = identify_as_they_are(trials, rig, seed, say)?;
    if let Some(found) = with_given_inertia(&as_they_are, rig, seed, say) {
        return Some(found);
    }
    let first = between_pushes(as_they_are, rig, seed, say);
    let scales = first.chosen.model.scales;
    if !first.named.is_empty() || first.verdict != Verdict::Unknown || rms(&first.missing[1]) < scales.effort {
        return Some(first);
    }
    let range = if rig.is_rotary { scales.travel.min(TAU) } else { scales.travel };
    let mut step = (12.0 * encoder_variance(&first.trials, &scales)).sqrt() * COARSER.value();
    while step < MOST_COARSE * range {
        say("the drive: its slower motion");
        let coarser = NominalDrive { resolution: step, ..rig.clone() };
        let found = identify_between_pushes(first.trials.clone(), &coarser, seed, say);
        if let Some(found) = found.filter(is_law_of_slower_motion) {
            return Some(Outcome { verdict: Verdict::PartlyExplained, coarser_step: Some(step), ..found });
        }
        step *= COARSER.value();
    }
    Some(first)
}

/// What is found where the inertia is that of the rig file, known no better than before, if that names something where `first` names nothing, or explains the
/// recordings; `None` where the motion tells the inertia. A controller that keeps the speed answers what hinders the motion with effort, and nothing accelerates: a law of
/// white disturbances takes that for an inertia as large as its search allows.
fn with_given_inertia(first: &Outcome, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    if first.chosen.model.has_believed_inertia(&first.chosen.values) {
        return None;
    }
    say("the drive: with the inertia of the rig file");
    let held = NominalDrive { inertia_factor: 1.0, ..rig.clone() };
    let mut found = identify_between_pushes(first.trials.clone(), &held, seed, say)?;
    found.intervals[index::INERTIA] = [rig.inertia / rig.inertia_factor, rig.inertia * rig.inertia_factor];
    let is_better = !found.named.is_empty() && (first.named.is_empty() || found.verdict == Verdict::Explained);
    is_better.then_some(found)
}

/// Whether it is a law of the motion that a coarser encoder shows: not one of how quickly a force comes or passes on, of which that shows
/// nothing.
fn is_law_of_slower_motion(found: &Outcome) -> bool {
    let model = &found.chosen.model;
    let is_quick = model.has_link() || model.has("effort_lag");
    !found.named.is_empty() && !is_quick && rms(&found.missing[2]) < rms(&found.missing[1])
}

/// The same of the motion as the encoder shows it. Where no law does and a force from outside comes and goes, the law of the rest is looked
/// for. Where that explains all of the recordings, nothing came from outside: to a rigid drive, by which such stretches are found, a
/// resonance that is passed looks like a push. Nor did anything where it is explained by what a force of no law does far better than, throughout.
fn identify_between_pushes(
    trials: Vec<DriveTrial>,
    rig: &NominalDrive,
    seed: u64,
    say: &dyn Fn(&str),
) -> Option<Outcome> {
    identify_as_they_are(trials, rig, seed, say).map(|first| between_pushes(first, rig, seed, say))
}

/// `first`, or what is found beside stretches in which something else pushes.
fn between_pushes(first: Outcome, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Outcome {
    if !matches!(first.verdict, Verdict::Unknown | Verdict::PartlyExplained) {
        return first;
    }
    let values = &first.chosen.values;
    let law = DriveLaw {
        effort_averaging: first.chosen.model.law(values).effort_averaging,
        ..DriveLaw::nominal(rig.inertia, rig.viscous, values[index::DELAY])
    };
    let Some(missing) = missing_under(&first.trials, rig) else { return first };
    let stretches = outside_forces(&first.trials, &missing, &law, &first.chosen.model.scales);
    if stretches.is_empty() {
        return first;
    }
    say("the drive: without the stretches in which something else pushes");
    let quiet = first.trials.iter().enumerate().map(|(number, trial)| {
        let own = stretches.iter().filter(|stretch| stretch.trial == number);
        trial.without(&own.map(|stretch| [stretch.start_s, stretch.end_s]).collect::<Vec<_>>())
    });
    let is_found = |found: &Outcome| !found.named.is_empty() && has_none(&found.chosen.model.names(), &first.rivalled);
    let Some(second) = identify_as_they_are(quiet.collect(), rig, seed, say).filter(is_found) else {
        return first;
    };
    match identify_by(first.trials, rig, seed, say, &|search| search.fitted(&second.chosen)) {
        Some(whole) if whole.verdict == Verdict::Explained => whole,
        _ => Outcome { verdict: Verdict::PartlyExplained, outside_forces: stretches, ..second },
    }
}

/// Whether none of `names` is one of the `rivalled`, which were found to be something else.
fn has_none(names: &[&str], rivalled: &[&str]) -> bool {
    rivalled.iter().all(|name| !names.contains(name))
}

/// How the refitted nominal law stands before trials.
pub struct NominalStanding {
    /// ln of their likelihood under it, nats.
    pub log_likelihood: f64,
    /// Force that it does not explain in the common band, N or N m in root mean square.
    pub unexplained: f64,
}

/// How the refitted nominal law stands before `trials`; `None` where they show no motion.
#[must_use]
pub fn nominal_standing(trials: &[DriveTrial], rig: &NominalDrive) -> Option<NominalStanding> {
    let scales = scales(trials, rig)?;
    let variance = encoder_variance(trials, &scales);
    let data = Data { trials, least_encoder_variance: 0.3 * variance };
    let search = search_from(data, rig, nominal_fit(&data, rig, scales, variance)?);
    let unexplained = search.unexplained(&search.nominal);
    Some(NominalStanding { log_likelihood: search.nominal.log_likelihood, unexplained })
}

fn identify_as_they_are(trials: Vec<DriveTrial>, rig: &NominalDrive, seed: u64, say: &dyn Fn(&str)) -> Option<Outcome> {
    identify_by(trials, rig, seed, say, &|search| search.run(say))
}

/// Identifies the drive of `trials` by the law that is `chosen` for them.
fn identify_by(
    trials: Vec<DriveTrial>,
    rig: &NominalDrive,
    seed: u64,
    say: &dyn Fn(&str),
    chosen: &dyn Fn(&Search<'_>) -> Chosen,
) -> Option<Outcome> {
    let scales = scales(&trials, rig)?;
    let encoder_variance = encoder_variance(&trials, &scales);
    say("the drive: nominal values");
    let as_recorded = Data { trials: &trials, least_encoder_variance: 0.3 * encoder_variance };
    let nominal = nominal_fit(&as_recorded, rig, scales, encoder_variance)?;
    let denoised = denoised(&as_recorded, &nominal);
    let data = denoised.as_ref().map_or(as_recorded, |trials| Data { trials, ..as_recorded });
    let nominal = if denoised.is_some() { nominal_fit(&data, rig, scales, encoder_variance)? } else { nominal };
    // A recording may be late by some rows. Where a lag of the drive is worth its value beside a punctual recording, it is the lag.
    // It was found already: however little of the effort it is, it is looked for.
    let asked = |punctual: Fit| Search { is_asked: true, ..search_from(data, rig, punctual) };
    let late = punctual_and_lagged(&data, rig, &nominal, encoder_variance);
    let lag = late.as_ref().and_then(|[punctual, lagged]| {
        let search = asked(punctual.clone());
        search.is_worth(lagged, &search.nominal).then_some(search)
    });
    let mut search = lag.unwrap_or_else(|| search_from(data, rig, nominal));
    let mut found = chosen(&search);
    // What else is missing can hide that the effort is lagged and not late.
    if search.is_lagged(&found.fit)
        && let Some([punctual, _]) = late
    {
        search = asked(punctual);
        found = chosen(&search);
    }
    say("the drive: what is left");
    let mut outcome = judged(&search, found, seed);
    outcome.trials = denoised.unwrap_or(trials);
    Some(outcome)
}

impl Search<'_> {
    /// Whether the effort of `fit`, which is later than a recorded row, is lagged rather than late: with a lag in the place of the delay beyond that row its terms are
    /// likelier, and the lag is worth its value beside a punctual effort.
    fn is_lagged(&self, fit: &Fit) -> bool {
        let recorded = self.data.trials[0].recorded_period_s;
        let is_late = fit.values[index::DELAY] > recorded && fit.model != self.nominal.model;
        if !is_late || fit.model.has("effort_lag") || fit.model.has_link() || self.scales.holds_inertia() {
            return false;
        }
        let mut start = fit.clone();
        start.model.scales.latest_effort_s = recorded;
        let punctual = self.polished(&start);
        start.model.terms.push(Term::EffortLag);
        start.values.push(fit.values[index::DELAY]);
        let lagged = self.polished(&start);
        is_likelier(&lagged, fit) && self.is_worth(&lagged, &punctual)
    }
}

fn search_from<'a>(data: Data<'a>, rig: &NominalDrive, nominal: Fit) -> Search<'a> {
    let scales = nominal.model.scales;
    let crossing = nominal.noise.crossing_hz(scales.period_s, nominal.values[index::INERTIA]);
    let band_hz = crossing.clamp(LOWEST_BAND_HZ.value().min(0.1 / scales.period_s), 0.4 / scales.period_s);
    // Where the inertia is not told, nor is how two bodies share it.
    let either = if scales.holds_inertia() { Vec::new() } else { vec![Side::Motor, Side::Load] };
    let sides = either.into_iter().filter(|side| rig.encoder.is_none_or(|known| known == *side)).collect();
    Search { data, scales, nominal, band_hz, sides, is_asked: false, effort_noise_density: data.effort_noise_density() }
}

#[cfg(test)]
mod tests;
