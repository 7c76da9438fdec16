//! Maximum likelihood: Levenberg-Marquardt on the innovations for the law, a line search for the disturbance's density, in turns.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::filter::innovations_under;
use super::innovations::Innovations;
use super::input::Inputs;
use super::law::DriveLaw;
use super::model::Model;
use super::noise::Noise;
use super::one_body_filter::{Gains, one_body};
use super::term::Range;
use super::trial::DriveTrial;
use crate::diagnose::linalg::{dot, energy};

/// The trials that a model is fitted to.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a> {
    /// Every trial.
    pub trials: &'a [DriveTrial],
    /// Least variance of an encoder row that is believed, m^2 or rad^2.
    pub least_encoder_variance: f64,
}

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What was fitted.
    pub model: Model,
    /// Its values.
    pub values: Vec<f64>,
    /// The random part.
    pub noise: Noise,
    /// ln of the likelihood, nats.
    pub log_likelihood: f64,
    /// How the search ended.
    pub ended: Ended,
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// No further step gains anything that counts.
    Converged,
    /// The steps that it was given were used up.
    OutOfSteps,
}

/// Rows after a start that are not scored: the velocity is not known yet.
const SETTLING_ROWS: usize = 3;

impl Data<'_> {
    /// Density of all that `model` leaves to chance under `noise`, N^2 s: what acts on a rigid body as its disturbance holds the force sensor's
    /// noise, which beside a link acts on the load as a part of its own.
    #[must_use]
    pub fn unexplained_density(&self, model: &Model, noise: &Noise) -> f64 {
        let of_force = self.trials.iter().map(|trial| trial.force_density).fold(0.0, f64::max);
        noise.disturbance() + if model.has_link() { of_force } else { 0.0 }
    }

    /// Innovations of every trial under `model`.
    #[must_use]
    pub fn innovations(&self, model: &Model, values: &[f64], noise: &Noise) -> Vec<Innovations> {
        let law = model.law(values);
        self.innovations_under(&Inputs::of_all(self.trials, &law), &law, noise)
    }

    fn innovations_under(&self, inputs: &[Inputs], law: &DriveLaw, noise: &Noise) -> Vec<Innovations> {
        let each = self.trials.par_iter().zip(inputs);
        each.map(|(trial, inputs)| innovations_under(trial, inputs, law, noise, false)).collect()
    }

    /// ln of the likelihood and the prior, with the common scale of both variances at its best, and ln of that scale.
    #[must_use]
    pub fn log_likelihood(&self, model: &Model, values: &[f64], noise: &Noise) -> (f64, f64) {
        let (rows, scale) = self.profiled(&self.innovations(model, values, noise), noise);
        (rows + model.ln_prior(values), scale)
    }

    /// -1/2 sum (ln(2 pi s S) + e^2 / (s S)) with s = mean(e^2 / S), which is best, or as small as the encoder allows.
    fn profiled(&self, passes: &[Innovations], noise: &Noise) -> (f64, f64) {
        let (mut rows, mut squares, mut logs) = (0usize, 0.0, 0.0);
        self.scored(passes, |innovation, variance| {
            rows += 1;
            squares += innovation * innovation / variance;
            logs += variance.ln();
        });
        let count = rows.max(1) as f64;
        let scale = (squares / count).max(self.least_encoder_variance / noise.encoder());
        let log_likelihood = -0.5 * (logs + count * (scale.ln() + std::f64::consts::TAU.ln()) + squares / scale);
        (if log_likelihood.is_finite() { log_likelihood } else { f64::NEG_INFINITY }, scale.ln())
    }

    fn scored(&self, passes: &[Innovations], mut each: impl FnMut(f64, f64)) {
        for (pass, trial) in passes.iter().zip(self.trials) {
            for (row, since) in trial.rows_since_restart().enumerate() {
                if since >= SETTLING_ROWS {
                    each(pass.innovation[row], pass.variance[row]);
                }
            }
        }
    }

    /// Innovations over the deviations of `reference`.
    fn standardised(&self, passes: &[Innovations], reference: &[Innovations]) -> Vec<f64> {
        let mut out = Vec::new();
        for ((pass, base), trial) in passes.iter().zip(reference).zip(self.trials) {
            for (row, since) in trial.rows_since_restart().enumerate() {
                if since >= SETTLING_ROWS {
                    out.push(pass.innovation[row] / base.variance[row].sqrt());
                }
            }
        }
        out
    }

    /// ln of the likelihood of each scored row, but for a constant, under the noise as it stands.
    #[must_use]
    pub fn row_log_likelihoods(&self, fit: &Fit) -> Vec<f64> {
        let mut rows = Vec::new();
        let passes = self.innovations(&fit.model, &fit.values, &fit.noise);
        self.scored(&passes, |innovation, variance| {
            rows.push(-0.5 * (variance.ln() + innovation * innovation / variance));
        });
        rows
    }

    /// Standardised innovations at `fit` and their derivatives by one step of each value: differences from `apart` steps below the value to as
    /// many above, within its range.
    #[must_use]
    pub fn linearised(&self, fit: &Fit, apart: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let at = Linearisation::of(self, &fit.model, &fit.values, &fit.noise);
        let columns = apart.par_iter().enumerate().map(|(value, apart)| at.secant(&fit.values, value, *apart));
        (at.innovations.clone(), columns.collect())
    }

    /// Scored rows of each trial.
    pub fn scored_rows(&self) -> impl Iterator<Item = usize> {
        self.trials.iter().map(|trial| trial.rows_since_restart().filter(|since| *since >= SETTLING_ROWS).count())
    }
}

