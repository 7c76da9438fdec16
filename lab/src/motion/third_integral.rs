//! A third integral of white noise: its state, position, velocity and acceleration, over the time between two rows and through a row, forwards and back.
//!
//! The way back is that of the adjoint state (A. E. Bryson, M. Frazier, 1963).

pub(super) type Vector = [f64; 3];
pub(super) type Matrix = [[f64; 3]; 3];

/// The transition over `step` usual steps.
pub(super) fn transition(step: f64) -> Matrix {
    [[1.0, step, 0.5 * step * step], [0.0, 1.0, step], [0.0, 0.0, 1.0]]
}

/// Covariance of what a white third derivative of `density` adds over `step` usual steps.
pub(super) fn process_noise(step: f64, density: f64) -> Matrix {
    let (s2, s3) = (step * step, step * step * step);
    let unit =
        [[s2 * s3 / 20.0, s2 * s2 / 8.0, s3 / 6.0], [s2 * s2 / 8.0, s3 / 3.0, s2 / 2.0], [s3 / 6.0, s2 / 2.0, step]];
    unit.map(|row| row.map(|moment| density * moment))
}

pub(super) fn predict(state: &mut Vector, covariance: &mut Matrix, step: f64, density: f64) {
    if step == 0.0 {
        return;
    }
    let forward = transition(step);
    *state = product(&forward, state);
    let half = times(&forward, covariance);
    let noise = process_noise(step, density);
    for row in 0..3 {
        for column in 0..3 {
            let carried: f64 = (0..3).map(|inner| half[row][inner] * forward[column][inner]).sum();
            covariance[row][column] = carried + noise[row][column];
        }
    }
}

pub(super) fn correct(state: &mut Vector, covariance: &mut Matrix, innovation: f64, variance: f64) {
    let gain: Vector = std::array::from_fn(|row| covariance[row][0] / variance);
    let seen = covariance[0];
    for row in 0..3 {
        state[row] += gain[row] * innovation;
        for column in 0..3 {
            covariance[row][column] -= gain[row] * seen[column];
        }
    }
}

/// The adjoint state before a row from that behind it: (I - K H)^T and what the row itself says.
pub(super) fn through_row(
    adjoint: &mut Vector,
    information: &mut Matrix,
    covariance: &Matrix,
    innovation: f64,
    variance: f64,
) {
    let gain: Vector = std::array::from_fn(|row| covariance[row][0] / variance);
    let kept: Matrix = std::array::from_fn(|row| {
        std::array::from_fn(|column| f64::from(row == column) - if column == 0 { gain[row] } else { 0.0 })
    });
    let turned: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| kept[column][row]));
    *adjoint = product(&turned, adjoint);
    adjoint[0] -= innovation / variance;
    *information = times(&times(&turned, information), &kept);
    information[0][0] += 1.0 / variance;
}

/// The same over the time before a row.
pub(super) fn back_over(adjoint: &mut Vector, information: &mut Matrix, step: f64) {
    let forward = transition(step);
    let turned: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| forward[column][row]));
    *adjoint = product(&turned, adjoint);
    *information = times(&times(&turned, information), &forward);
}

pub(super) fn product(matrix: &Matrix, vector: &Vector) -> Vector {
    std::array::from_fn(|row| matrix[row].iter().zip(vector).map(|(a, b)| a * b).sum())
}

pub(super) fn times(left: &Matrix, right: &Matrix) -> Matrix {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| (0..3).map(|inner| left[row][inner] * right[inner][column]).sum())
    })
}
