//! Which terms are tried beside a model, and from where their search starts.

use super::criteria::{LEAST_GAIN, LEAST_GAIN_PER_VALUE, LEAST_SHARE};
use super::fit::{Effort, Fit, fit};
use super::likelihood::Data;
use super::model::{Model, NOMINAL, index};
use super::noise::Noise;
use super::order_spectrum::OrderSpectrum;
use super::ripples::ripples;
use super::term::{Term, wavenumber};
use super::trial::DriveTrial;

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

/// Stribeck speeds, over the top speed, that a search starts from.
const STRIBECK_SPEEDS: [f64; 3] = [0.02, 0.08, 0.3];

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
        offer(Term::Stribeck, STRIBECK_SPEEDS.map(|part| vec![force, force, part * scales.speed]).to_vec());
        if !has("sublinear_friction") {
            offer(Term::Sublinear, vec![vec![force, 0.5]]);
        }
    }
    if !has("gravity_load") {
        // Friction that differs by direction holds it.
        if !base.model.terms.contains(&Term::AsymmetricCoulomb) {
            offer(Term::ConstantLoad, vec![vec![0.0]]);
        }
        let slow = [1.5, 4.0, 8.0].map(|turn| vec![0.0, 0.0, turn / scales.travel]).to_vec();
        offer(Term::AngleLoad, if scales.is_rotary { vec![vec![0.0; 3]] } else { slow });
    }
    if ripples(base).len() < MOST_RIPPLES {
        let pitches = OrderSpectrum::of(data, &scales, disturbance).pitches(PITCHES);
        offer(Term::Cogging, pitches.into_iter().map(|pitch| vec![0.0, 0.0, wavenumber(pitch)]).collect());
    }
    // How soon an effort accelerates is told by the inertia.
    if !has("effort_lag") && !scales.holds_inertia() {
        offer(Term::EffortLag, vec![vec![2.0 * scales.period_s], vec![10.0 * scales.period_s]]);
    }
    if !has("effort_saturation") {
        offer(Term::EffortLimit, vec![vec![0.95 * scales.peak_effort], vec![0.7 * scales.peak_effort]]);
        offer(Term::SmoothLimit, vec![vec![scales.peak_effort]]);
    }
    let every = |has: fn(&DriveTrial) -> bool| data.trials.iter().all(has);
    let is_borne = every(|trial| trial.force.is_some() || trial.load.is_some());
    // Under a weight that stays the same it is Coulomb friction, and under one that changes little hardly another: it is looked for beside that.
    let is_carried = rubs && base.model.terms.contains(&Term::AngleLoad);
    if (is_borne || is_carried) && !has("load_dependent_friction") {
        offer(Term::LoadFriction, vec![vec![0.02]]);
    }
    if every(|trial| trial.force.is_some()) {
        for (term, start) in
            [(Term::ForceGain, 0.0), (Term::ForceDelay, 0.0), (Term::ToolInertia, 0.01 * base.values[index::INERTIA])]
        {
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
            let best = fits.max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood))?;
            Some(accompanied(data, base, best))
        })
        .collect();
    found.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    found
}

/// Ways over which friction builds up, over the travel, that a search starts from.
const PRESLIDING_STARTS: [f64; 2] = [1e-2, 1e-4];

/// `fit`, of which the last term is new beside `base`, with what belongs to dry friction where that is the term.
fn accompanied(data: &Data<'_>, base: &Fit, fit: Fit) -> Fit {
    let rubs = fit.model.terms.last().is_some_and(Term::is_friction);
    if rubs && is_likelier(&fit, base) { whole_friction(data, fit) } else { fit }
}

/// `fit`, with what belongs to its dry friction where the likelihood asks for it: a step of the friction that grows with the speed, and the
/// way over which it builds up.
#[must_use]
pub fn whole_friction(data: &Data<'_>, mut fit: Fit) -> Fit {
    let has = |name: &str| fit.model.has(name);
    if has("sublinear_friction") && !has("coulomb_friction") && !has("stribeck_friction") {
        // To its end first: else the step would be taken for what only more steps of the search gain.
        fit = self::fit(data, &fit.model, &fit.values, fit.noise, Effort::FULL);
        let step = 0.01 * fit.model.scales.effort;
        fit = likeliest_with(data, fit, &Term::Coulomb, &[step]);
    }
    if fit.model.terms.iter().any(Term::is_friction) { building_up(data, fit) } else { fit }
}

/// `fit`, which has dry friction, with the way over which that builds up where the likelihood asks for it.
#[must_use]
pub fn building_up(data: &Data<'_>, fit: Fit) -> Fit {
    if fit.model.terms.contains(&Term::Presliding) {
        return fit;
    }
    let ways = PRESLIDING_STARTS.map(|part| part * fit.model.scales.travel);
    let more = likeliest_with(data, fit.clone(), &Term::Presliding, &ways);
    if belongs(data, &more, &fit) { more } else { fit }
}