/// The innovations about some values, with the gains of one body held: the variance is no lever of the law.
struct Linearisation<'a> {
    data: &'a Data<'a>,
    model: &'a Model,
    noise: &'a Noise,
    ranges: Vec<Range>,
    law: DriveLaw,
    inputs: Vec<Inputs>,
    gains: Option<Vec<Gains>>,
    base: Vec<Innovations>,
    innovations: Vec<f64>,
}

/// Step of a finite difference, in steps of the value's range.
const DIFFERENCE: f64 = 1e-4;

impl<'a> Linearisation<'a> {
    fn of(data: &'a Data<'a>, model: &'a Model, values: &[f64], noise: &'a Noise) -> Self {
        let law = model.law(values);
        let gains = law.link.is_none().then(|| data.trials.par_iter().map(|t| Gains::of(t, &law, noise)).collect());
        let inputs = Inputs::of_all(data.trials, &law);
        let mut at = Self {
            data,
            model,
            noise,
            ranges: model.ranges(),
            law,
            inputs,
            gains,
            base: Vec::new(),
            innovations: Vec::new(),
        };
        at.base = at.passes(values);
        at.innovations = data.standardised(&at.base, &at.base);
        at
    }

    fn passes(&self, values: &[f64]) -> Vec<Innovations> {
        let law = self.model.law(values);
        let own = (!Inputs::are_alike(&law, &self.law)).then(|| Inputs::of_all(self.data.trials, &law));
        let inputs = own.as_ref().unwrap_or(&self.inputs);
        let Some(gains) = &self.gains else { return self.data.innovations_under(inputs, &law, self.noise) };
        let each = self.data.trials.par_iter().zip(inputs).zip(gains);
        each.map(|((trial, inputs), gains)| one_body(trial, inputs, &law, self.noise, gains, false)).collect()
    }

    /// Derivative of the standardised innovations by one step of value `at`, over `apart` steps to either side of it; zero where its range
    /// holds it.
    fn secant(&self, values: &[f64], at: usize, apart: f64) -> Vec<f64> {
        let range = &self.ranges[at];
        let ends = [-apart, apart].map(|steps| range.moved(values[at], steps).clamp(range.low, range.high));
        let between = range.steps_between(ends[0], ends[1]);
        if between <= 0.0 {
            return vec![0.0; self.innovations.len()];
        }
        let [below, above] = ends.map(|end| {
            let mut moved = values.to_vec();
            moved[at] = end;
            self.data.standardised(&self.passes(&moved), &self.base)
        });
        below.iter().zip(&above).map(|(below, above)| (above - below) / between).collect()
    }

    /// Derivatives of the standardised innovations by one step of each value in `free`.
    fn columns(&self, values: &[f64], free: &[usize]) -> Vec<Vec<f64>> {
        let column = |&at: &usize| {
            let range = &self.ranges[at];
            let mut moved = values.to_vec();
            let mut difference = DIFFERENCE;
            moved[at] = range.moved(values[at], difference);
            if moved[at] > range.high {
                difference = -difference;
                moved[at] = range.moved(values[at], difference);
            }
            let after = self.data.standardised(&self.passes(&moved), &self.base);
            after.iter().zip(&self.innovations).map(|(after, before)| (after - before) / difference).collect()
        };
        free.par_iter().map(column).collect()
    }
}

/// Gain of log likelihood below which a step no longer counts, nats.
const NEGLIGIBLE_GAIN: f64 = 0.05;

/// Tries of a damping before a step is given up, and the factors between them.
const DAMPING_TRIES: usize = 6;
const DAMPING_RAISED: f64 = 6.0;
const DAMPING_LOWERED: f64 = 0.3;

