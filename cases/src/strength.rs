//! How much of an effect the nominal physics cannot take up by values of its own.

use crate::nominal::Nominal;
use crate::sensors::Sensors;
use crate::simulate::{PERIOD, Track};

/// RMS residuals of the best nominal fit to the true, noise-free motion, N.
#[derive(Debug, Clone, Copy)]
pub struct Residual {
    /// Of the force, fitted by K, B and surface.
    pub force: f64,
    /// Of the effort less the measured force, fitted by m and b, in means over as long as the encoder needs.
    pub effort: f64,
}

/// Fits all `tracks` at once, as `sensors` show them.
#[must_use]
pub fn residual(tracks: &[Track], nominal: &Nominal, sensors: &Sensors) -> Residual {
    Residual { force: contact(tracks, nominal), effort: drive(tracks, seen(nominal.mass, sensors)) }
}

/// Sums of products, for a least-squares fit of N values.
struct Normal<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> Normal<N> {
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
fn seen(mass: f64, sensors: &Sensors) -> usize {
    let sigma = sensors.position_step / 12.0_f64.sqrt();
    let seconds = (mass * sigma * (720.0 * PERIOD).sqrt() / sensors.floor()).powf(0.4);
    (seconds / PERIOD).ceil() as usize
}

/// How much each of `rows` counts in a mean. The acceleration of a parabola through positions is the mean of the true one
/// with the weight `(1 - u^2)^2`, u from -1 to 1; effort and force are averaged alike.
fn weights(rows: usize) -> Vec<f64> {
    let at = |row: usize| (1.0 - ((2 * row + 1) as f64 / rows as f64 - 1.0).powi(2)).powi(2);
    let sum: f64 = (0..rows).map(at).sum();
    (0..rows).map(|row| at(row) / sum).collect()
}

fn drive(tracks: &[Track], seen: usize) -> f64 {
    let weights = weights(seen);
    let held = |values: &[f64]| values.iter().zip(&weights).map(|(value, weight)| weight * value).sum::<f64>();
    // From one row to the next, as the effort holds until then.
    let rate = |values: &[f64]| {
        values.windows(2).zip(&weights).map(|(pair, weight)| weight * (pair[1] - pair[0]) / PERIOD).sum::<f64>()
    };
    let rows = || {
        tracks.iter().flat_map(|track| {
            (0..track.effort.len().saturating_sub(seen)).step_by((seen / 4).max(1)).map(|row| {
                let regressor = [rate(&track.velocity[row..]), rate(&track.position[row..])];
                (regressor, held(&track.effort[row..]) - held(&track.force_mean[row..]))
            })
        })
    };
    let mut normal = Normal::new();
    rows().for_each(|(regressor, wanted)| normal.add(regressor, wanted));
    let [m, b] = normal.solve();
    rms(rows().map(|([a, v], wanted)| wanted - m * a - b * v))
}

/// K, B and the surface.
type Values = [f64; 3];

fn contact(tracks: &[Track], nominal: &Nominal) -> f64 {
    let mut values = [nominal.stiffness, nominal.damping, nominal.surface];
    let mut best = misfit(tracks, nominal, values);
    for _ in 0..12 {
        let step = descend(tracks, nominal, values);
        let mut share = 1.0;
        let better = loop {
            let trial = std::array::from_fn(|at| values[at] + share * step[at]);
            let found = misfit(tracks, nominal, trial);
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

fn model(nominal: &Nominal, [k, b, surface]: Values, x: f64, v: f64) -> f64 {
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

fn samples(tracks: &[Track]) -> impl Iterator<Item = (f64, f64, f64)> {
    tracks.iter().flat_map(|track| {
        let motion = track.position.iter().zip(&track.velocity);
        motion.zip(&track.force).map(|((x, v), force)| (*x, *v, *force))
    })
}

/// The row at which the tool crosses the surface: on which side of the step in the damper's force it falls is a matter of
/// micrometres and tells nothing.
fn crosses(nominal: &Nominal, surface: f64, x: f64, v: f64) -> bool {
    !nominal.bilateral && (x - surface).abs() < v.abs() * PERIOD
}

fn misfit(tracks: &[Track], nominal: &Nominal, values: Values) -> f64 {
    let told = samples(tracks).filter(|(x, v, _)| !crosses(nominal, values[2], *x, *v));
    rms(told.map(|(x, v, force)| force - model(nominal, values, x, v)))
}

/// A Gauss-Newton step on the samples where the model touches.
fn descend(tracks: &[Track], nominal: &Nominal, values: Values) -> Values {
    let [k, _, surface] = values;
    let mut normal = Normal::new();
    for (x, v, force) in samples(tracks) {
        let modelled = model(nominal, values, x, v);
        if modelled != 0.0 && !crosses(nominal, surface, x, v) {
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
