//! Two bodies along a trial, backwards: the disturbance and the lead of the motor with what all rows say.

use super::innovations::Innovations;
use super::law::{Link, Side};
use super::matrix::{Matrix, transposed_product};
use super::noise::Noise;
use super::trial::DriveTrial;
use super::two_mass_system::{Pair, STATES};

/// A row of the pair's filter, as the smoother needs it.
pub struct PairRow {
    /// Kalman gain.
    pub gain: [f64; STATES],
    /// Whether the sides were coupled for most of it.
    pub coupled: bool,
    /// Which pair its step has.
    pub pair: usize,
    /// The motor's lead over the load after the row, and its covariance with each state.
    pub stretch: f64,
    /// See [`of_stretch`].
    pub spread: [f64; STATES],
}

/// Covariance of the motor's lead over the load with each state.
#[must_use]
pub fn of_stretch(covariance: &Matrix<STATES>) -> [f64; STATES] {
    std::array::from_fn(|column| covariance[0][column] - covariance[2][column])
}

/// Disturbance smoother, as that of one body with the pair of each row; what it leaves of each encoder row; and the motor's smoothed lead
/// over the load, x + P r of each row with what all later rows say (P. de Jong, *J. Am. Stat. Assoc.* 83, 1988).
#[must_use]
pub fn smoothed_pair(
    trial: &DriveTrial,
    link: &Link,
    noise: &Noise,
    pass: &Innovations,
    history: &[PairRow],
    pairs: &[Pair],
) -> [Vec<f64>; 3] {
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let [mut force, mut residual, mut lead] = [(); 3].map(|()| vec![0.0; trial.len()]);
    let mut next = [0.0; STATES];
    for row in (0..trial.len()).rev() {
        let PairRow { gain, coupled, pair, stretch, spread } = &history[row];
        lead[row] = stretch + spread.iter().zip(&next).map(|(spread, next)| spread * next).sum::<f64>();
        if trial.restart[row] {
            next = [0.0; STATES];
            continue;
        }
        let pair = &pairs[*pair];
        let along: f64 = gain.iter().zip(&next).map(|(gain, next)| gain * next).sum();
        let mut adjoint = next;
        let weighted = pass.innovation[row] / pass.variance[row] - along;
        residual[row] = noise.encoder() * weighted;
        adjoint[measured] += weighted;
        let regime = usize::from(*coupled);
        let seen: f64 = pair.response[regime].iter().zip(&adjoint).map(|(response, adjoint)| response * adjoint).sum();
        force[row] = noise.disturbance() / pair.step * seen;
        next = transposed_product(&pair.transition[regime], &adjoint);
    }
    [force, residual, lead]
}
