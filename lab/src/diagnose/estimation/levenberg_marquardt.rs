//! Bounded nonlinear least squares of a model's values on whitened residuals: Levenberg and Marquardt's method.

use nalgebra::{DMatrix, DVector};

use super::whitener::Whitener;
use crate::diagnose::linalg::{dot, energy};
use crate::diagnose::model::{Channels, Model, Residual, Term, index};
use crate::diagnose::signals::filtered_trial::AnalysisTrial;
use crate::diagnose::thresholds::levenberg_marquardt::{DIFFERENCE_STEP, MAX_DAMPING, MAX_ITERATIONS, TIMING_PENALTY};
use crate::effects::{ExcitationStats, Limit, Parameter, Place};

/// What is fitted to: trials, what their residuals are worth, and the rows that count.
#[derive(Clone, Copy)]
pub struct FitData<'a> {
    /// Trials.
    pub trials: &'a [AnalysisTrial],
    /// Floors.
    pub whitener: &'a Whitener,
    /// Whether each whitened row counts; all where absent.
    pub rows: Option<&'a [bool]>,
}

impl FitData<'_> {
    /// Whitened residuals of `model` with `values`; zero where a row does not count.
    #[must_use]
    pub fn residual(&self, model: &Model, values: &[f64], channels: Channels) -> Vec<f64> {
        let residuals: Vec<Residual> =
            self.trials.iter().map(|trial| model.residual(values, trial, channels)).collect();
        let mut white = self.whitener.whiten(&residuals);
        if let Some(rows) = self.rows {
            white.iter_mut().zip(rows).filter(|(_, counts)| !**counts).for_each(|(value, _)| *value = 0.0);
        }
        white
    }

    /// Their energy.
    #[must_use]
    pub fn energy(&self, model: &Model, values: &[f64]) -> f64 {
        energy(&self.residual(model, values, Channels::BOTH))
    }
}

/// How one value of a model may move.
#[derive(Debug, Clone, Copy)]
pub struct ParameterBounds {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// A change of the value that matters: the unit of its steps.
    pub scale: f64,
    /// Whether it moves at all.
    pub free: bool,
}

/// Values and what they leave.
#[derive(Debug, Clone)]
pub struct FitResult {
    /// One a parameter.
    pub values: Vec<f64>,
    /// Energy of the whitened residuals.
    pub energy: f64,
    /// How the search ended.
    pub termination: Termination,
}

/// How a search for the least residual ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Termination {
    /// The last step gained next to nothing.
    Converged,
    /// No step, however damped, leaves less.
    Stalled,
    /// The number of iterations ran out while steps still gained.
    IterationLimit,
}

/// The axes of a model's values about `values`.
#[must_use]
pub fn parameter_bounds(model: &Model, values: &[f64], excitation: &ExcitationStats) -> Vec<ParameterBounds> {
    let (contact, drive) = (model.contact.is_some(), model.drive);
    let size = |at: usize, least: f64| values[at].abs().max(least).max(f64::MIN_POSITIVE);
    let stiff = if excitation.depth > 0.0 { excitation.force / excitation.depth } else { 1.0 };
    let axis = |low: f64, high: f64, scale: f64, free: bool| ParameterBounds { low, high, scale, free };
    let loss = stiff * excitation.depth / excitation.speed.max(f64::MIN_POSITIVE);
    let push = excitation.effort.max(excitation.force);
    let late = 0.25 * excitation.sample;
    let mut axes = vec![
        axis(0.0, 100.0 * stiff.max(excitation.given_stiffness), size(index::STIFFNESS, 1e-3 * stiff), contact),
        axis(0.0, f64::INFINITY, size(index::DAMPING, 0.02 * loss), contact),
        axis(f64::NEG_INFINITY, f64::INFINITY, 0.1 * excitation.depth.max(f64::MIN_POSITIVE), contact),
        axis(-late, late, late, contact),
        axis(
            0.25 * excitation.given_inertia,
            4.0 * excitation.given_inertia,
            size(index::INERTIA, 1e-3 * push / excitation.acceleration.max(f64::MIN_POSITIVE)),
            drive,
        ),
        axis(0.0, f64::INFINITY, size(index::VISCOUS, 1e-2 * push / excitation.speed.max(f64::MIN_POSITIVE)), drive),
        axis(-0.5 * excitation.sample, 0.5 * excitation.sample, 0.5 * excitation.sample, drive),
    ];
    axes.extend(
        model
            .surface_shifts
            .iter()
            .map(|shift| axis(-shift, *shift, shift.max(f64::MIN_POSITIVE), contact && *shift > 0.0)),
    );
    for (at, term) in model.terms.iter().enumerate() {
        let start = model.first_value_of(at);
        for (offset, parameter) in term.all_parameters(model.trials()).iter().enumerate() {
            let value = values[start + offset];
            let scale = if value == 0.0 { 1e-3 } else { value.abs() };
            let (low, high) = identifiable_range(parameter, term, excitation);
            axes.push(axis(low, high, scale, !parameter.fixed));
        }
    }
    axes
}

