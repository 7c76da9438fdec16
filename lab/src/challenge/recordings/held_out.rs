//! What a model leaves of trials that it never saw, every value of it frozen.
//!
//! Where the surface lies is a matter of each trial (a sample is put on anew, a piston's pressure is set anew), not of the
//! physics: this one number is placed by least squares over the beginning of the trial, which is not scored. Nothing is
//! fitted to the rest, of which the root mean square is the score. Both models get the same treatment and the same filter.

use anyhow::{Context as _, Result};

use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::bootstrap::sampler::BootstrapSampler;
use crate::diagnose::linalg::energy;
use crate::diagnose::model::{Channels, Residual, index};
use crate::diagnose::signals::bandwidth::analysis_filters;
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::diagnose::signals::uniform_trial::UniformTrial;
use crate::diagnose::{problem, sensed};
use crate::recording::Recording;
use crate::rig::Rig;

/// Share of a trial that places its surface.
const BEGINNING: f64 = 0.1;

/// The same where the tool is clamped: one of some five strokes, there and back.
const BEGINNING_CLAMPED: f64 = 0.2;

/// Share of its way that the force has to have gone by then, or there is no touch to place a surface by.
const TOUCHED: f64 = 0.2;

/// Steps of a placement, and the share of a step below which it has come to rest.
const STEPS: usize = 30;
const REST: f64 = 1e-6;

/// Searches at most for the nominal values, and the share of its energy by which one has to be better to go on.
const SEARCHES: usize = 100;
const SETTLED: f64 = 1e-4;

/// Seed of twins that nobody asks for.
const SEED: u64 = 1;