/// Whether the way over which friction builds up, which `more` has beside `less`, is worth its value: as of a term that is told, the
/// likelihood speaks for it, and it takes its share of the unexplained power.
#[must_use]
pub fn belongs(data: &Data<'_>, more: &Fit, less: &Fit) -> bool {
    let density = |fit: &Fit| data.unexplained_density(&fit.model, &fit.noise);
    is_likelier(more, less) && density(more) < (1.0 - LEAST_SHARE) * density(less)
}

/// `less`, or the same with `term` from the likeliest of `starts` where that is worth its value.
fn likeliest_with(data: &Data<'_>, less: Fit, term: &Term, starts: &[f64]) -> Fit {
    let model = less.model.with(term.clone());
    let fits = starts.iter().map(|start| {
        let values = [less.values.as_slice(), &[*start]].concat();
        fit(data, &model, &values, less.noise, Effort::QUICK)
    });
    let best = fits.max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
    best.filter(|best| is_likelier(best, &less) && idle_friction(best).is_none()).unwrap_or(less)
}

/// A term that belongs to dry friction and ended where its search did: a way over which friction builds up, or a step of the friction that
/// grows with the speed. The rest of the friction is what it is without it.
#[must_use]
pub fn idle_friction(fit: &Fit) -> Option<usize> {
    let ranges = fit.model.ranges();
    let is_idle = |at: &usize| {
        let own = fit.model.values_of(*at).start;
        match fit.model.terms[*at] {
            Term::Presliding => ranges[own].is_at_end(fit.values[own]),
            Term::Coulomb => fit.model.has("sublinear_friction") && ranges[own].is_at_end(fit.values[own]),
            _ => false,
        }
    };
    (0..fit.model.terms.len()).find(is_idle)
}

/// Whether the likelihood alone speaks for `more` and the values that it has beside those of `less`.
#[must_use]
pub fn is_likelier(more: &Fit, less: &Fit) -> bool {
    let values = more.values.len().saturating_sub(less.values.len());
    pays_for(values, more.log_likelihood - less.log_likelihood)
}

/// Whether a gain of log likelihood, nats, is worth as many more values.
#[must_use]
pub fn pays_for(values: usize, gain: f64) -> bool {
    gain > LEAST_GAIN + (LEAST_GAIN_PER_VALUE * values.max(1) as f64).value()
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
    given[..NOMINAL].copy_from_slice(&[scales.inertia, scales.viscous, 0.3 * scales.period_s, 0.0]);
    let little = Noise { ln_disturbance: scales.starting_density().ln(), ..base.noise };
    vec![(fitted, base.noise), (given, little)]
}

/// `fit` with Stribeck friction in the place of Coulomb friction, its term `at`, and values to start from.
#[must_use]
pub fn stribeck_for(fit: &Fit, at: usize) -> [(Model, Vec<f64>); STRIBECK_SPEEDS.len()] {
    let own = fit.model.values_of(at);
    STRIBECK_SPEEDS.map(|part| {
        let (mut model, mut values) = (fit.model.clone(), fit.values.clone());
        model.terms[at] = Term::Stribeck;
        let level = values[own.start];
        values.splice(own.clone(), [level, 0.3 * level, part * fit.model.scales.speed]);
        (model, values)
    })
}

/// A model's own copy without term `at`, or with a simpler law in its place, and values to start from.
#[must_use]
pub fn simpler(fit: &Fit, at: usize) -> Vec<(Model, Vec<f64>)> {
    let own = fit.model.values_of(at);
    let other_rub = |term: &Term| matches!(term, Term::Coulomb | Term::AsymmetricCoulomb | Term::Stribeck);
    let replaced = |term: Term, values: &[f64]| {
        let mut model = fit.model.clone();
        model.terms[at] = term;
        let mut all = fit.values.clone();
        all.splice(own.clone(), values.iter().copied());
        (model, all)
    };
    let values = &fit.values[own.clone()];
    let mut all = match &fit.model.terms[at] {
        Term::AsymmetricCoulomb => vec![replaced(Term::Coulomb, &[0.5 * (values[0] + values[1])])],
        Term::Stribeck => vec![replaced(Term::Coulomb, &[values[0] + 0.3 * values[1]])],
        Term::Sublinear if !fit.model.terms.iter().any(other_rub) => vec![replaced(Term::Coulomb, &[0.5 * values[0]])],
        Term::AngleLoad => vec![replaced(Term::ConstantLoad, &[0.0])],
        Term::Ripples(count) => {
            let fewer = if *count == 2 { Term::Cogging } else { Term::Ripples(count - 1) };
            let without = |wave: usize| [&values[..3 * wave], &values[3 * (wave + 1)..]].concat();
            (0..*count).rev().map(|wave| replaced(fewer.clone(), &without(wave))).collect()
        }
        Term::Play(side) => {
            vec![replaced(Term::Compliance(*side), &[0.1 * values[0], values[1], values[2], values[4]])]
        }
        _ => Vec::new(),
    };
    // The step of a friction that grows with the speed came with it.
    if !(other_rub(&fit.model.terms[at]) && fit.model.has("sublinear_friction")) {
        all.push(fit.model.without(at, &fit.values));
    }
    all
}