/// Least and greatest value that a recording can show.
fn identifiable_range(parameter: &Parameter, term: &Term, excitation: &ExcitationStats) -> (f64, f64) {
    let (low, high) = (parameter.low, parameter.high);
    match parameter.limit {
        Limit::BoundsOnly => (low, high),
        Limit::ResolvableTime => (low.max(2.0 * excitation.step), high),
        Limit::ReachedRange if term.effect.spec().place == Place::Drive => (0.15 * excitation.effort, high),
        Limit::ReachedRange => (0.15 * excitation.force, high),
        Limit::RepeatedCycles => (low.max(1.8 / excitation.duration), high),
        Limit::ResonanceInBand => (low.max(excitation.inertia * excitation.min_link_rate().powi(2)), high),
        Limit::RepeatedPitch => {
            (low.max(2.0 * excitation.resolution), high.min((excitation.travel.1 - excitation.travel.0) / 1.4))
        }
        Limit::MinSpeed => (low.max(excitation.slowest()), high),
    }
}

/// Whether a value of `term`, which are the last of `values`, ended at an end of what the recordings can show: it is then not
/// shown by them.
#[must_use]
pub fn is_at_limit(term: &Term, trials: usize, values: &[f64], excitation: &ExcitationStats) -> bool {
    let parameters = term.all_parameters(trials);
    let own = &values[values.len() - parameters.len()..];
    parameters.iter().zip(own).any(|(parameter, value)| {
        let (low, high) = identifiable_range(parameter, term, excitation);
        parameter.limit != Limit::BoundsOnly
            && (*value <= low * (1.0 + DIFFERENCE_STEP) || *value >= high * (1.0 - DIFFERENCE_STEP))
    })
}

/// Columns of derivatives of the whitened residual, by the free values that are not held by a bound.
#[must_use]
pub fn jacobian(
    data: &FitData<'_>,
    model: &Model,
    values: &[f64],
    axes: &[ParameterBounds],
    base: &[f64],
) -> Vec<(usize, Vec<f64>)> {
    let mut moved = values.to_vec();
    let mut columns = Vec::new();
    for (at, axis) in axes.iter().enumerate().filter(|(_, axis)| axis.free) {
        let mut nudge = DIFFERENCE_STEP * axis.scale;
        if values[at] + nudge > axis.high {
            nudge = -nudge;
        }
        moved[at] = values[at] + nudge;
        let channels = affected_channels(model, at);
        let there = data.residual(model, &moved, channels);
        moved[at] = values[at];
        let column = there.iter().zip(base).enumerate();
        let split = data.whitener.force_rows();
        let counts = |row: usize| if row < split { channels.force } else { channels.effort };
        columns.push((at, column.map(|(row, (a, b))| if counts(row) { (a - b) / nudge } else { 0.0 }).collect()));
    }
    columns
}

/// The channels that value `at` of `model` reaches.
#[must_use]
pub fn affected_channels(model: &Model, at: usize) -> Channels {
    if at < index::INERTIA || (index::SHARED..model.nominal_count()).contains(&at) {
        // With a sensor effect, the force on the drive is told by the contact's law.
        return Channels { force: true, effort: model.has_sensor_effect() && model.drive };
    }
    if at < index::SHARED {
        return Channels { force: false, effort: true };
    }
    let owner = (0..model.terms.len()).rev().find(|&term| at >= model.first_value_of(term));
    match owner.map(|owner| model.terms[owner].effect.spec().place) {
        Some(Place::Contact) => affected_channels(model, index::STIFFNESS),
        Some(place) => model.affected_channels(place),
        None => Channels::BOTH,
    }
}

/// The values that leave the least, searched from `start`.
#[must_use]
pub fn fit(data: &FitData<'_>, model: &Model, start: &[f64], excitation: &ExcitationStats) -> FitResult {
    search(data, model, start, excitation, 0.0)
}

/// The same of a part of the data: what the part does not tell stays at `start`. A value of an effect that moved by all of
/// its scale counts as one of energy.
#[must_use]
pub fn fit_with_prior(data: &FitData<'_>, model: &Model, start: &[f64], excitation: &ExcitationStats) -> FitResult {
    search(data, model, start, excitation, 1.0)
}

