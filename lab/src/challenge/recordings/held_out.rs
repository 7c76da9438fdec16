//! What a model leaves of trials that it never saw, every value of it frozen.
//!
//! Where the surface lies is a matter of each trial (a sample is put on anew, a piston's pressure is set anew), not of the
//! physics: this one number is placed by least squares over the beginning of the trial, which is not scored. Nothing is
//! fitted to the rest, of which the root mean square is the score. Both models get the same treatment.

use anyhow::{Context as _, Result};

use crate::diagnose::contact::fit::{Data, Effort};
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::nominal::{law_of, nominal_fit};
use crate::diagnose::contact::prepare;
use crate::diagnose::contact::trial::ContactTrial;
use crate::diagnose::{drive, sensed};
use crate::effects;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// Share of a trial that places its surface.
const BEGINNING: f64 = 0.1;

/// The same where the tool is clamped: one of some five strokes, there and back.
const BEGINNING_CLAMPED: f64 = 0.2;

/// Share of its way that the force has to have gone by then, or there is no touch to place a surface by.
const TOUCHED: f64 = 0.2;

/// Surfaces that a placement starts from beside that of the rig, of the way from the least position to the greatest.
const STARTS: [f64; 4] = [0.1, 0.35, 0.6, 0.85];

/// The nominal law of `rig` with the values that `trials` teach: least squares, no effect added.
///
/// # Errors
/// Trials that the rig does not predict.
pub fn refitted(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<Rig> {
    let mut fresh = rig.clone();
    let known = effects::resolve_all(rig, origin)?;
    if let Some(contact) = fresh.contact.as_mut().filter(|_| prepare::is_recorded(rig, trials)) {
        let nominal = prepare::nominal(rig, known).context("a rig without a contact")?;
        let [fine, _] = contact_trials(rig, origin, trials)?;
        let fit = nominal_fit(&Data::new(&fine), &nominal);
        contact.stiffness = fit.values[index::STIFFNESS];
        contact.damping = fit.values[index::DAMPING];
        contact.surface = fit.values[index::SURFACE];
    } else if let Some(table) = &mut fresh.drive {
        let nominal = drive::prepare::nominal(rig, trials, known).context("a rig without a drive")?;
        let taught = drive::nominal::refitted(&drive::prepare::trials(rig, trials), &nominal);
        [table.inertia, table.viscous] = taught.context("trials in which nothing moves")?;
    }
    Ok(fresh)
}

fn contact_trials(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<[Vec<ContactTrial>; 2]> {
    let figures: Vec<Figures> = sensed(rig, origin, trials)?.iter().map(|trial| trial.figures).collect();
    Ok(prepare::trials(trials, &figures))
}

/// Root mean squares over the scored rows of `trials` that `models` leave.
///
/// # Errors
/// A trial that the rig does not predict, effects that cannot be, or no row to score.
pub fn left<const N: usize>(models: [&Rig; N], origin: &str, trials: &[Recording]) -> Result<[f64; N]> {
    let (mut sums, mut rows) = ([0.0; N], 0usize);
    for trial in trials {
        for (at, model) in models.iter().enumerate() {
            let scored = scored(model, origin, trial)?;
            sums[at] += scored.iter().map(|value| value * value).sum::<f64>();
            rows += if at == 0 { scored.len() } else { 0 };
        }
    }
    anyhow::ensure!(rows > 0, "no row of the trials kept back can be scored");
    Ok(sums.map(|sum| (sum / rows as f64).sqrt()))
}

/// Residuals of `rig` on the scored rows of one trial.
fn scored(rig: &Rig, origin: &str, trial: &Recording) -> Result<Vec<f64>> {
    let own = std::slice::from_ref(trial);
    let known = effects::resolve_all(rig, origin)?;
    if !prepare::is_recorded(rig, own) {
        let nominal = drive::prepare::nominal(rig, own, known).context("neither a contact nor a drive")?;
        let missing = drive::nominal::missing_under(&drive::prepare::trials(rig, own), &nominal);
        return Ok(missing.context("a trial in which nothing moves")?.concat());
    }
    let nominal = prepare::nominal(rig, known).context("a rig without a contact")?;
    let [fine, _] = contact_trials(rig, origin, own)?;
    let (model, given) = law_of(&fine, &nominal);
    let end = beginning(&fine[0], model.bilateral);
    // The surface alone is placed, by the beginning alone.
    let mut first = Data::new(&fine);
    first.weights[0][end..].fill(0.0);
    let [low, high] = model.scales.positions;
    let starts = STARTS.iter().filter(|_| !model.bilateral).map(|part| low + part * (high - low));
    let placed = std::iter::once(given[index::SURFACE]).chain(starts).map(|surface| {
        let mut start = given.clone();
        start[index::SURFACE] = surface;
        first.fit_holding(&model, &start, Effort::FULL, &|at| at != index::SURFACE)
    });
    let placed = placed.min_by(|a, b| a.energy.total_cmp(&b.energy)).context("no place to start from")?;
    let rest = first.residual(&model, &placed.values, 0);
    let counts = rest.iter().zip(&fine[0].counts).skip(end);
    Ok(counts.filter(|(_, counts)| **counts).map(|(value, _)| *value).collect())
}

/// The row at which the beginning ends.
fn beginning(trial: &ContactTrial, is_clamped: bool) -> usize {
    let share = if is_clamped { BEGINNING_CLAMPED } else { BEGINNING };
    let gone: Vec<f64> = trial.force.iter().map(|value| (value - trial.force[0]).abs()).collect();
    let most = gone.iter().fold(0.0, |most: f64, gone| most.max(*gone));
    let touched = gone.iter().position(|gone| *gone >= TOUCHED * most).unwrap_or(0);
    touched.max((share * trial.len() as f64) as usize)
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
        // Force is 1.6 N RMS in contact, two thirds of the time. The smoothed corner at the touch is left, in
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