/// Longest step of a value, in steps of its range: a factor of e^1.5, or twenty sizes.
const LONGEST_RELATIVE: f64 = 1.5;
const LONGEST_ABSOLUTE: f64 = 20.0;

/// Levenberg-Marquardt over all values within their ranges, the noise held.
pub fn search_values(data: &Data<'_>, model: &Model, values: &mut Vec<f64>, noise: &Noise, steps: usize) -> Ended {
    let ranges = model.ranges();
    values.iter_mut().zip(&ranges).for_each(|(value, range)| *value = value.clamp(range.low, range.high));
    let all: Vec<usize> = (0..values.len()).collect();
    let mut damping = 1e-3;
    for _ in 0..steps {
        let here = Linearisation::of(data, model, values, noise);
        let before = data.profiled(&here.base, noise).0 + model.ln_prior(values);
        let columns = here.columns(values, &all);
        let normal = Normal::of(&columns, &here.innovations).with_priors(values, &ranges);
        let mut gained = None;
        for _ in 0..DAMPING_TRIES {
            let moved = normal.step(values, &ranges, damping);
            let after = data.profiled(&here.passes(&moved), noise).0 + model.ln_prior(&moved);
            if after > before {
                *values = moved;
                damping = (damping * DAMPING_LOWERED).max(1e-9);
                gained = Some(after - before);
                break;
            }
            damping *= DAMPING_RAISED;
        }
        if gained.is_none_or(|gain| gain < NEGLIGIBLE_GAIN) {
            return Ended::Converged;
        }
    }
    Ended::OutOfSteps
}

/// Normal equations of a linearised fit.
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    energy: f64,
}

impl Normal {
    fn of(columns: &[Vec<f64>], residual: &[f64]) -> Self {
        let count = columns.len();
        let mut matrix = DMatrix::zeros(count, count);
        for row in 0..count {
            for column in 0..=row {
                let product = dot(&columns[row], &columns[column]);
                (matrix[(row, column)], matrix[(column, row)]) = (product, product);
            }
        }
        let right = DVector::from_fn(count, |row, _| -dot(&columns[row], residual));
        Self { matrix, right, energy: energy(residual) }
    }

    /// The same with what is known of `values` beforehand, each prior being one row more.
    fn with_priors(mut self, values: &[f64], ranges: &[Range]) -> Self {
        for (at, range) in ranges.iter().enumerate() {
            if let Some(prior) = range.prior {
                let slope = range.slope(values[at]) / prior.deviation;
                self.matrix[(at, at)] += slope * slope;
                self.right[at] -= slope * (values[at] - prior.mean) / prior.deviation;
            }
        }
        self
    }

    /// `values` after a damped step; a value at an end of its range that would leave it is held.
    fn step(&self, values: &[f64], ranges: &[Range], damping: f64) -> Vec<f64> {
        let mut held = vec![false; values.len()];
        for _ in 0..=values.len() {
            let free: Vec<usize> = (0..values.len()).filter(|at| !held[*at]).collect();
            let damped = |row: usize, column: usize| {
                let extra = if row == column { damping * self.matrix[(row, row)].max(1e-9 * self.energy) } else { 0.0 };
                self.matrix[(row, column)] + extra
            };
            let matrix = DMatrix::from_fn(free.len(), free.len(), |row, column| damped(free[row], free[column]));
            let right = DVector::from_fn(free.len(), |row, _| self.right[free[row]]);
            let Some(factors) = matrix.cholesky() else { return values.to_vec() };
            let steps = factors.solve(&right);
            let mut moved = values.to_vec();
            for (&at, step) in free.iter().zip(&steps) {
                let range = &ranges[at];
                let longest =
                    if range.step == super::term::Step::Relative { LONGEST_RELATIVE } else { LONGEST_ABSOLUTE };
                let to = range.moved(values[at], step.clamp(-longest, longest));
                let leaves =
                    (values[at] <= range.low && to < values[at]) || (values[at] >= range.high && to > values[at]);
                held[at] = leaves;
                moved[at] = to.clamp(range.low, range.high);
            }
            if free.iter().all(|at| !held[*at]) {
                return moved;
            }
        }
        values.to_vec()
    }
}

