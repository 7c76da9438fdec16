//! How much of an effect the nominal physics cannot take up by values of its own.

use crate::nominal::Nominal;
use crate::simulate::{PERIOD, Track};

/// RMS residuals of the best nominal fit to the true, noise-free motion, N.
#[derive(Debug, Clone, Copy)]
pub struct Residual {
    /// Of the force, fitted by K, B and surface.
    pub force: f64,
    /// Of the effort less the measured force, fitted by m and b, in means over 16 ms.
    pub effort: f64,
}

/// Fits all `tracks` at once.
#[must_use]
pub fn residual(tracks: &[Track], nominal: &Nominal) -> Residual {
    Residual { force: contact(tracks, nominal), effort: drive(tracks) }
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
const SEEN: usize = 16;

fn drive(tracks: &[Track]) -> f64 {
    let rows = || {
        tracks.iter().flat_map(|track| {
            (0..track.effort.len().saturating_sub(SEEN)).step_by(SEEN / 4).map(|row| {
                let (end, seconds) = (row + SEEN, SEEN as f64 * PERIOD);
                let mean = |values: &[f64]| values[row..end].iter().sum::<f64>() / SEEN as f64;
                let a = (track.velocity[end] - track.velocity[row]) / seconds;
                let v = (track.position[end] - track.position[row]) / seconds;
                ([a, v], mean(&track.effort) - mean(&track.force_mean))
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