/// The nominal law of `rig` with the values that `trials` teach: least squares, no effect added.
///
/// # Errors
/// Trials that the rig does not predict.
pub fn refitted(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<Rig> {
    let study = problem(rig, origin, sensed(rig, origin, trials)?, SEED)?;
    let values = settled(&study);
    let mut fresh = rig.clone();
    if let Some(contact) = &mut fresh.contact {
        contact.stiffness = values[index::STIFFNESS];
        contact.damping = values[index::DAMPING];
        contact.surface = values[index::SURFACE];
    }
    if let Some(drive) = &mut fresh.drive {
        drive.inertia = values[index::INERTIA];
        drive.viscous = values[index::VISCOUS];
    }
    Ok(fresh)
}

/// The nominal values of least squares. A search takes steps in measures of the depth: a preload that lies metres beyond,
/// as that of a clamped spring can, is reached by searching again from where the last one gave up.
fn settled(study: &IdentificationProblem) -> Vec<f64> {
    let whitener = study.uniform_noise_models();
    let mut values = study.initial_fit();
    let mut least = f64::INFINITY;
    for _ in 0..SEARCHES {
        let fit = study.fit(&study.nominal, &values, &whitener);
        values = fit.values;
        if fit.energy > (1.0 - SETTLED) * least {
            break;
        }
        least = fit.energy;
    }
    values
}

/// Root mean squares over the scored rows of `trials` that `models` leave, looked at through the filter of the first.
///
/// # Errors
/// A trial that the rig does not predict, effects that cannot be, or no row to score.
pub fn left<const N: usize>(models: [&Rig; N], origin: &str, trials: &[Recording]) -> Result<[f64; N]> {
    let (mut sums, mut rows) = ([0.0; N], 0usize);
    for trial in trials {
        let raws = sensed(models[0], origin, std::slice::from_ref(trial))?;
        let analysis_filters = analysis_filters(models[0], &raws);
        for (at, model) in models.iter().enumerate() {
            let scored = scored(model, origin, &raws, &analysis_filters)?;
            sums[at] += energy(&scored);
            rows += if at == 0 { scored.len() } else { 0 };
        }
    }
    anyhow::ensure!(rows > 0, "no row of the trials kept back can be scored");
    Ok(sums.map(|sum| (sum / rows as f64).sqrt()))
}

/// Residuals of `rig` on the scored rows of one trial.
fn scored(
    rig: &Rig,
    origin: &str,
    raws: &[UniformTrial],
    analysis_filters: &(DerivativeFilter, DerivativeFilter),
) -> Result<Vec<f64>> {
    let studio = BootstrapSampler::new(raws.to_vec(), analysis_filters.0.clone(), analysis_filters.1.clone(), SEED);
    let study = IdentificationProblem::new(rig, origin, studio)?;
    let trial = study.sampler.trials.first().context("there is no trial")?;
    let effort = study.nominal.contact.is_none();
    let (values, from) = if effort {
        (study.given.clone(), 0)
    } else {
        placed(&study, &trial.contact, beginning(&study, &trial.contact))
    };
    let rest = study.nominal.residual(&values, trial, Channels::BOTH);
    let values = if effort { rest.effort } else { rest.force };
    let valid = values.iter().zip(&trial.filtered(effort).valid).skip(from);
    Ok(valid.filter(|(_, valid)| **valid).map(|(value, _)| *value).collect())
}

/// The row at which the beginning ends.
fn beginning(study: &IdentificationProblem, track: &FilteredTrial) -> usize {
    let share = if study.nominal.contact == Some(true) { BEGINNING_CLAMPED } else { BEGINNING };
    let gone: Vec<f64> = match &track.force {
        Some(force) => force.iter().map(|value| (value - force[0]).abs()).collect(),
        None => Vec::new(),
    };
    let most = gone.iter().fold(0.0, |most: f64, gone| most.max(*gone));
    let touched = gone.iter().position(|gone| *gone >= TOUCHED * most).unwrap_or(0);
    touched.max((share * track.len() as f64) as usize)
}

/// The values of the rig file with the surface that leaves least of the rows before `end`; and `end`.
fn placed(study: &IdentificationProblem, track: &FilteredTrial, end: usize) -> (Vec<f64>, usize) {
    let mut starts = vec![study.given[index::SURFACE]];
    if study.nominal.contact == Some(false) {
        starts.extend(study.surfaces());
    }
    let places = starts.into_iter().map(|start| descend(study, track, end, start));
    let best = places.min_by(|a, b| a.1.total_cmp(&b.1));
    let mut values = study.given.clone();
    values[index::SURFACE] = best.map_or(values[index::SURFACE], |(surface, _)| surface);
    (values, end)
}

/// The surface that Gauss and Newton's method finds from `surface`, and the energy that it leaves before `end`.
fn descend(study: &IdentificationProblem, track: &FilteredTrial, end: usize, mut surface: f64) -> (f64, f64) {
    let travel = track.position.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    let nudge = 1e-4 * (travel.1 - travel.0);
    let mut rest = before(study, end, surface);
    for _ in 0..STEPS {
        let moved = before(study, end, surface + nudge);
        let (mut above, mut below) = (0.0, 0.0);
        for (rest, moved) in rest.iter().zip(&moved) {
            let slope = (moved - rest) / nudge;
            (above, below) = (above - slope * rest, below + slope * slope);
        }
        let mut step = if below > 0.0 { above / below } else { 0.0 };
        let found = loop {
            let trial = before(study, end, surface + step);
            if energy(&trial) < energy(&rest) {
                break Some(trial);
            }
            step *= 0.5;
            if step.abs() < REST * nudge {
                break None;
            }
        };
        let Some(trial) = found else { break };
        (surface, rest) = (surface + step, trial);
    }
    (surface, energy(&rest))
}

/// What is left of the rows before `end` with the surface at `surface`.
fn before(study: &IdentificationProblem, end: usize, surface: f64) -> Vec<f64> {
    let mut values = study.given.clone();
    values[index::SURFACE] = surface;
    let trial = &study.sampler.trials[0];
    let Residual { force, .. } = study.nominal.residual(&values, trial, Channels { force: true, effort: false });
    let valid = force.iter().zip(&trial.contact.valid).take(end);
    valid.map(|(value, valid)| if *valid { *value } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A press of ten seconds on a spring of `stiffness` and a damper, twice a second, whose surface lies at `surface`.
    fn press(stiffness: f64, surface: f64) -> Recording {
        let time: Vec<f64> = (0..10_000).map(|row| f64::from(row) * 1e-3).collect();
        let position: Vec<f64> = time.iter().map(|t| surface + 0.002 - 0.004 * (TAU * 2.0 * t).cos()).collect();
        let speed = |t: &f64| 0.004 * TAU * 2.0 * (TAU * 2.0 * t).sin();
        let law = |(t, x): (&f64, &f64)| {
            if *x > surface { (stiffness * (x - surface) + 6.0 * speed(t)).max(0.0) } else { 0.0 }
        };
        let force = time.iter().zip(&position).map(law).collect();
        Recording { name: "press".to_owned(), time, position, force: Some(force), ..Recording::default() }
    }

    fn rig(stiffness: f64) -> Rig {
        let text = format!(
            "[rig]\nname = \"press\"\n[contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = {stiffness}\n\
             damping_n_s_m = 6.0\n[sensors]\nposition_resolution_m = 1e-7\nforce_resolution_n = 1e-4\n"
        );
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Rig::read(file.path()).unwrap()
    }

    #[test]
    fn the_surface_is_placed_and_the_stiffness_is_not() {
        let trial = press(600.0, 0.003);
        let [right, stiff] = left([&rig(600.0), &rig(660.0)], "rig", std::slice::from_ref(&trial)).unwrap();
        // Force is 1.6 N RMS in contact, two thirds of the time. Behind the filter the corner at the touch is left, in
        // thousandths of it; a tenth of the stiffness is a tenth of the force, of which a surface placed too deep takes a part.
        assert!(right < 0.02, "{right}");
        assert!((0.04..0.2).contains(&stiff), "{stiff}");
        // A stiffness that had been fitted would leave as little as the right one.
        let refitted = refitted(&rig(660.0), "rig", std::slice::from_ref(&trial)).unwrap();
        assert!((refitted.contact.unwrap().stiffness / 600.0 - 1.0).abs() < 0.01, "{refitted:?}");
        let [again, _] = left([&refitted, &rig(600.0)], "rig", &[trial]).unwrap();
        assert!(again < 0.02, "{again}");
    }
}