/// The disturbance's density at its most likely, by golden section on its logarithm, and both variances scaled to the innovations.
/// Returns ln of the likelihood.
pub fn search_noise(data: &Data<'_>, model: &Model, values: &[f64], noise: &mut Noise) -> f64 {
    const GOLDEN: f64 = 0.381_966;
    const FIRST_SPAN: f64 = 3.0;
    const WIDER: f64 = 4.0;
    const CLOSE: f64 = 0.08;
    let base = *noise;
    let law = model.law(values);
    let inputs = Inputs::of_all(data.trials, &law);
    let cost = |ln: f64| {
        let noise = Noise { ln_disturbance: ln, ..base };
        -data.profiled(&data.innovations_under(&inputs, &law, &noise), &noise).0
    };
    let (mut low, mut middle, mut high) =
        (base.ln_disturbance - FIRST_SPAN, base.ln_disturbance, base.ln_disturbance + FIRST_SPAN);
    let (mut at_low, mut at_middle, mut at_high) = (cost(low), cost(middle), cost(high));
    for _ in 0..8 {
        if at_low < at_middle {
            (high, middle, at_middle) = (middle, low, at_low);
            low -= WIDER;
            at_low = cost(low);
        } else if at_high < at_middle {
            (low, middle, at_middle) = (middle, high, at_high);
            high += WIDER;
            at_high = cost(high);
        } else {
            break;
        }
    }
    for _ in 0..16 {
        if high - low < CLOSE {
            break;
        }
        let above = high - middle > middle - low;
        let try_at = middle + GOLDEN * if above { high - middle } else { low - middle };
        let there = cost(try_at);
        match (there < at_middle, above) {
            (true, true) => (low, middle, at_middle) = (middle, try_at, there),
            (true, false) => (high, middle, at_middle) = (middle, try_at, there),
            (false, true) => high = try_at,
            (false, false) => low = try_at,
        }
    }
    *noise = Noise { ln_disturbance: middle, ..base };
    rescale(data, model, values, noise)
}

/// Puts the common scale of the innovations into the noise. Returns ln of the likelihood.
fn rescale(data: &Data<'_>, model: &Model, values: &[f64], noise: &mut Noise) -> f64 {
    let (log_likelihood, ln_scale) = data.log_likelihood(model, values, noise);
    noise.ln_disturbance += ln_scale;
    noise.ln_encoder += ln_scale;
    log_likelihood
}

/// How long a fit may take: turns of values and noise, and steps of the values in the first turn and in each later one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Turns.
    pub turns: usize,
    /// Steps in the first.
    pub first_steps: usize,
    /// Steps in each later one.
    pub later_steps: usize,
}

impl Effort {
    /// Enough to compare one start with another.
    pub const QUICK: Self = Self { turns: 1, first_steps: 6, later_steps: 0 };
    /// To the end, for one body.
    pub const FULL: Self = Self { turns: 3, first_steps: 12, later_steps: 6 };
    /// To the end, for two bodies that were followed on a stretch before.
    pub const LINKED: Self = Self { turns: 4, first_steps: 6, later_steps: 4 };
}

/// Gain of a turn below which values and noise stand, nats.
const SETTLED_GAIN: f64 = 0.5;

/// Fits `model` from `start` and `noise`, values and noise in turns.
#[must_use]
pub fn fit(data: &Data<'_>, model: &Model, start: &[f64], noise: Noise, effort: Effort) -> Fit {
    let (mut values, mut noise) = (start.to_vec(), noise);
    let mut log_likelihood = f64::NEG_INFINITY;
    let mut ended = Ended::OutOfSteps;
    for turn in 0..effort.turns {
        let steps = if turn == 0 { effort.first_steps } else { effort.later_steps };
        search_values(data, model, &mut values, &noise, steps);
        let reached = search_noise(data, model, &values, &mut noise);
        let gain = reached - log_likelihood;
        log_likelihood = reached;
        if gain < SETTLED_GAIN {
            ended = Ended::Converged;
            break;
        }
    }
    Fit { model: model.clone(), values, noise, log_likelihood, ended }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::term::Prior;

    #[test]
    fn a_prior_is_one_row_more() {
        let range = Range::absolute(0.0, 2.0, 0.005).known(Prior { mean: 1.0, deviation: 0.05 });
        let step = |normal: Normal| normal.step(&[1.1], &[range], 0.0)[0];
        let of_rows = || Normal::of(&[vec![2.0]], &[1.0]);
        assert!((step(of_rows()) - (1.1 - 0.5 * 0.005)).abs() < 1e-12);
        // A second row: a tenth of a deviation a step, two deviations off.
        let both = Normal::of(&[vec![2.0, 0.1]], &[1.0, 2.0]);
        assert!((step(of_rows().with_priors(&[1.1], &[range])) - step(both)).abs() < 1e-12);
        assert!((range.ln_prior(1.1) + 2.0).abs() < 1e-12);
    }
}
