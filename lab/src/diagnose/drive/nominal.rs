//! The law that a rig file states of its drive, and its refitted values.

use super::candidates::building_up;
use super::criteria::{LATEST_ROWS, LATEST_S, LOWEST_BAND_HZ, MOST_LIMITED_TIME, STRONGEST_SMOOTH_LIMIT};
use super::fit::{Effort, Fit, fit};
use super::held_out::{missing_forces, rms};
use super::law::Side;
use super::levenberg_marquardt::Ended;
use super::likelihood::Data;
use super::model::{Model, index};
use super::named::known;
use super::noise::Noise;
use super::scales::Scales;
use super::term::Term;
use super::trial::DriveTrial;
use crate::bound::Bound;
use crate::diagnose::quantile::quantile;
use crate::effects::Resolved;

/// What a rig file says of a drive.
#[derive(Clone)]
pub struct NominalDrive {
    /// kg or kg m^2.
    pub inertia: f64,
    /// Factor by which the drive's inertia may differ from that; 1: not at all.
    pub inertia_factor: f64,
    /// N s/m or N m s/rad.
    pub viscous: f64,
    /// Whether positions are angles.
    pub is_rotary: bool,
    /// On which side of the transmission the encoder sits, where that is known.
    pub encoder: Option<Side>,
    /// Step of the encoder, m or rad; zero where it is not known.
    pub resolution: f64,
    /// Effects that it already holds: nominal, and refitted like the other values.
    pub effects: Vec<Resolved>,
}

/// Fewest encoder rows that a drive is identified from.
const FEWEST_ROWS: usize = 200;

/// Inertia and viscous friction that `trials` teach; `None` where they show no motion.
#[must_use]
pub fn refitted(trials: &[DriveTrial], rig: &NominalDrive) -> Option<[f64; 2]> {
    let scales = scales(trials, rig)?;
    let variance = encoder_variance(trials, &scales);
    let data = Data { trials, least_encoder_variance: 0.3 * variance };
    let fit = nominal_fit(&data, rig, scales, variance)?;
    Some([fit.values[index::INERTIA], fit.values[index::VISCOUS]])
}

/// Missing force of `trials` under the values of `rig`, a column a trial, seen up to 5 Hz; the effort's delay alone is fitted.
/// `None` where they show no motion.
#[must_use]
pub fn missing_under(trials: &[DriveTrial], rig: &NominalDrive) -> Option<Vec<Vec<f64>>> {
    let scales = scales(trials, rig)?;
    let variance = encoder_variance(trials, &scales);
    let data = Data { trials, least_encoder_variance: 0.3 * variance };
    let (model, effects) = law_of(trials, rig, scales);
    let band = LOWEST_BAND_HZ.value().min(0.1 / scales.period_s);
    let noise =
        Noise { ln_disturbance: 0.0, ln_encoder: variance.ln() }.with_crossing(band, scales.period_s, rig.inertia);
    let under = |[rows, averaging]: &[f64; 2]| {
        let values = [&[rig.inertia, rig.viscous, rows * scales.period_s, *averaging], effects.as_slice()].concat();
        let fit = Fit { model: model.clone(), values, noise, log_likelihood: 0.0, ended: Ended::Converged };
        missing_forces(&data, &fit, &noise)
    };
    EFFORT_STARTS.iter().map(under).min_by(|a, b| rms(a).total_cmp(&rms(b)))
}

/// Sizes of `trials`; `None` where they show no motion.
#[must_use]
pub fn scales(trials: &[DriveTrial], rig: &NominalDrive) -> Option<Scales> {
    let rows: usize = trials.iter().map(DriveTrial::len).sum();
    let largest = |of: &dyn Fn(&DriveTrial) -> f64| trials.iter().map(of).fold(0.0, f64::max);
    let effort = largest(&|trial| deviation(&trial.net_effort()));
    let speed = largest(&|trial| usual_speed(trial));
    let position = || trials.iter().flat_map(|trial| trial.position.iter());
    let lowest = position().copied().fold(f64::INFINITY, f64::min);
    let travel = position().copied().fold(f64::NEG_INFINITY, f64::max) - lowest;
    let moves = rows >= FEWEST_ROWS && effort > 0.0 && speed > 0.0 && travel > 0.0;
    moves.then(|| Scales {
        effort,
        peak_effort: largest(&|trial| trial.effort.iter().fold(0.0, |peak: f64, effort| peak.max(effort.abs()))),
        usual_effort: usual_effort(trials).min(below_stated_limit(rig)),
        speed,
        travel,
        lowest,
        period_s: trials[0].period_s,
        recorded_period_s: trials[0].recorded_period_s,
        latest_effort_s: latest_effort_s(trials[0].period_s),
        duration_s: largest(&DriveTrial::duration_s),
        inertia: rig.inertia,
        inertia_factor: rig.inertia_factor,
        viscous: rig.viscous,
        resolution: rig.resolution.max(1e-6 * travel),
        is_rotary: rig.is_rotary,
        touches: trials.iter().all(|trial| trial.force.is_some()),
    })
}

/// Size of effort that is passed for [`MOST_LIMITED_TIME`].
fn usual_effort(trials: &[DriveTrial]) -> f64 {
    let sizes = trials.iter().flat_map(|trial| &trial.effort).map(|effort| effort.abs()).collect();
    quantile(sizes, (1.0 - MOST_LIMITED_TIME).value()).unwrap_or(0.0)
}

/// What the effort may usually be under the limit that the rig file states, so that the search begins no higher; infinite where it states none.
fn below_stated_limit(rig: &NominalDrive) -> f64 {
    let limits = rig.effects.iter().filter(|effect| effect.effect.spec().name == "effort_saturation");
    let below =
        |effect: &Resolved| effect.values[0] / if effect.form == 0 { 1.0 } else { STRONGEST_SMOOTH_LIMIT.value() };
    limits.map(below).fold(f64::INFINITY, f64::min)
}

