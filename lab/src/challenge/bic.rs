//! A baseline of our own making: our candidates, chosen by the Bayesian information criterion as textbooks have it.
//!
//! The same laws and the same fits of the contact's force; no correlation of the residual, no question of size, no held-out rows: an effect
//! is added as long as `n ln(RSS / n) + k ln n` falls, n being the rows and k the free values (G. Schwarz, Ann. Stat. 6 (1978) 461). A
//! case in which nothing is touched has no force to predict: it names nothing there.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use palpate_cases::baselines::BaselineResult;
use rayon::prelude::*;

use super::case_files::{self, CaseFiles};
use crate::diagnose::contact::data::Data;
use crate::diagnose::contact::fit::{Effort, Fit};
use crate::diagnose::contact::held_out::{Folds, rms};
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::nominal::nominal_fit;
use crate::diagnose::contact::prepare;
use crate::diagnose::contact::projection::Projection;
use crate::diagnose::sensed;
use crate::effects;
use crate::sensors::Figures;

/// Candidates of a round that are fitted in full.
const MAX_FULL_FITS: usize = 8;

/// Effects at most, as many as the diagnosis may name.
const MOST_EFFECTS: usize = 4;

/// What the criterion names in the case that lies in `folder`.
///
/// # Errors
/// Files at fault.
pub fn answer(folder: &Path) -> Result<BaselineResult> {
    let start = Instant::now();
    let CaseFiles { rig, origin, trials } = case_files::read(folder)?;
    let unit = rig.coordinate.force_unit().to_owned();
    let nominal = prepare::nominal(&rig, effects::resolve_all(&rig, &origin)?);
    let Some(nominal) = nominal.filter(|_| prepare::is_recorded(&rig, &trials)) else {
        return Ok(BaselineResult {
            named: Vec::new(),
            refitted: f64::NAN,
            held_out: f64::NAN,
            unit,
            seconds: start.elapsed().as_secs_f64(),
        });
    };
    let figures: Vec<Figures> = sensed(&rig, &origin, &trials)?.iter().map(|trial| trial.figures).collect();
    let [_, trials] = prepare::trials(&trials, &figures);
    let data = Data::new(&trials);
    let first = nominal_fit(&data, &nominal);
    let known = first.model.terms.len();
    let chosen = select(&data, first.clone());
    let folds = Folds::of(&data);
    let held = |fit: &Fit| rms(&data, &folds.held_out(&data, fit).residual);
    Ok(BaselineResult {
        named: chosen.model.names(known).into_iter().map(str::to_owned).collect(),
        refitted: held(&first),
        held_out: held(&chosen),
        unit,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// Adds effects one by one while the criterion falls.
fn select(data: &Data<'_>, mut best: Fit) -> Fit {
    for _ in 0..MOST_EFFECTS {
        let model = &best.model;
        let (stiffness, surface) = (best.values[index::STIFFNESS], best.values[index::SURFACE]);
        let excitation = model.scales.excitation(data.trials, stiffness, surface, model.bilateral);
        let mut promises = Projection::of(data, &best).promises(&excitation, &|_| true);
        promises.truncate(MAX_FULL_FITS);
        let fits = promises.par_iter().map(|promise| {
            let start: Vec<f64> = best.values.iter().chain(&promise.values).copied().collect();
            data.fit(&best.model.with(promise.term), &start, Effort::FULL)
        });
        let more = fits.min_by(|a, b| criterion(data, a).total_cmp(&criterion(data, b)));
        let Some(more) = more.filter(|more| criterion(data, more) < criterion(data, &best)) else { break };
        best = more;
    }
    best
}

fn criterion(data: &Data<'_>, fit: &Fit) -> f64 {
    let rows = data.rows().max(1) as f64;
    rows * (fit.energy / rows).max(f64::MIN_POSITIVE).ln() + fit.model.free_count() as f64 * rows.ln()
}
