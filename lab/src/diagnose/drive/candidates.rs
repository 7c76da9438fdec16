//! Which terms are tried beside a model, and from where their search starts.

use rayon::prelude::*;

use super::fit::{Data, Effort, Fit, fit};
use super::model::{Model, NOMINAL, index};
use super::noise::Noise;
use super::term::{Scales, Term, wavenumber};

/// A term and the values that its search starts from.
pub struct Candidate {
    /// What is tried.
    pub term: Term,
    /// A search starts at each.
    pub starts: Vec<Vec<f64>>,
}

/// Share of the effort that a load or a friction starts from.
const FORCE_START: f64 = 0.03;

/// Pitches of the way that are tried.
const PITCHES: usize = 3;

/// Ripples that a model may hold.
const MOST_RIPPLES: usize = 2;

/// The terms of one body that may stand beside those of `base`; `disturbance` is its smoothed disturbance, a column a trial.
#[must_use]
pub fn one_body(data: &Data<'_>, base: &Fit, disturbance: &[Vec<f64>]) -> Vec<Candidate> {
    let scales = base.model.scales;
    let has = |name: &str| base.model.has(name);
    let force = FORCE_START * scales.effort;
    let mut all = Vec::new();
    let mut offer = |term: Term, starts: Vec<Vec<f64>>| all.push(Candidate { term, starts });
    let rubs = has("coulomb_friction") || has("stribeck_friction");
    if rubs {
        if !has("sublinear_friction") {
            offer(Term::Sublinear, vec![vec![force, 0.6]]);
        }
    } else {
        offer(Term::Coulomb, vec![vec![force]]);
        offer(Term::Stribeck, [0.02, 0.08, 0.3].map(|part| vec![force, force, part * scales.speed]).to_vec());
    }
    if !has("gravity_load") {
        offer(Term::ConstantLoad, vec![vec![0.0]]);
        let slow = [1.5, 4.0, 8.0].map(|turn| vec![0.0, 0.0, turn / scales.travel]).to_vec();
        offer(Term::AngleLoad, if scales.is_rotary { vec![vec![0.0; 3]] } else { slow });
    }
    if base.model.terms.iter().filter(|term| **term == Term::Cogging).count() < MOST_RIPPLES {
        let pitches = repeating_pitches(data, &scales, disturbance);
        offer(Term::Cogging, pitches.into_iter().map(|pitch| vec![0.0, 0.0, wavenumber(pitch)]).collect());
    }
    if !has("effort_lag") {
        offer(Term::EffortLag, vec![vec![2.0 * scales.period_s], vec![10.0 * scales.period_s]]);
    }
    if !has("effort_saturation") {
        offer(Term::EffortLimit, vec![vec![0.95 * scales.peak_effort], vec![0.7 * scales.peak_effort]]);
    }
    if data.trials.iter().all(|trial| trial.force.is_some()) {
        for (term, start) in [
            (Term::LoadFriction, 0.02),
            (Term::ForceGain, 0.0),
            (Term::ForceDelay, 0.0),
            (Term::ToolInertia, 0.01 * base.values[index::INERTIA]),
        ] {
            if !has(term.name()) {
                offer(term, vec![vec![start]]);
            }
        }
    }
    all
}

/// Fits `base` with each candidate from each of its starts, quickly; the best start of each term, the most likely first.
#[must_use]
pub fn tried(data: &Data<'_>, base: &Fit, candidates: Vec<Candidate>) -> Vec<Fit> {
    let mut found: Vec<Fit> = candidates
        .into_iter()
        .filter_map(|candidate| {
            let model = base.model.with(candidate.term);
            let starts = candidate.starts.iter().flat_map(|own| starting_points(base, own));
            let fits = starts.map(|(start, noise)| fit(data, &model, &start, noise, Effort::QUICK));
            fits.max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood))
        })
        .collect();
    found.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    found
}

/// ln of the factor by which a fitted inertia may differ from the rig file's before the search starts from the latter, too.
const INERTIA_MOVED: f64 = 0.15;

