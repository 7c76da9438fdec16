//! What a motion tells of two explanations: the difference of their responses, after the best small change of the other's values.

use nalgebra::{DMatrix, DVector};

use super::loop_model::LoopModel;
use super::parameters::{self, Parameter};
use super::prediction::predict;
use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// Rows that are worth an independent one: what a model leaves of a recording changes at the bandwidth of the loop, not from row to row.
const ROWS_PER_INDEPENDENT_ROW: f64 = 10.0;

/// Share of a channel's greatest reading that one recording differs from its repetition by, where nothing better is known.
const REPEATABILITY: f64 = 2e-3;

/// Information that every value has beforehand: it may be wrong by this many of its steps.
const PRIOR_DEVIATION_STEPS: f64 = 30.0;

/// Expected deviation of each channel's readings from a true model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// m or rad.
    pub position: f64,
    /// N or N m; `None` where no force is recorded.
    pub force: Option<f64>,
    /// N or N m; `None` where no effort is recorded.
    pub effort: Option<f64>,
}

impl Noise {
    /// That of `trials` by their sensors, and no less than what they repeat to; `residual` is what the diagnosis left in force and in
    /// effort, zero where it is not known.
    #[must_use]
    pub fn of(rig: &Rig, trials: &[Recording], residual: [f64; 2]) -> Self {
        let figures: Vec<Figures> = trials.iter().map(|trial| Figures::of(rig, trial)).collect();
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let peak = |pick: fn(&Recording) -> Option<&Vec<f64>>| {
            most(&mut trials.iter().filter_map(pick).flatten().map(|value| value.abs()))
        };
        let travel = trials.iter().map(|trial| range(&trial.position)).fold(0.0, f64::max);
        let position = most(&mut figures.iter().map(|figures| figures.position.noise)).max(REPEATABILITY * travel);
        let channel =
            |noise: f64, peak: f64, left: f64| noise.max(left).max(REPEATABILITY * peak).max(f64::MIN_POSITIVE);
        let force = most(&mut figures.iter().filter_map(|figures| figures.force).map(|force| force.noise));
        let effort = most(&mut figures.iter().filter_map(|figures| figures.effort).map(|effort| effort.noise));
        let has = |is: fn(&Recording) -> bool| trials.iter().any(is);
        Self {
            position: position.max(f64::MIN_POSITIVE),
            force: has(|trial| trial.force.is_some())
                .then(|| channel(force, peak(|trial| trial.force.as_ref()), residual[0])),
            effort: has(|trial| trial.effort.is_some())
                .then(|| channel(effort, peak(|trial| trial.effort.as_ref()), residual[1])),
        }
    }
}

/// Greatest less least.
#[must_use]
pub fn range(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    (high - low).max(0.0)
}

/// Every channel of `recording` in units of its noise, one after the other.
#[must_use]
pub fn whitened(recording: &Recording, noise: &Noise) -> DVector<f64> {
    let weight = ROWS_PER_INDEPENDENT_ROW.sqrt().recip();
    let channel = |values: Option<&Vec<f64>>, noise: Option<f64>| -> Vec<f64> {
        let Some((values, noise)) = values.zip(noise) else { return Vec::new() };
        values.iter().map(|value| weight * value / noise).collect()
    };
    let mut all = channel(Some(&recording.position), Some(noise.position));
    all.extend(channel(recording.force.as_ref(), noise.force));
    all.extend(channel(recording.effort.as_ref(), noise.effort));
    DVector::from_vec(all)
}

/// A rig's response to a reference, and what a step of each of its values changes of it.
pub struct LinearizedResponse {
    /// As it would be recorded.
    pub recording: Recording,
    /// The same in units of the noise.
    pub response: DVector<f64>,
    /// Its change by one step of each value.
    pub sensitivity: DMatrix<f64>,
}

impl LinearizedResponse {
    /// Of `rig` along `reference`, in the values `steps`.
    ///
    /// # Errors
    /// The rig cannot be simulated along it.
    pub fn new(
        rig: &Rig,
        steps: &[(Parameter, f64)],
        closed_loop: &LoopModel,
        reference: &[f64],
        noise: &Noise,
    ) -> Result<Self, InputError> {
        let recording = predict(rig, closed_loop, reference)?;
        let response = whitened(&recording, noise);
        let mut sensitivity = DMatrix::zeros(response.len(), steps.len());
        for (at, (parameter, step)) in steps.iter().enumerate() {
            let value = parameter.get(rig).unwrap_or(0.0);
            let moved = whitened(&predict(&parameter.set(rig, value + step), closed_loop, reference)?, noise);
            if moved.len() == response.len() {
                sensitivity.set_column(at, &(moved - &response));
            }
        }
        Ok(Self { recording, response, sensitivity })
    }

    /// Fisher information of the values, a step each.
    #[must_use]
    pub fn information(&self) -> DMatrix<f64> {
        self.sensitivity.tr_mul(&self.sensitivity)
    }

    /// Energy that is left of the difference to `other`, the response of another rig, after the best change of this one's values,
    /// of which `known` is the information that earlier recordings hold.
    #[must_use]
    pub fn discrepancy(&self, other: &DVector<f64>, known: &DMatrix<f64>) -> f64 {
        if other.len() != self.response.len() {
            return 0.0;
        }
        let difference = other - &self.response;
        let own = difference.norm_squared();
        let gradient = self.sensitivity.tr_mul(&difference);
        let Some(solver) = (self.information() + known).cholesky() else { return 0.0 };
        (own - gradient.dot(&solver.solve(&gradient))).max(0.0)
    }

    /// Information about value `at` alone, all others free and known by `known`, per step squared.
    #[must_use]
    pub fn marginal_information(&self, at: usize, known: &DMatrix<f64>) -> f64 {
        let own = self.information();
        let others: Vec<usize> = (0..own.ncols()).filter(|other| *other != at).collect();
        let cross = DVector::from_fn(others.len(), |row, _| own[(others[row], at)]);
        let rest = DMatrix::from_fn(others.len(), others.len(), |row, column| {
            let (row, column) = (others[row], others[column]);
            own[(row, column)] + known[(row, column)]
        });
        let lost = rest.cholesky().map_or(0.0, |solver| cross.dot(&solver.solve(&cross)));
        (own[(at, at)] - lost).max(0.0)
    }
}

/// The free values of `rig` with a step each.
#[must_use]
pub fn steps(rig: &Rig, travel: f64) -> Vec<(Parameter, f64)> {
    let all = parameters::of(rig).into_iter();
    all.filter_map(|parameter| parameter.step(rig, travel).map(|step| (parameter, step))).collect()
}

/// What is known of `count` values before anything is recorded.
#[must_use]
pub fn prior(count: usize) -> DMatrix<f64> {
    DMatrix::identity(count, count) * PRIOR_DEVIATION_STEPS.powi(-2)
}