/// Greatest mean speed over some rows.
fn usual_speed(trial: &DriveTrial) -> f64 {
    const ROWS: usize = 8;
    let spans = trial.position.windows(ROWS + 1).zip(trial.time.windows(ROWS + 1));
    spans.map(|(x, t)| ((x[ROWS] - x[0]) / (t[ROWS] - t[0])).abs()).fold(0.0, f64::max)
}

/// Standard deviation of `values`, in their unit.
#[must_use]
pub fn deviation(values: &[f64]) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Variance of the encoder, m^2 or rad^2: that of the quietest trial, and no less than a third of what rounding to the encoder's
/// step leaves.
#[must_use]
pub fn encoder_variance(trials: &[DriveTrial], scales: &Scales) -> f64 {
    let white = trials.iter().map(DriveTrial::encoder_variance).fold(f64::INFINITY, f64::min);
    white.max(0.3 * scales.resolution.powi(2) / 12.0)
}

/// Delays of the effort that the nominal fit starts from, in rows, and its averaging, rows^2: the likelihood has a corner at whole rows. A mean about
/// its own row is early by half a row beside what is held from there.
const EFFORT_STARTS: [[f64; 2]; 4] = [[-0.5, 0.25], [0.01, 0.0], [0.5, 0.0], [2.5, 0.0]];

/// Latest effort that counts as a late recording, s.
fn latest_effort_s(period_s: f64) -> f64 {
    let of_rows = LATEST_ROWS.value() * period_s;
    Bound::of(LATEST_S).max(of_rows).min(3.0 * of_rows).value()
}

/// `nominal` with an effort that acts within a recorded row of its own, and the same with a first-order lag, where the effort is later
/// than that; `None` where it is not.
#[must_use]
pub fn punctual_and_lagged(
    data: &Data<'_>,
    rig: &NominalDrive,
    nominal: &Fit,
    encoder_variance: f64,
) -> Option<[Fit; 2]> {
    let recorded = data.trials[0].recorded_period_s;
    let delay = nominal.values[index::DELAY];
    if delay <= recorded || nominal.model.has("effort_lag") || nominal.model.scales.holds_inertia() {
        return None;
    }
    let scales = Scales { latest_effort_s: recorded, ..nominal.model.scales };
    let punctual = nominal_fit(data, rig, scales, encoder_variance)?;
    let start = [nominal.values.as_slice(), &[delay]].concat();
    let lagged = fit(data, &punctual.model.with(Term::EffortLag), &start, nominal.noise, Effort::FULL);
    Some([punctual, lagged])
}

/// The law that `rig` states of `trials`, with the values of its effects and the factor of a given load.
fn law_of(trials: &[DriveTrial], rig: &NominalDrive, scales: Scales) -> (Model, Vec<f64>) {
    let encoder = rig.encoder.unwrap_or(Side::Load);
    let load = trials.iter().any(|trial| trial.load.is_some()).then(|| (Term::LoadScale, vec![1.0]));
    let effects = rig.effects.iter().filter_map(|effect| known(effect, &scales, encoder));
    let (terms, values): (Vec<Term>, Vec<Vec<f64>>) = effects.chain(load).unzip();
    (Model { terms, scales }, values.concat())
}

/// The law that `rig` states, its values refitted; `None` where nothing could be.
#[must_use]
pub fn nominal_fit(data: &Data<'_>, rig: &NominalDrive, scales: Scales, encoder_variance: f64) -> Option<Fit> {
    let (model, effects) = law_of(data.trials, rig, scales);
    let noise = Noise { ln_disturbance: scales.starting_density().ln(), ln_encoder: encoder_variance.ln() };
    let fits = EFFORT_STARTS.map(|[rows, averaging]| {
        let start = [&[scales.inertia, scales.viscous, rows * scales.period_s, averaging], effects.as_slice()].concat();
        fit(data, &model, &start, noise, Effort::FULL)
    });
    let best = fits.into_iter().max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood))?;
    let best = if best.model.terms.iter().any(Term::is_friction) { building_up(data, best) } else { best };
    best.log_likelihood.is_finite().then_some(best)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{TestDrive, nominal};
    use super::*;
    use crate::effects::find;

    /// Efforts of 0.01 to 4 N, of whatever sign: a quarter of them passes 3 N. A limit that the rig file states is one however often it is passed.
    #[test]
    fn what_a_quarter_of_the_efforts_pass_bounds_a_limit_that_is_looked_for() {
        let mut trial = TestDrive::PLAIN.trial(0.4, 1);
        let rows = trial.effort.len();
        trial.effort = (0..rows).map(|row| (row % 400 + 1) as f64 * if row % 2 == 0 { 0.01 } else { -0.01 }).collect();
        let found = |rig: &NominalDrive| scales(std::slice::from_ref(&trial), rig).expect("it moves").usual_effort;
        let rig = nominal(0.8, 4.0);
        // A row more or less: 0.01 N.
        assert!((found(&rig) - 3.0).abs() < 0.015, "{}", found(&rig));
        let effect = find("effort_saturation").expect("an effect of the list");
        let stated = |form: usize, limit: f64| vec![Resolved { effect, form, values: vec![limit] }];
        assert_eq!(found(&NominalDrive { effects: stated(0, 1.5), ..rig.clone() }), 1.5);
        assert_eq!(found(&NominalDrive { effects: stated(1, 1.5), ..rig.clone() }), 0.75);
        assert!(found(&NominalDrive { effects: stated(0, 5.0), ..rig }) > 2.9);
    }
}
