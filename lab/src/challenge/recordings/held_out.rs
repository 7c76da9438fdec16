//! What a model leaves of trials that it never saw, every value of it frozen but those that belong to a trial.
//!
//! Where the surface lies and what the sensor reads without a force are a matter of each trial (a sample is put on anew, a piston's
//! pressure is set anew), and so is how stiff the body is where another piece or another spot of it was touched. These two or three
//! numbers are placed by least squares over the trial, as a diagnosis places them; nothing else is fitted, of the nominal law as of
//! the improved one.

use anyhow::{Context as _, Result};

use crate::diagnose::contact::data::Data;
use crate::diagnose::contact::model::index;
use crate::diagnose::contact::nominal::{law_of, nominal_fit};
use crate::diagnose::contact::prepare;
use crate::diagnose::contact::trial::ContactTrial;
use crate::diagnose::linalg::energy;
use crate::diagnose::{drive, sensed};
use crate::effects;
use crate::golden_section::least_between;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// What belongs to a trial, and not to the physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnToTrial {
    /// The contact point and the zero of the force.
    Place,
    /// And a factor of the force: another piece or spot of the body.
    PlaceAndScale,
}

/// The nominal law of `rig` with values fitted to `trials`: least squares, no effect added.
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
        let refitted = drive::nominal::refitted(&drive::prepare::trials(rig, trials), &nominal);
        [table.inertia, table.viscous] = refitted.context("trials in which nothing moves")?;
    }
    Ok(fresh)
}

fn contact_trials(rig: &Rig, origin: &str, trials: &[Recording]) -> Result<[Vec<ContactTrial>; 2]> {
    let figures: Vec<Figures> = sensed(rig, origin, trials)?.iter().map(|trial| trial.figures).collect();
    Ok(prepare::trials(trials, &figures))
}

/// Root mean squares over `trials` that `models` leave.
///
/// # Errors
/// A trial that the rig does not predict, effects that cannot be, or no row to score.
pub fn left<const N: usize>(
    models: [&Rig; N],
    origin: &str,
    trials: &[Recording],
    own: OwnToTrial,
) -> Result<[f64; N]> {
    let (mut sums, mut rows) = ([0.0; N], 0usize);
    for trial in trials {
        for (at, model) in models.iter().enumerate() {
            let scored = residual(model, origin, trial, own)?;
            sums[at] += scored.iter().map(|value| value * value).sum::<f64>();
            rows += if at == 0 { scored.len() } else { 0 };
        }
    }
    anyhow::ensure!(rows > 0, "no row of the trials kept back can be scored");
    Ok(sums.map(|sum| (sum / rows as f64).sqrt()))
}

/// Residuals of `rig` on the rows of one trial, what belongs to the trial placed.
fn residual(rig: &Rig, origin: &str, trial: &Recording, own: OwnToTrial) -> Result<Vec<f64>> {
    let alone = std::slice::from_ref(trial);
    let known = effects::resolve_all(rig, origin)?;
    if !prepare::is_recorded(rig, alone) {
        let nominal = drive::prepare::nominal(rig, alone, known).context("neither a contact nor a drive")?;
        let missing = drive::nominal::missing_under(&drive::prepare::trials(rig, alone), &nominal);
        return Ok(missing.context("a trial in which nothing moves")?.concat());
    }
    let nominal = prepare::nominal(rig, known).context("a rig without a contact")?;
    let [fine, _] = contact_trials(rig, origin, alone)?;
    let (model, given) = law_of(&fine, &nominal);
    let [low, high] = model.scales.positions;
    let [from, to] = if model.bilateral {
        [given[index::SURFACE] - (high - low), given[index::SURFACE] + (high - low)]
    } else {
        [low, high]
    };
    let placed = |surface: f64| {
        let mut values = given.clone();
        values[index::SURFACE] = surface;
        placed_residual(&fine[0], &model.predicted(&values, &fine[0], 0), own)
    };
    let step = (to - from) / SURFACE_GRID_POINTS as f64;
    let places = (0..=SURFACE_GRID_POINTS).map(|at| from + at as f64 * step).chain([given[index::SURFACE]]);
    let cost = |surface: f64| energy(&placed(surface));
    let nearest = places.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).context("no place to start from")?;
    Ok(placed(least_between([nearest - step, nearest + step], SURFACE_PRECISION * step, cost)))
}

/// Places of the surface that are compared over the way.
const SURFACE_GRID_POINTS: usize = 60;

/// Precision of the place between two of them, of their distance.
const SURFACE_PRECISION: f64 = 1e-6;

/// Measured less `predicted` force on the rows that count, with the zero of the force, and where it is the trial's own the scale, at
/// their best.
fn placed_residual(trial: &ContactTrial, predicted: &[f64], own: OwnToTrial) -> Vec<f64> {
    let rows =
        || trial.force.iter().zip(predicted).zip(&trial.counts).filter(|(_, counts)| **counts).map(|(pair, _)| pair);
    let count = rows().count().max(1) as f64;
    let [force, law] =
        [rows().map(|(force, _)| force).sum::<f64>() / count, rows().map(|(_, law)| law).sum::<f64>() / count];
    let product = |of: &dyn Fn(f64, f64) -> f64| rows().map(|(y, p)| of(y - force, p - law)).sum::<f64>();
    let scale = match own {
        OwnToTrial::Place => 1.0,
        OwnToTrial::PlaceAndScale => {
            let best = product(&|y, p| y * p) / product(&|_, p| p * p).max(f64::MIN_POSITIVE);
            best.clamp(MOST_SCALE.recip(), MOST_SCALE)
        }
    };
    rows().map(|(y, p)| y - force - scale * (p - law)).collect()
}

/// Factor in stiffness between two pieces, or two spots, of one body.
const MOST_SCALE: f64 = 3.0;

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
        let [right, stiff] =
            left([&rig(600.0), &rig(660.0)], "rig", std::slice::from_ref(&trial), OwnToTrial::Place).unwrap();
        // Force is 1.6 N RMS in contact, two thirds of the time. The smoothed corner at the touch is left, in
        // thousandths of it; a tenth of the stiffness is a tenth of the force, of which surface and zero take a part.
        assert!(right < 0.02, "{right}");
        assert!((0.04..0.2).contains(&stiff), "{stiff}");
        // Another spot of the body: the factor is the trial's, and the law right.
        let [_, scaled] =
            left([&rig(600.0), &rig(660.0)], "rig", std::slice::from_ref(&trial), OwnToTrial::PlaceAndScale).unwrap();
        assert!(scaled < 0.03, "{scaled}: the damper alone is a tenth too strong");
        // A stiffness that had been fitted would leave as little as the right one.
        let refitted = refitted(&rig(660.0), "rig", std::slice::from_ref(&trial)).unwrap();
        assert!((refitted.contact.unwrap().stiffness / 600.0 - 1.0).abs() < 0.01, "{refitted:?}");
        let [again, _] = left([&refitted, &rig(600.0)], "rig", &[trial], OwnToTrial::Place).unwrap();
        assert!(again < 0.02, "{again}");
    }
}