fn search(data: &FitData<'_>, model: &Model, start: &[f64], excitation: &ExcitationStats, hold: f64) -> FitResult {
    let mut values = start.to_vec();
    let mut axes = parameter_bounds(model, &values, excitation);
    clamp(&mut values, &axes);
    let base = data.residual(model, &values, Channels::BOTH);
    let anchor = GaussianPrior::of(model, &values, &axes, hold);
    let left = energy(&base) + anchor.energy(&values);
    let mut search = Iteration { data, model, values, base, energy: left, damping: 1e-3, anchor };
    let mut termination = Termination::IterationLimit;
    for _ in 0..MAX_ITERATIONS {
        for (axis, fresh) in axes.iter_mut().zip(self::parameter_bounds(model, &search.values, excitation)) {
            // A scale that follows its value to nothing would end the search there.
            axis.scale = fresh.scale.max(0.05 * axis.scale);
        }
        let before = search.energy;
        if !search.step(&axes) {
            termination = Termination::Stalled;
            break;
        }
        if before - search.energy <= 1e-6 * search.energy + 1e-3 {
            termination = Termination::Converged;
            break;
        }
    }
    FitResult { energy: search.energy - search.anchor.energy(&search.values), values: search.values, termination }
}

/// Where values are held, and how firmly.
pub struct GaussianPrior {
    /// One a value.
    pub place: Vec<f64>,
    /// Energy of a unit away from there.
    pub weight: Vec<f64>,
}

impl GaussianPrior {
    /// Clocks at zero; values of effects at `values`, where `hold` is the energy of one that moved by its scale.
    pub fn of(model: &Model, values: &[f64], axes: &[ParameterBounds], hold: f64) -> Self {
        let held = |at: usize| match at {
            index::FORCE_TIMING | index::EFFORT_TIMING => (0.0, TIMING_PENALTY / axes[at].high.powi(2)),
            _ if at < model.nominal_count() => (values[at], 0.0),
            _ => (values[at], hold / axes[at].scale.powi(2)),
        };
        let (place, weight) = (0..values.len()).map(held).unzip();
        Self { place, weight }
    }

    fn energy(&self, values: &[f64]) -> f64 {
        values.iter().zip(&self.place).zip(&self.weight).map(|((v, p), w)| w * (v - p).powi(2)).sum()
    }
}

/// The state of one search.
struct Iteration<'a> {
    data: &'a FitData<'a>,
    model: &'a Model,
    values: Vec<f64>,
    base: Vec<f64>,
    energy: f64,
    damping: f64,
    anchor: GaussianPrior,
}

impl Iteration<'_> {
    /// Goes one step to values that leave less; false where there are none.
    fn step(&mut self, axes: &[ParameterBounds]) -> bool {
        let columns = jacobian(self.data, self.model, &self.values, axes, &self.base);
        let GaussianPrior { place, weight } = &self.anchor;
        let slope: Vec<f64> = columns
            .iter()
            .map(|(at, column)| dot(column, &self.base) + weight[*at] * (self.values[*at] - place[*at]))
            .collect();
        // A value at its bound that would leave it stays.
        let moving: Vec<usize> = (0..columns.len())
            .filter(|&i| {
                let (value, axis) = (self.values[columns[i].0], &axes[columns[i].0]);
                !((value <= axis.low && slope[i] > 0.0) || (value >= axis.high && slope[i] < 0.0))
            })
            .collect();
        let scale = |i: usize| axes[columns[moving[i]].0].scale;
        let n = moving.len();
        let mut normal = DMatrix::zeros(n, n);
        for i in 0..n {
            for j in 0..=i {
                let value = dot(&columns[moving[i]].1, &columns[moving[j]].1) * scale(i) * scale(j);
                (normal[(i, j)], normal[(j, i)]) = (value, value);
            }
            normal[(i, i)] += weight[columns[moving[i]].0] * scale(i) * scale(i);
        }
        let right = DVector::from_fn(n, |i, _| -slope[moving[i]] * scale(i));
        let greatest = (0..n).map(|i| normal[(i, i)]).fold(f64::MIN_POSITIVE, f64::max);
        while self.damping <= MAX_DAMPING {
            let mut damped = normal.clone();
            (0..n).for_each(|i| damped[(i, i)] += self.damping * normal[(i, i)] + 1e-12 * greatest);
            if let Some(solved) = damped.cholesky().map(|factors| factors.solve(&right)) {
                let mut next = self.values.clone();
                (0..n).for_each(|i| {
                    next[columns[moving[i]].0] += (solved[i] * scale(i)).clamp(-3.0 * scale(i), 3.0 * scale(i));
                });
                clamp(&mut next, axes);
                if self.accept(next) {
                    return true;
                }
            }
            self.damping = (self.damping * 6.0).max(1e-9);
        }
        false
    }

    /// Moves to `next` if it leaves less.
    fn accept(&mut self, next: Vec<f64>) -> bool {
        let residual = self.data.residual(self.model, &next, Channels::BOTH);
        let fresh = energy(&residual) + self.anchor.energy(&next);
        let better = fresh < self.energy;
        if better {
            (self.values, self.base, self.energy) = (next, residual, fresh);
            self.damping = (self.damping * 0.2).max(1e-9);
        }
        better
    }
}

fn clamp(values: &mut [f64], axes: &[ParameterBounds]) {
    for (value, axis) in values.iter_mut().zip(axes) {
        *value = value.clamp(axis.low, axis.high);
    }
}
