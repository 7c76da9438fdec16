//! How much of what a model leaves an effect could take, by a first-order estimate from each of its starts.

use rayon::prelude::*;

use super::data::Data;
use super::fit::Fit;
use super::tones;
use crate::diagnose::linalg::{dot, remove, solve};
use crate::diagnose::term::Term;
use crate::effects::{self, ExcitationStats, Place, Start};

/// A start of an effect, with what it promises.
#[derive(Debug, Clone)]
pub struct Promise {
    /// Effect and form.
    pub term: Term,
    /// Squares of the weighted residual that it takes to first order.
    pub gain: f64,
    /// Its values in the model's layout.
    pub values: Vec<f64>,
}

/// Part of a direction that has to be left beside the model's own values: what is less is rounding.
const LEAST_ORTHOGONAL: f64 = 1e-6;

/// A model's residual, freed of what its own values could still take.
pub struct Projection<'a> {
    data: &'a Data<'a>,
    fit: &'a Fit,
    base: Vec<f64>,
    free: Vec<f64>,
    tangent: Vec<Vec<f64>>,
}

impl<'a> Projection<'a> {
    /// Of `fit`.
    #[must_use]
    pub fn of(data: &'a Data<'a>, fit: &'a Fit) -> Self {
        let base = data.weighted_residual(&fit.model, &fit.values);
        let ranges = fit.model.ranges(&fit.values);
        let open = |at: &usize| {
            let (range, value) = (&ranges[*at], fit.values[*at]);
            range.free && value > range.low && value < range.high
        };
        let open: Vec<usize> = (0..fit.values.len()).filter(open).collect();
        let mut tangent: Vec<Vec<f64>> = Vec::new();
        for mut column in data.columns(&fit.model, &fit.values, &ranges, &open, &base) {
            let before = dot(&column, &column);
            // Twice: once leaves what rounding made of it.
            tangent.iter().for_each(|unit| remove(&mut column, unit));
            tangent.iter().for_each(|unit| remove(&mut column, unit));
            let size = dot(&column, &column);
            if size > 1e-10 * before && size > 0.0 {
                column.iter_mut().for_each(|value| *value /= size.sqrt());
                tangent.push(column);
            }
        }
        let mut free = base.clone();
        tangent.iter().for_each(|unit| remove(&mut free, unit));
        Self { data, fit, base, free, tangent }
    }

    /// The most promising start of each form of each effect that is `asked_for` and may stand beside the model's.
    #[must_use]
    pub fn promises(&self, excitation: &ExcitationStats, asked_for: &(dyn Fn(&Term) -> bool + Sync)) -> Vec<Promise> {
        let model = &self.fit.model;
        let mut asked: Vec<(Term, Start)> = Vec::new();
        for effect in effects::ALL {
            let spec = effect.spec();
            if spec.place == Place::Drive || model.times(spec.name) >= spec.max_instances {
                continue;
            }
            for form in 0..spec.forms.len() {
                let term = Term { effect, form };
                if !asked_for(&term) || !model.bears(&term) {
                    continue;
                }
                let mut starts = effect.starts(form, excitation);
                if let Some(tones) = effect.frequency_search(form, excitation) {
                    starts.extend(tones::strongest(&tones, self.data, self.fit, &self.free));
                }
                asked.extend(starts.into_iter().map(|start| (term, start)));
            }
        }
        let promises: Vec<Promise> = asked.par_iter().filter_map(|(term, start)| self.promise(*term, start)).collect();
        let mut best: Vec<Promise> = Vec::new();
        for promise in promises {
            match best.iter_mut().find(|other| other.term.is(&promise.term)) {
                Some(other) if other.gain < promise.gain => *other = promise,
                Some(_) => {}
                None => best.push(promise),
            }
        }
        best.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        best
    }

    /// What `term` promises from `start`.
    fn promise(&self, term: Term, start: &Start) -> Option<Promise> {
        let model = self.fit.model.with(term);
        let trials = model.trials;
        let parameters = term.all_parameters(trials);
        let start_values = term.spread(&start.values, trials);
        let change = |own: &[f64]| {
            let values: Vec<f64> = self.fit.values.iter().chain(own).copied().collect();
            let there = self.data.weighted_residual(&model, &values);
            self.orthogonal(self.base.iter().zip(there).map(|(base, there)| base - there).collect())
        };
        if start.linear_parameters.is_empty() {
            let direction = change(&start_values)?;
            let square = dot(&direction, &direction);
            // A point of a grid: the true size is near the one tried, or another point is nearer.
            let part = (dot(&direction, &self.free) / square).clamp(0.0, 2.5);
            let gain = part * (2.0 * dot(&direction, &self.free) - part * square);
            return gain.is_finite().then_some(Promise { term, gain, values: start_values });
        }
        let is_size =
            |at: &usize| start.linear_parameters.iter().any(|size| parameters[*size].name == parameters[*at].name);
        let sizes: Vec<usize> = (0..parameters.len()).filter(is_size).collect();
        let alone = |size: usize| {
            let mut own = start_values.clone();
            sizes.iter().filter(|other| **other != size).for_each(|other| own[*other] = 0.0);
            change(&own)
        };
        let mut directions: Vec<(usize, Vec<f64>)> =
            sizes.iter().filter_map(|&size| Some((size, alone(size)?))).collect();
        loop {
            let parts = solve(&directions, &self.free)?;
            let wrong = directions.iter().zip(parts.iter()).position(|((size, _), part)| {
                let value = part * start_values[*size];
                value < parameters[*size].low || value > parameters[*size].high
            });
            if let Some(wrong) = wrong {
                directions.remove(wrong);
                continue;
            }
            let gain: f64 = directions.iter().zip(parts.iter()).map(|((_, d), part)| part * dot(d, &self.free)).sum();
            let mut values = start_values.clone();
            sizes.iter().for_each(|&size| values[size] = 0.0);
            directions
                .iter()
                .zip(parts.iter())
                .for_each(|((size, _), part)| values[*size] = part * start_values[*size]);
            return gain.is_finite().then_some(Promise { term, gain, values });
        }
    }

    /// A direction without the model's own; `None` where nothing of it is left.
    fn orthogonal(&self, mut direction: Vec<f64>) -> Option<Vec<f64>> {
        let before = dot(&direction, &direction);
        self.tangent.iter().for_each(|unit| remove(&mut direction, unit));
        let is_left = dot(&direction, &direction) > LEAST_ORTHOGONAL * before && before.is_finite();
        (is_left && before > 0.0).then_some(direction)
    }
}
