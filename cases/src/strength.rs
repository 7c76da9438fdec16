//! Strength of an effect: the RMS residual that the refitted nominal model leaves of the noise-free motion.

use crate::closed_loop::{SAMPLE_PERIOD_S, SimulatedTrial};
use crate::nominal::NominalParameters;
use crate::sensors::Sensors;

/// RMS residuals of the best nominal fit to the true, noise-free motion, N.
#[derive(Debug, Clone, Copy)]
pub struct NominalResidual {
    /// Of the force, fitted by K, B and surface.
    pub force: f64,
    /// Of the effort less the measured force, fitted by m and b, in means over as long as the encoder needs.
    pub effort: f64,
}

/// Fits all `trials` at once, as `sensors` show them.
#[must_use]
pub fn residual(trials: &[SimulatedTrial], nominal: &NominalParameters, sensors: &Sensors) -> NominalResidual {
    NominalResidual {
        force: contact_residual(trials, nominal),
        effort: drive_residual(trials, averaging_rows(nominal.mass, sensors)),
    }
}

/// Sums of products, for a least-squares fit of N values.
struct NormalEquations<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> NormalEquations<N> {
    fn new() -> Self {
        Self { matrix: [[0.0; N]; N], right: [0.0; N] }
    }

    fn add(&mut self, regressor: [f64; N], wanted: f64) {
        for (row, value) in regressor.iter().enumerate() {
            for (column, other) in regressor.iter().enumerate() {
                self.matrix[row][column] += value * other;
            }
            self.right[row] += value * wanted;
        }
    }

    /// Gauss-Jordan without pivoting: the matrix is positive definite, or lacks whole directions, which stay zero.
    fn solve(mut self) -> [f64; N] {
        for pivot in 0..N {
            let scale = self.matrix[pivot][pivot];
            if scale.abs() < 1e-30 {
                self.right[pivot] = 0.0;
                continue;
            }
            for row in (0..N).filter(|row| *row != pivot) {
                let factor = self.matrix[row][pivot] / scale;
                for column in 0..N {
                    self.matrix[row][column] -= factor * self.matrix[pivot][column];
                }
                self.right[row] -= factor * self.right[pivot];
            }
        }
        std::array::from_fn(|at| {
            let scale = self.matrix[at][at];
            if scale.abs() < 1e-30 { 0.0 } else { self.right[at] / scale }
        })
    }
}

/// Rows over which the drive's balance is averaged: what shakes quicker no encoder shows.
///
/// A parabola through N readings over T = N P, each off by `sigma = step / sqrt(12)`, has an acceleration that is off by
/// `sqrt(720 / N) sigma / T^2`; at T that is, times the mass, as much as the force sensor's floor.
fn averaging_rows(mass: f64, sensors: &Sensors) -> usize {
    let sigma = sensors.position_step / 12.0_f64.sqrt();
    let seconds = (mass * sigma * (720.0 * SAMPLE_PERIOD_S).sqrt() / sensors.floor()).powf(0.4);
    (seconds / SAMPLE_PERIOD_S).ceil() as usize
}

/// How much each of `rows` counts in a mean. The acceleration of a parabola through positions is the mean of the true one
/// with the weight `(1 - u^2)^2`, u from -1 to 1; effort and force are averaged alike.
fn weights(rows: usize) -> Vec<f64> {
    let at = |row: usize| (1.0 - ((2 * row + 1) as f64 / rows as f64 - 1.0).powi(2)).powi(2);
    let sum: f64 = (0..rows).map(at).sum();
    (0..rows).map(|row| at(row) / sum).collect()
}

fn drive_residual(trials: &[SimulatedTrial], rows: usize) -> f64 {
    let weights = weights(rows);
    let mean = |values: &[f64]| values.iter().zip(&weights).map(|(value, weight)| weight * value).sum::<f64>();
    // From one row to the next, as the effort holds until then.
    let rate = |values: &[f64]| {
        values
            .windows(2)
            .zip(&weights)
            .map(|(pair, weight)| weight * (pair[1] - pair[0]) / SAMPLE_PERIOD_S)
            .sum::<f64>()
    };
    let rows = || {
        trials.iter().flat_map(|trial| {
            (0..trial.effort.len().saturating_sub(rows)).step_by((rows / 4).max(1)).map(|row| {
                let regressor = [rate(&trial.velocity[row..]), rate(&trial.position[row..])];
                (regressor, mean(&trial.effort[row..]) - mean(&trial.force_mean[row..]))
            })
        })
    };
    let mut normal = NormalEquations::new();
    rows().for_each(|(regressor, wanted)| normal.add(regressor, wanted));
    let [m, b] = normal.solve();
    rms(rows().map(|([a, v], wanted)| wanted - m * a - b * v))
}

/// K, B and the surface.
type ContactValues = [f64; 3];

fn contact_residual(trials: &[SimulatedTrial], nominal: &NominalParameters) -> f64 {
    let mut values = [nominal.stiffness, nominal.damping, nominal.surface];
    let mut best = residual_rms(trials, nominal, values);
    for _ in 0..12 {
        let step = gauss_newton_step(trials, nominal, values);
        let mut share = 1.0;
        let better = loop {
            let trial = std::array::from_fn(|at| values[at] + share * step[at]);
            let found = residual_rms(trials, nominal, trial);
            if found < best {
                break Some((trial, found));
            }
            share *= 0.4;
            if share < 0.01 {
                break None;
            }
        };
        let Some((trial, found)) = better else { break };
        let gained = best - found;
        (values, best) = (trial, found);
        if gained < 1e-3 * best {
            break;
        }
    }
    best
}

fn model(nominal: &NominalParameters, [k, b, surface]: ContactValues, x: f64, v: f64) -> f64 {
    let p = x - surface;
    let force = k * p + b * v;
    if nominal.bilateral {
        force
    } else if p > 0.0 {
        force.max(0.0)
    } else {
        0.0
    }
}

fn samples(trials: &[SimulatedTrial]) -> impl Iterator<Item = (f64, f64, f64)> {
    trials.iter().flat_map(|trial| {
        let motion = trial.position.iter().zip(&trial.velocity);
        motion.zip(&trial.force).map(|((x, v), force)| (*x, *v, *force))
    })
}

/// The row at which the tool is_at_onset the surface: on which side of the step in the damper's force it falls is a matter of
/// micrometres and tells nothing.
fn is_at_onset(nominal: &NominalParameters, surface: f64, x: f64, v: f64) -> bool {
    !nominal.bilateral && (x - surface).abs() < v.abs() * SAMPLE_PERIOD_S
}

fn residual_rms(trials: &[SimulatedTrial], nominal: &NominalParameters, values: ContactValues) -> f64 {
    let scored = samples(trials).filter(|(x, v, _)| !is_at_onset(nominal, values[2], *x, *v));
    rms(scored.map(|(x, v, force)| force - model(nominal, values, x, v)))
}

/// A Gauss-Newton step on the samples where the model touches.
fn gauss_newton_step(trials: &[SimulatedTrial], nominal: &NominalParameters, values: ContactValues) -> ContactValues {
    let [k, _, surface] = values;
    let mut normal = NormalEquations::new();
    for (x, v, force) in samples(trials) {
        let modelled = model(nominal, values, x, v);
        if modelled != 0.0 && !is_at_onset(nominal, surface, x, v) {
            normal.add([x - surface, v, -k], force - modelled);
        }
    }
    normal.solve()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}
