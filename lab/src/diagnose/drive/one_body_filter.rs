//! One body along a trial, corrected at each encoder row.
//!
//! One body has a linear covariance, so its Kalman gains are those of mass, viscous friction and disturbance; friction at rest and
//! position-dependent loads act on the mean alone (innovations form, Ljung, *System Identification*, 1999, section 4.3).

use std::sync::Arc;

use super::course::Varying;
use super::innovations::Innovations;
use super::input::Inputs;
use super::law::{Acting, DriveLaw};
use super::matrix::{Matrix, propagated, transposed_product};
use super::noise::Noise;
use super::presliding::Slips;
use super::trial::DriveTrial;

/// Kalman gains of one body along a trial.
#[derive(Debug, Clone, Default)]
pub struct Gains {
    gain: Vec<[f64; 2]>,
    variance: Arc<Vec<f64>>,
}

/// Rows over which the gain has to stand before it is taken as steady, and its relative change.
const STEADY_ROWS: usize = 25;
const STEADY_CHANGE: f64 = 1e-7;

impl Gains {
    /// Those of `law` with `noise` on the rows of `trial`.
    #[must_use]
    pub fn of(trial: &DriveTrial, law: &DriveLaw, noise: &Noise) -> Self {
        let encoder = noise.encoder();
        let mut gains = vec![[0.0; 2]; trial.len()];
        let mut variances = vec![encoder; trial.len()];
        let fastest = trial.fastest();
        let mut covariance = [[0.0; 2]; 2];
        let (mut transition, mut driving) = (covariance, covariance);
        let (mut last_step, mut steady) = (f64::NAN, 0);
        for row in 0..trial.len() {
            if trial.restart[row] {
                covariance = [[encoder, 0.0], [0.0, fastest * fastest + f64::MIN_POSITIVE]];
                steady = 0;
                continue;
            }
            let step = trial.time[row] - trial.time[row - 1];
            let same = (step - last_step).abs() <= 1e-9 * trial.period_s;
            if !same {
                (transition, driving) = (law.transition(step), law.driving_noise(noise, step));
                (last_step, steady) = (step, 0);
            }
            if steady >= STEADY_ROWS {
                gains[row] = gains[row - 1];
                variances[row] = variances[row - 1];
                continue;
            }
            let predicted = propagated(&transition, &covariance, &driving);
            let variance = predicted[0][0] + encoder;
            let gain = [predicted[0][0] / variance, predicted[1][0] / variance];
            for (line, factor) in covariance.iter_mut().zip(predicted.iter().zip(gain)) {
                *line = std::array::from_fn(|column| factor.0[column] - factor.1 * predicted[0][column]);
            }
            let before = gains[row - 1];
            let stands = gain.iter().zip(before).all(|(new, old)| (new - old).abs() <= STEADY_CHANGE * new.abs());
            steady = if stands { steady + 1 } else { 0 };
            gains[row] = gain;
            variances[row] = variance;
        }
        Self { gain: gains, variance: Arc::new(variances) }
    }
}

impl DriveLaw {
    /// Position and velocity over `step` without any force but viscous friction.
    fn transition(&self, step: f64) -> Matrix<2> {
        let rate = self.viscous / self.inertia;
        let decay = (-rate * step).exp();
        let way = if rate * step > 1e-6 { (1.0 - decay) / rate } else { step * (1.0 - 0.5 * rate * step) };
        [[1.0, way], [0.0, decay]]
    }

    /// Covariance that the disturbance adds over `step`.
    fn driving_noise(&self, noise: &Noise, step: f64) -> Matrix<2> {
        let density = noise.disturbance() / (self.inertia * self.inertia);
        let cross = density * step * step / 2.0;
        [[density * step.powi(3) / 3.0, cross], [cross, density * step]]
    }
}

/// One body under `inputs` with given gains.
#[must_use]
pub fn one_body(
    trial: &DriveTrial,
    inputs: &Inputs,
    law: &DriveLaw,
    noise: &Noise,
    gains: &Gains,
    smooth: bool,
) -> Innovations {
    let rows = trial.len();
    let mut out =
        Innovations { innovation: vec![0.0; rows], variance: Arc::clone(&gains.variance), ..Innovations::default() };
    let inertia = if trial.force.is_some() { law.inertia - law.tool_inertia } else { law.inertia };
    let (mut state, mut slips) = ([0.0; 2], Slips::default());
    for row in 0..rows {
        if trial.restart[row] {
            state = [trial.position[row], trial.rate_after(row)];
            slips = Slips::default();
        } else {
            let step = trial.time[row] - trial.time[row - 1];
            let force = inputs.force[row];
            let factor = |of| law.course.factor(of, trial.time[row] - trial.time[0], state);
            let acting = Acting {
                push: factor(Varying::Effort) * inputs.effort[row] - force,
                borne: inputs.borne(row),
                friction_factor: factor(Varying::DryFriction),
                viscous_factor: factor(Varying::ViscousFriction),
            };
            state = law.advance(state, &mut slips, &acting, inertia, step);
            let innovation = trial.position[row] - state[0];
            let gain = gains.gain[row];
            state = [state[0] + gain[0] * innovation, state[1] + gain[1] * innovation];
            law.friction.follow(&mut slips, gain[0] * innovation);
            out.innovation[row] = innovation;
        }
    }
    if smooth {
        out.disturbance = smoothed_one(trial, law, noise, gains, &out);
    }
    out
}

/// Disturbance smoother (de Jong, *Biometrika* 76, 1989; Koopman, *Biometrika* 80, 1993): backward through the innovations.
fn smoothed_one(trial: &DriveTrial, law: &DriveLaw, noise: &Noise, gains: &Gains, pass: &Innovations) -> Vec<f64> {
    let mut force = vec![0.0; trial.len()];
    let mut next = [0.0; 2];
    for row in (0..trial.len()).rev() {
        if trial.restart[row] {
            next = [0.0; 2];
            continue;
        }
        let gain = gains.gain[row];
        let weighted = pass.innovation[row] / pass.variance[row] - gain[0] * next[0] - gain[1] * next[1];
        let adjoint = [next[0] + weighted, next[1]];
        let step = trial.time[row] - trial.time[row - 1];
        let driving = law.driving_noise(noise, step);
        force[row] = law.inertia / step * (driving[1][0] * adjoint[0] + driving[1][1] * adjoint[1]);
        next = transposed_product(&law.transition(step), &adjoint);
    }
    force
}
