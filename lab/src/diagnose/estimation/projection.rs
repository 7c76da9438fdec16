//! How much of what a model leaves an effect could take away, first by projection: quick enough to ask of every replicate.

use nalgebra::DVector;

use super::levenberg_marquardt::{self, FitData, GaussianPrior, ParameterBounds};
use super::periodogram;
use crate::diagnose::linalg::{dot, energy, remove, solve};
use crate::diagnose::model::{Channels, Model, Term};
use crate::diagnose::thresholds::projection::MIN_ORTHOGONAL_FRACTION;
use crate::effects::{self, ExcitationStats, Start, linear};

/// The best that one effect can do.
#[derive(Debug, Clone)]
pub struct EffectScore {
    /// Effect and form.
    pub term: Term,
    /// Whitened energy that it takes away.
    pub gain: f64,
    /// Its values, where the search for better ones starts.
    pub values: Vec<f64>,
}

/// What a model leaves, freed of what its own values could still take.
pub struct ProjectedResidual<'a> {
    data: FitData<'a>,
    model: &'a Model,
    values: &'a [f64],
    base: Vec<f64>,
    /// The same without what the model's values could take.
    pub free: Vec<f64>,
    /// Orthonormal directions of the model's values.
    tangent: Vec<Vec<f64>>,
    /// By how much the model's values would have to move to leave the least.
    pub shift: Vec<f64>,
}