/// The values and noise of `base` with `own` behind them; where much is missing the fitted nominal values can lie far off, and those of
/// the rig file, with little disturbance, are a start of their own.
fn starting_points(base: &Fit, own: &[f64]) -> Vec<(Vec<f64>, Noise)> {
    let scales = &base.model.scales;
    let fitted = [base.values.as_slice(), own].concat();
    if (base.values[index::INERTIA] / scales.inertia).ln().abs() <= INERTIA_MOVED {
        return vec![(fitted, base.noise)];
    }
    let mut given = fitted.clone();
    given[..NOMINAL].copy_from_slice(&[scales.inertia, scales.viscous, 0.3 * scales.period_s]);
    let little = Noise { ln_disturbance: scales.starting_density().ln(), ..base.noise };
    vec![(fitted, base.noise), (given, little)]
}

/// Cells of the finest pitch that the way is divided into.
const CELLS_PER_PITCH: f64 = 6.0;
const MOST_CELLS: f64 = 24_000.0;
const MOST_PITCHES: f64 = 8_000.0;

/// The pitches along the way at which the disturbance repeats, the strongest first: a periodogram over the position.
fn repeating_pitches(data: &Data<'_>, scales: &Scales, disturbance: &[Vec<f64>]) -> Vec<f64> {
    let finest = (4.0 * scales.resolution).max(scales.travel / 4000.0);
    let cells = (scales.travel / finest * CELLS_PER_PITCH).clamp(64.0, MOST_CELLS) as usize;
    let width = scales.travel / (cells - 1) as f64;
    let (mut sums, mut counts) = (vec![0.0; cells], vec![0.0; cells]);
    for (trial, force) in data.trials.iter().zip(disturbance) {
        for (position, force) in trial.position.iter().zip(force) {
            let cell = (((position - scales.lowest) / width) as usize).min(cells - 1);
            sums[cell] += force;
            counts[cell] += 1.0;
        }
    }
    let mean = sums.iter().sum::<f64>() / counts.iter().sum::<f64>().max(1.0);
    let centred: Vec<(f64, f64)> = (0..cells)
        .filter(|cell| counts[*cell] > 0.0)
        .map(|cell| (cell as f64 * width, sums[cell] - mean * counts[cell]))
        .collect();
    let (first, spacing) = (2.0 / scales.travel, 0.4 / scales.travel);
    let lines = ((1.0 / finest - first) / spacing).clamp(0.0, MOST_PITCHES) as usize;
    let power: Vec<(f64, f64)> = (0..lines)
        .into_par_iter()
        .map(|line| {
            let pitch = 1.0 / (first + line as f64 * spacing);
            let turn = wavenumber(pitch);
            let (sine, cosine) = centred.iter().fold((0.0, 0.0), |(sine, cosine), (position, force)| {
                let (s, c) = (turn * position).sin_cos();
                (sine + force * s, cosine + force * c)
            });
            (pitch, sine * sine + cosine * cosine)
        })
        .collect();
    let mut peaks: Vec<(f64, f64)> =
        power.windows(3).filter(|w| w[1].1 >= w[0].1 && w[1].1 > w[2].1).map(|w| w[1]).collect();
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    peaks.truncate(PITCHES);
    peaks.into_iter().map(|(pitch, _)| pitch).collect()
}

/// A model's own copy without term `at`, or with a simpler law in its place, and values to start from.
#[must_use]
pub fn simpler(fit: &Fit, at: usize) -> Vec<(Model, Vec<f64>)> {
    let own = fit.model.values_of(at);
    let replaced = |term: Term, values: &[f64]| {
        let mut model = fit.model.clone();
        model.terms[at] = term;
        let mut all = fit.values.clone();
        all.splice(own.clone(), values.iter().copied());
        (model, all)
    };
    let values = &fit.values[own.clone()];
    let mut all = match &fit.model.terms[at] {
        Term::Stribeck => vec![replaced(Term::Coulomb, &[values[0] + 0.3 * values[1]])],
        Term::AngleLoad => vec![replaced(Term::ConstantLoad, &[0.0])],
        Term::Play(side) => {
            vec![replaced(Term::Compliance(*side), &[0.1 * values[0], values[1], values[2], values[4]])]
        }
        _ => Vec::new(),
    };
    let mut model = fit.model.clone();
    model.terms.remove(at);
    let mut rest = fit.values.clone();
    rest.drain(own);
    // Sub-linear friction is what dry and viscous friction leave: without them it would stand for both.
    if !model.has("sublinear_friction") || model.has("coulomb_friction") || model.has("stribeck_friction") {
        all.push((model, rest));
    }
    all
}
