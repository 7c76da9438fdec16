//! Innovations about some values of a model, and their derivatives by differences.

use rayon::prelude::*;

use super::innovations::Innovations;
use super::input::Inputs;
use super::law::DriveLaw;
use super::likelihood::Data;
use super::model::Model;
use super::noise::Noise;
use super::one_body_filter::{Gains, one_body};
use super::range::Range;
use super::trial::DriveTrial;

/// The innovations about some values, with the gains of one body held: the variance is no lever of the law.
pub struct Linearisation<'a> {
    data: &'a Data<'a>,
    model: &'a Model,
    noise: &'a Noise,
    ranges: Vec<Range>,
    law: DriveLaw,
    inputs: Vec<Inputs>,
    gains: Option<Vec<Gains>>,
    /// Innovations at the values.
    pub base: Vec<Innovations>,
    /// The same, standardised.
    pub innovations: Vec<f64>,
}

/// Step of a finite difference, in steps of the value's range.
const DIFFERENCE: f64 = 1e-4;

impl<'a> Linearisation<'a> {
    /// Those of `model` about `values`.
    #[must_use]
    pub fn of(data: &'a Data<'a>, model: &'a Model, values: &[f64], noise: &'a Noise) -> Self {
        Self::with_base(data, model, values, noise, None)
    }

    /// The same where the innovations at the values are those `known` ones, if any.
    #[must_use]
    pub fn with_base(
        data: &'a Data<'a>,
        model: &'a Model,
        values: &[f64],
        noise: &'a Noise,
        known: Option<Vec<Innovations>>,
    ) -> Self {
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
        at.base = known.unwrap_or_else(|| at.passes(values));
        at.innovations = data.standardised(&at.base, &at.base);
        at
    }

    /// Innovations at `values`.
    #[must_use]
    pub fn passes(&self, values: &[f64]) -> Vec<Innovations> {
        let law = self.model.law(values);
        let each = self.data.trials.par_iter().zip(&self.inputs);
        let inputs: Vec<Inputs> = each.map(|(trial, inputs)| inputs.under(trial, &self.law, &law)).collect();
        self.under(&inputs, &law)
    }

    /// Innovations under `law` with its `inputs`.
    fn under(&self, inputs: &[Inputs], law: &DriveLaw) -> Vec<Innovations> {
        let Some(gains) = &self.gains else { return self.data.innovations_under(inputs, law, self.noise) };
        let each = self.data.trials.par_iter().zip(inputs).zip(gains);
        each.map(|((trial, inputs), gains)| one_body(trial, inputs, law, self.noise, gains, false)).collect()
    }

    /// Standardised innovations and their derivatives by one step of each of `values`: differences from `apart` steps below the value to as
    /// many above, within its range.
    #[must_use]
    pub fn over_width(&self, values: &[f64], apart: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let columns = apart.par_iter().enumerate().map(|(value, apart)| self.secant(values, value, *apart));
        (self.innovations.clone(), columns.collect())
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

    /// Change of the standardised innovations where the force that was recorded of each trial is more by `change`, at its recorded rows.
    #[must_use]
    pub fn under_force(&self, change: &[Vec<f64>]) -> Vec<f64> {
        let more = |(trial, change): (&DriveTrial, &Vec<f64>)| DriveTrial {
            force: Some(change.clone()),
            ..trial.clone().without_effort()
        };
        let changes: Vec<DriveTrial> = self.data.trials.iter().zip(change).map(more).collect();
        let inputs: Vec<Inputs> = self
            .inputs
            .iter()
            .zip(Inputs::of_all(&changes, &self.law))
            .map(|(all, own)| all.with_force(&own))
            .collect();
        let after = self.data.standardised(&self.under(&inputs, &self.law), &self.base);
        after.iter().zip(&self.innovations).map(|(after, before)| after - before).collect()
    }

    /// Derivatives of the standardised innovations by one step of each value in `free`.
    #[must_use]
    pub fn columns(&self, values: &[f64], free: &[usize]) -> Vec<Vec<f64>> {
        let column = |&at: &usize| {
            let range = &self.ranges[at];
            let mut moved = values.to_vec();
            let mut difference = DIFFERENCE;
            moved[at] = range.moved(values[at], difference);
            if moved[at] > range.high {
                difference = -difference;
                moved[at] = range.moved(values[at], difference);
            }
            if self.model.law(&moved) == self.law {
                // As the averaging of an effort that is not recorded early.
                return vec![0.0; self.innovations.len()];
            }
            let after = self.data.standardised(&self.passes(&moved), &self.base);
            after.iter().zip(&self.innovations).map(|(after, before)| (after - before) / difference).collect()
        };
        free.par_iter().map(column).collect()
    }
}
