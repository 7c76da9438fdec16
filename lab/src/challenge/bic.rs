//! A rival of our own making: our candidates, chosen by the Bayesian information criterion as textbooks have it.
//!
//! The same filters, the same laws and the same fits; no twins, no floor of the moment, no memory of the noise, no question
//! of size: an effect is added as long as `n ln(RSS / n) + k ln n` falls, n being the rows and k the free values (G. Schwarz,
//! Ann. Stat. 6 (1978) 461).

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use palpate_cases::baselines::BaselineResult;
use rayon::prelude::*;

use super::case_files::{self, CaseFiles};
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::levenberg_marquardt::{self, FitData};
use crate::diagnose::estimation::projection::ProjectedResidual;
use crate::diagnose::estimation::whitener::Whitener;
use crate::diagnose::model::Model;
use crate::diagnose::selection::cross_validation;
use crate::diagnose::{problem, sensed};

/// Candidates of a round that are fitted in full.
const FITTED: usize = 8;

/// Effects at most, as many as the diagnosis may name.
const MOST_EFFECTS: usize = 4;

/// What the criterion names in the case that lies in `folder`.
///
/// # Errors
/// Files at fault.
pub fn answer(folder: &Path) -> Result<BaselineResult> {
    let start = Instant::now();
    let CaseFiles { rig, origin, trials } = case_files::read(folder)?;
    let study = problem(&rig, &origin, sensed(&rig, &origin, &trials)?, 1)?;
    let whitener = study.uniform_noise_models();
    let first = study.initial_fit();
    let (model, values) = select(&study, &whitener, first.clone());
    let named = model.terms[study.nominal.terms.len()..].iter().map(|term| term.name().to_owned()).collect();
    // In the channel in which refitted values leave the more over the sensors' noise, as the diagnosis has it.
    let held = |model: &Model, values: &[f64]| {
        cross_validation::cross_validate(&study, &whitener, model, values, &study.excitation_stats(model, values))
    };
    let (before, after) = (held(&study.nominal, &first), held(&model, &values));
    let effort = before.powers[1] > before.powers[0];
    Ok(BaselineResult {
        named,
        refitted: cross_validation::rms(&study, &before.residuals, effort),
        held_out: cross_validation::rms(&study, &after.residuals, effort),
        unit: rig.coordinate.force_unit().to_owned(),
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// Adds effects one by one while the criterion falls.
fn select(study: &IdentificationProblem, whitener: &Whitener, first: Vec<f64>) -> (Model, Vec<f64>) {
    let data = FitData { trials: &study.sampler.trials, whitener, rows: None };
    let (mut model, mut values) = (study.nominal.clone(), first);
    let mut best = criterion(&data, &model, &values);
    for _ in 0..MOST_EFFECTS {
        let scene = study.excitation_stats(&model, &values);
        let remainder = ProjectedResidual::of(data, &model, &values, &scene);
        let mut scores = remainder.scores(&scene, &|_| true);
        scores.retain(|score| model.terms.iter().all(|term| term.name() != score.term.name()));
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores.truncate(FITTED);
        let fits = scores.par_iter().map(|score| {
            let more = model.with(score.term);
            let start: Vec<f64> = values.iter().chain(&score.values).copied().collect();
            let fit = levenberg_marquardt::fit(&data, &more, &start, &scene);
            (criterion(&data, &more, &fit.values), more, fit.values)
        });
        let Some((found, more, fitted)) = fits.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        if found >= best {
            break;
        }
        (best, model, values) = (found, more, fitted);
    }
    (model, values)
}

fn criterion(data: &FitData<'_>, model: &Model, values: &[f64]) -> f64 {
    let rows = data.whitener.origins().len().max(1) as f64;
    let terms = model.terms.iter().flat_map(|term| term.parameters());
    let free = model.nominal_count() + terms.filter(|parameter| !parameter.fixed).count();
    rows * (data.energy(model, values) / rows).max(f64::MIN_POSITIVE).ln() + free as f64 * rows.ln()
}
