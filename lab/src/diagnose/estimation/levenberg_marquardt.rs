//! Bounded nonlinear least squares of a model's values on whitened residuals: Levenberg and Marquardt's method.

use nalgebra::{DMatrix, DVector};

use super::whitener::Whitener;
use crate::diagnose::linalg::{dot, energy};
use crate::diagnose::model::{Channels, Model, Rest, Term, index};
use crate::diagnose::signals::filtered_trial::Trial;
use crate::effects::{Limit, Parameter, Place, Scene};

/// What is fitted to: trials, what their residuals are worth, and the rows that count.
#[derive(Clone, Copy)]
pub struct Data<'a> {
    /// Trials.
    pub trials: &'a [Trial],
    /// Floors.
    pub whitener: &'a Whitener,
    /// Whether each whitened row counts; all where absent.
    pub rows: Option<&'a [bool]>,
}

impl Data<'_> {
    /// Whitened residuals of `model` with `values`; zero where a row does not count.
    #[must_use]
    pub fn residual(&self, model: &Model, values: &[f64], channels: Channels) -> Vec<f64> {
        let rests: Vec<Rest> = self.trials.iter().map(|trial| model.rest(values, trial, channels)).collect();
        let mut white = self.whitener.white(&rests);
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
pub struct Axis {
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
pub struct Fit {
    /// One a parameter.
    pub values: Vec<f64>,
    /// Energy of the whitened residuals.
    pub energy: f64,
}

/// The axes of a model's values about `values`.
#[must_use]
pub fn axes(model: &Model, values: &[f64], scene: &Scene) -> Vec<Axis> {
    let (contact, drive) = (model.contact.is_some(), model.drive);
    let size = |at: usize, least: f64| values[at].abs().max(least).max(f64::MIN_POSITIVE);
    let stiff = if scene.depth > 0.0 { scene.force / scene.depth } else { 1.0 };
    let axis = |low: f64, high: f64, scale: f64, free: bool| Axis { low, high, scale, free };
    let loss = stiff * scene.depth / scene.speed.max(f64::MIN_POSITIVE);
    let push = scene.effort.max(scene.force);
    let late = 0.25 * scene.sample;
    let mut axes = vec![
        axis(0.0, 100.0 * stiff.max(scene.given_stiffness), size(index::STIFFNESS, 1e-3 * stiff), contact),
        axis(0.0, f64::INFINITY, size(index::DAMPING, 0.02 * loss), contact),
        axis(f64::NEG_INFINITY, f64::INFINITY, 0.1 * scene.depth.max(f64::MIN_POSITIVE), contact),
        axis(-late, late, late, contact),
        axis(
            0.25 * scene.given_inertia,
            4.0 * scene.given_inertia,
            size(index::INERTIA, 1e-3 * push / scene.acceleration.max(f64::MIN_POSITIVE)),
            drive,
        ),
        axis(0.0, f64::INFINITY, size(index::VISCOUS, 1e-2 * push / scene.speed.max(f64::MIN_POSITIVE)), drive),
        axis(-0.5 * scene.sample, 0.5 * scene.sample, 0.5 * scene.sample, drive),
    ];
    axes.extend(
        model.shifts.iter().map(|shift| axis(-shift, *shift, shift.max(f64::MIN_POSITIVE), contact && *shift > 0.0)),
    );
    for (at, term) in model.terms.iter().enumerate() {
        let start = model.start_of(at);
        for (offset, parameter) in term.all_parameters(model.trials()).iter().enumerate() {
            let value = values[start + offset];
            let scale = if value == 0.0 { 1e-3 } else { value.abs() };
            let (low, high) = reach_of(parameter, term, scene);
            axes.push(axis(low, high, scale, !parameter.fixed));
        }
    }
    axes
}

/// Least and greatest value that a recording can show.
fn reach_of(parameter: &Parameter, term: &Term, scene: &Scene) -> (f64, f64) {
    let (low, high) = (parameter.low, parameter.high);
    match parameter.limit {
        Limit::Card => (low, high),
        Limit::Step => (low.max(2.0 * scene.step), high),
        Limit::Range if term.effect.card().place == Place::Drive => (0.15 * scene.effort, high),
        Limit::Range => (0.15 * scene.force, high),
        Limit::Turns => (low.max(1.8 / scene.duration), high),
        Limit::Swing => (low.max(scene.inertia * scene.link_rate().powi(2)), high),
        Limit::Way => (low.max(2.0 * scene.resolution), high.min((scene.travel.1 - scene.travel.0) / 1.4)),
        Limit::Pace => (low.max(scene.slowest()), high),
    }
}

/// Whether a value of `term`, which are the last of `values`, ended at an end of what the recordings can show: it is then not
/// shown by them.
#[must_use]
pub fn is_at_limit(term: &Term, trials: usize, values: &[f64], scene: &Scene) -> bool {
    let parameters = term.all_parameters(trials);
    let own = &values[values.len() - parameters.len()..];
    parameters.iter().zip(own).any(|(parameter, value)| {
        let (low, high) = reach_of(parameter, term, scene);
        parameter.limit != Limit::Card && (*value <= low * (1.0 + NUDGE) || *value >= high * (1.0 - NUDGE))
    })
}

/// Share of its scale by which a value is moved to see what it does.
const NUDGE: f64 = 1e-4;

/// Columns of derivatives of the whitened residual, by the free values that are not held by a bound.
#[must_use]
pub fn jacobian(data: &Data<'_>, model: &Model, values: &[f64], axes: &[Axis], base: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let mut moved = values.to_vec();
    let mut columns = Vec::new();
    for (at, axis) in axes.iter().enumerate().filter(|(_, axis)| axis.free) {
        let mut nudge = NUDGE * axis.scale;
        if values[at] + nudge > axis.high {
            nudge = -nudge;
        }
        moved[at] = values[at] + nudge;
        let channels = reach(model, at);
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
pub fn reach(model: &Model, at: usize) -> Channels {
    if at < index::INERTIA || (index::SHARED..model.nominals()).contains(&at) {
        // With a sensor effect, the force on the drive is told by the contact's law.
        return Channels { force: true, effort: model.senses() && model.drive };
    }
    if at < index::SHARED {
        return Channels { force: false, effort: true };
    }
    let owner = (0..model.terms.len()).rev().find(|&term| at >= model.start_of(term));
    match owner.map(|owner| model.terms[owner].effect.card().place) {
        Some(Place::Contact) => reach(model, index::STIFFNESS),
        Some(place) => model.reach(place),
        None => Channels::BOTH,
    }
}

/// Steps at most.
const MOST_STEPS: usize = 40;

/// Damping beyond which no step is left to try.
const MOST_DAMPING: f64 = 1e6;

/// The values that leave the least, searched from `start`.
#[must_use]
pub fn fit(data: &Data<'_>, model: &Model, start: &[f64], scene: &Scene) -> Fit {
    search(data, model, start, scene, 0.0)
}

/// The same of a part of the data: what the part does not tell stays at `start`. A value of an effect that moved by all of
/// its scale counts as one of energy.
#[must_use]
pub fn fit_part(data: &Data<'_>, model: &Model, start: &[f64], scene: &Scene) -> Fit {
    search(data, model, start, scene, 1.0)
}

fn search(data: &Data<'_>, model: &Model, start: &[f64], scene: &Scene, hold: f64) -> Fit {
    let mut values = start.to_vec();
    let mut axes = axes(model, &values, scene);
    clamp(&mut values, &axes);
    let base = data.residual(model, &values, Channels::BOTH);
    let anchor = Anchor::of(model, &values, &axes, hold);
    let left = energy(&base) + anchor.energy(&values);
    let mut search = Search { data, model, values, base, energy: left, damping: 1e-3, anchor };
    for _ in 0..MOST_STEPS {
        for (axis, fresh) in axes.iter_mut().zip(self::axes(model, &search.values, scene)) {
            // A scale that follows its value to nothing would end the search there.
            axis.scale = fresh.scale.max(0.05 * axis.scale);
        }
        let before = search.energy;
        if !search.step(&axes) || before - search.energy <= 1e-6 * search.energy + 1e-3 {
            break;
        }
    }
    Fit { energy: search.energy - search.anchor.energy(&search.values), values: search.values }
}

/// Where values are held, and how firmly.
pub struct Anchor {
    /// One a value.
    pub place: Vec<f64>,
    /// Energy of a unit away from there.
    pub weight: Vec<f64>,
}

/// Energy that a clock's fraction of a sample costs at its bound: it is not to move for nothing, for a damper does nearly
/// the same.
const CLOCK: f64 = 9.0;

impl Anchor {
    /// Clocks at zero; values of effects at `values`, where `hold` is the energy of one that moved by its scale.
    pub fn of(model: &Model, values: &[f64], axes: &[Axis], hold: f64) -> Self {
        let held = |at: usize| match at {
            index::FORCE_TIMING | index::EFFORT_TIMING => (0.0, CLOCK / axes[at].high.powi(2)),
            _ if at < model.nominals() => (values[at], 0.0),
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
struct Search<'a> {
    data: &'a Data<'a>,
    model: &'a Model,
    values: Vec<f64>,
    base: Vec<f64>,
    energy: f64,
    damping: f64,
    anchor: Anchor,
}

impl Search<'_> {
    /// Goes one step to values that leave less; false where there are none.
    fn step(&mut self, axes: &[Axis]) -> bool {
        let columns = jacobian(self.data, self.model, &self.values, axes, &self.base);
        let Anchor { place, weight } = &self.anchor;
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
        while self.damping <= MOST_DAMPING {
            let mut damped = normal.clone();
            (0..n).for_each(|i| damped[(i, i)] += self.damping * normal[(i, i)] + 1e-12 * greatest);
            if let Some(solved) = damped.cholesky().map(|factors| factors.solve(&right)) {
                let mut next = self.values.clone();
                (0..n).for_each(|i| {
                    next[columns[moving[i]].0] += (solved[i] * scale(i)).clamp(-3.0 * scale(i), 3.0 * scale(i));
                });
                clamp(&mut next, axes);
                if self.take(next) {
                    return true;
                }
            }
            self.damping = (self.damping * 6.0).max(1e-9);
        }
        false
    }

    /// Moves to `next` if it leaves less.
    fn take(&mut self, next: Vec<f64>) -> bool {
        let rest = self.data.residual(self.model, &next, Channels::BOTH);
        let fresh = energy(&rest) + self.anchor.energy(&next);
        let better = fresh < self.energy;
        if better {
            (self.values, self.base, self.energy) = (next, rest, fresh);
            self.damping = (self.damping * 0.2).max(1e-9);
        }
        better
    }
}

fn clamp(values: &mut [f64], axes: &[Axis]) {
    for (value, axis) in values.iter_mut().zip(axes) {
        *value = value.clamp(axis.low, axis.high);
    }
}