impl<'a> ProjectedResidual<'a> {
    /// Of `model` at `values`.
    #[must_use]
    pub fn of(data: FitData<'a>, model: &'a Model, values: &'a [f64], excitation: &ExcitationStats) -> Self {
        let axes = levenberg_marquardt::parameter_bounds(model, values, excitation);
        let base = data.residual(model, values, Channels::BOTH);
        let columns = levenberg_marquardt::jacobian(&data, model, values, &axes, &base);
        let open: Vec<_> = columns.into_iter().filter(|(at, _)| is_inside_bounds(values[*at], &axes[*at])).collect();
        let mut shift = vec![0.0; values.len()];
        let anchor = GaussianPrior::of(model, values, &axes, 0.0);
        if let Some(parts) = gauss_newton_step(&open, &base, &anchor) {
            open.iter().zip(parts.iter()).for_each(|((at, _), part)| shift[*at] = -part);
        }
        let mut tangent: Vec<Vec<f64>> = Vec::new();
        for (_, mut column) in open {
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
        Self { data, model, values, base, free, tangent, shift }
    }

    /// Energy that is left once the model's own values have taken theirs.
    #[must_use]
    pub fn energy(&self) -> f64 {
        energy(&self.free)
    }

    /// A direction without the model's own; `None` where nothing of it is left.
    #[must_use]
    pub fn orthogonal(&self, mut direction: Vec<f64>) -> Option<Vec<f64>> {
        let before = dot(&direction, &direction);
        self.tangent.iter().for_each(|unit| remove(&mut direction, unit));
        (dot(&direction, &direction) > MIN_ORTHOGONAL_FRACTION * before && before > 0.0).then_some(direction)
    }

    /// The best that each effect can do alone, over its forms and starts; of those that `asked` lets through.
    #[must_use]
    pub fn scores(&self, excitation: &ExcitationStats, asked: &dyn Fn(&Term) -> bool) -> Vec<EffectScore> {
        let mut scores = Vec::new();
        for effect in effects::ALL {
            if !self.model.takes(effect.spec().place) || self.model.holds(effect) {
                continue;
            }
            for form in 0..effect.spec().forms.len() {
                let term = Term { effect, form };
                if !asked(&term) {
                    continue;
                }
                let mut starts = effect.starts(form, excitation);
                if let Some(tones) = effect.frequency_search(form, excitation) {
                    starts.extend(periodogram::strongest(&tones, self.data, self.model, self.values, &self.base));
                }
                let tried = starts.iter().filter_map(|start| self.score(term, start));
                scores.extend(tried.max_by(|a, b| a.gain.total_cmp(&b.gain)));
            }
        }
        scores
    }

    /// `score` with the values that it is not linear in looked at more closely: between its own start and those beside it.
    #[must_use]
    pub fn refine_start(&self, score: &EffectScore, excitation: &ExcitationStats) -> EffectScore {
        let (term, form) = (score.term, score.term.form);
        let starts = term.effect.starts(form, excitation);
        let mut best = score.clone();
        let own = &score.values[..term.parameters().len()];
        for (at, parameter) in term.parameters().iter().enumerate().filter(|(_, parameter)| !parameter.fixed) {
            let sizes = starts.first().map_or(&[][..], |start| &start.linear_parameters);
            let mut grid: Vec<f64> = starts.iter().map(|start| start.values[at]).collect();
            grid.sort_unstable_by(f64::total_cmp);
            grid.dedup();
            if sizes.contains(&at) || grid.len() < 3 || parameter.each_trial {
                continue;
            }
            let place = grid.partition_point(|value| *value < own[at]).min(grid.len() - 1);
            let (low, high) = (grid[place.saturating_sub(1)], grid[(place + 1).min(grid.len() - 1)]);
            for value in linear(low, high, 13) {
                let mut values = own.to_vec();
                values[at] = value;
                // Sizes have to be something, or nothing could be scaled.
                sizes.iter().filter(|size| values[**size] == 0.0).copied().collect::<Vec<_>>().iter().for_each(
                    |size| {
                        values[*size] = starts[0].values[*size];
                    },
                );
                let tried = self.score(term, &Start { values, linear_parameters: sizes.to_vec() });
                if let Some(tried) = tried.filter(|tried| tried.gain > best.gain) {
                    best = tried;
                }
            }
        }
        best
    }

    /// What `term` can do from `start`.
    fn score(&self, term: Term, start: &Start) -> Option<EffectScore> {
        let model = self.model.with(term);
        let channels = self.model.affected_channels(term.effect.spec().place);
        let split = self.data.whitener.force_rows();
        let change = |own: &[f64]| {
            let values: Vec<f64> = self.values.iter().chain(own).copied().collect();
            let there = self.data.residual(&model, &values, channels);
            let counts = |row: usize| if row < split { channels.force } else { channels.effort };
            let pairs = self.base.iter().zip(there).enumerate();
            self.orthogonal(pairs.map(|(row, (base, there))| if counts(row) { base - there } else { 0.0 }).collect())
        };
        let trials = model.trials();
        let parameters = term.all_parameters(trials);
        let start_values = term.spread(&start.values, trials);
        if start.linear_parameters.is_empty() {
            let direction = change(&start_values)?;
            // A point of a grid: the true size is near the one tried, or another point is nearer.
            let part = (dot(&direction, &self.free) / dot(&direction, &direction)).clamp(0.0, 2.5);
            let gain = part * (2.0 * dot(&direction, &self.free) - part * dot(&direction, &direction));
            return Some(EffectScore { term, gain, values: start_values });
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
            let gain = directions.iter().zip(parts.iter()).map(|((_, d), part)| part * dot(d, &self.free)).sum();
            let mut values = start_values.clone();
            sizes.iter().for_each(|&size| values[size] = 0.0);
            directions
                .iter()
                .zip(parts.iter())
                .for_each(|((size, _), part)| values[*size] = part * start_values[*size]);
            return Some(EffectScore { term, gain, values });
        }
    }
}

fn is_inside_bounds(value: f64, axis: &ParameterBounds) -> bool {
    value > axis.low && value < axis.high
}

/// The step of Gauss and Newton to the least of `base` along `columns`, of which an anchor holds some where they are; turned
/// round.
fn gauss_newton_step(columns: &[(usize, Vec<f64>)], base: &[f64], anchor: &GaussianPrior) -> Option<DVector<f64>> {
    let held: Vec<(usize, Vec<f64>)> = columns
        .iter()
        .enumerate()
        .map(|(own, (at, column))| {
            let holds = (0..columns.len()).map(|row| if row == own { anchor.weight[*at].sqrt() } else { 0.0 });
            (*at, column.iter().copied().chain(holds).collect())
        })
        .collect();
    let there = std::iter::repeat_n(0.0, columns.len());
    solve(&held, &base.iter().copied().chain(there).collect::<Vec<_>>())
}
