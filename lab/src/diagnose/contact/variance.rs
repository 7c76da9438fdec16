//! Variance of each row of the force: by the sensors, by errors of the motion, and by what a law leaves.

use super::criteria::NOTABLE_POWER;
use super::model::{ContactModel, index};
use super::trial::ContactTrial;
use crate::diagnose::linalg::energy;

/// Variance that every row has beside `rows`' own, from these and the squares of their residuals: the one under which the weighted
/// squares are as many as the rows; zero where they are no more without it (R. C. Paule, J. Mandel, *J. Res. NBS* 87, 1982).
#[must_use]
pub fn law_variance(rows: &[(f64, f64)]) -> f64 {
    let excess =
        |law: f64| rows.iter().map(|(variance, square)| square / (variance + law)).sum::<f64>() - rows.len() as f64;
    if rows.is_empty() || excess(0.0) <= 0.0 {
        return 0.0;
    }
    // The sum falls with the variance, and at the greatest square over a row it is below the rows' number.
    let (mut low, mut high) = (0.0, rows.iter().map(|(_, square)| square).sum::<f64>());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Factor between what a law leaves of `rows` and the variances that are stated of them where it leaves notably less, else one: the
/// variance of unit weight a posteriori (E. M. Mikhail, *Observations and Least Squares*, 1976). A sensor's noise that is estimated from
/// its own rows holds whatever of the motion is too quick for a polynomial of a few rows.
#[must_use]
pub fn noise_scale(rows: &[(f64, f64)]) -> f64 {
    let squares: f64 = rows.iter().map(|(variance, square)| square / variance).sum();
    let scale = squares / rows.len().max(1) as f64;
    if scale < 1.0 / NOTABLE_POWER { scale.max(f64::MIN_POSITIVE) } else { 1.0 }
}

/// Variance of each row of `trial` by the sensors, under `model` with `values`; infinite where the row is no measurement of the law.
#[must_use]
pub fn noise_along(model: &ContactModel, values: &[f64], trial: &ContactTrial, number: usize) -> Vec<f64> {
    let slopes = slopes_along(model, values, trial, number);
    let jump = jump_variance(model, values, trial, number);
    let of_row = |row: usize| {
        let place = slopes[0][row].powi(2) * trial.position_variance[row];
        let speed = slopes[1][row].powi(2) * trial.velocity_variance[row];
        let change = slopes[2][row].powi(2) * trial.acceleration_variance[row];
        let sensors = trial.force_variance + place + speed + change;
        // Where a jump hides all else, the row measures when it was, and not the law.
        if trial.counts[row] && jump[row] < sensors { sensors + jump[row] } else { f64::INFINITY }
    };
    (0..trial.len()).map(of_row).collect()
}

/// Change of the force with position, velocity and acceleration along `trial`: by how much an error of each shows.
///
/// The position is moved as a whole. Velocity and acceleration are moved to and fro from row to row, as their errors are: a memory takes
/// up their mean, which is none.
fn slopes_along(model: &ContactModel, values: &[f64], trial: &ContactTrial, number: usize) -> [Vec<f64>; 3] {
    let predicted = |trial: &ContactTrial| model.predicted(values, trial, number);
    let half = |after: Vec<f64>, before: Vec<f64>, step: f64| -> Vec<f64> {
        after.iter().zip(&before).map(|(after, before)| ((after - before) / (2.0 * step)).abs()).collect()
    };
    let step = 1e-3 * model.scales.depth;
    let place = |moved: f64| {
        let mut shifted = values.to_vec();
        shifted[index::SURFACE] += moved;
        model.predicted(&shifted, trial, number)
    };
    let to_and_fro = |column: &[f64], step: f64| -> Vec<f64> {
        column.iter().enumerate().map(|(row, value)| value + if row % 2 == 0 { step } else { -step }).collect()
    };
    let size = |column: &[f64]| 1e-3 * (energy(column) / column.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE);
    let (speed, change) = (size(&trial.velocity), size(&trial.acceleration));
    let fast = |step: f64| ContactTrial { velocity: to_and_fro(&trial.velocity, step), ..trial.clone() };
    let bent = |step: f64| ContactTrial { acceleration: to_and_fro(&trial.acceleration, step), ..trial.clone() };
    [
        half(place(step), place(-step), step),
        half(predicted(&fast(speed)), predicted(&fast(-speed)), speed),
        half(predicted(&bent(change)), predicted(&bent(-change)), change),
    ]
}

/// Variance of a row beside a jump of the force, as a damper makes at the surface. A reading that lies a part `f` of a row beside the
/// motion's is that before the jump or that behind it, where a straight line gives `f` of the jump: it is wrong by f (1 - f) of its
/// square in the mean. And each reading is a mean over some part of its row, by a twelfth more. A jump is told from a bend by second
/// differences of either sign on its two sides; the negative product of neighbours is its square.
fn jump_variance(model: &ContactModel, values: &[f64], trial: &ContactTrial, number: usize) -> Vec<f64> {
    let part = (values[index::TIMING].abs() / trial.step_s).min(0.5);
    let force = model.predicted(values, trial, number);
    let bend: Vec<f64> = force.windows(3).map(|rows| rows[2] - 2.0 * rows[1] + rows[0]).collect();
    let mut variance = vec![0.0; force.len()];
    for (before, pair) in bend.windows(2).enumerate() {
        let square = (part * (1.0 - part) + 1.0 / 12.0) * (-pair[0] * pair[1]).max(0.0);
        variance[before + 1..before + 3].iter_mut().for_each(|row| *row += square);
    }
    variance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_that_is_stated_four_times_too_large_is_taken_down_and_what_a_law_leaves_is_not_taken_for_noise() {
        let rows =
            |stated: f64| -> Vec<(f64, f64)> { (0..100).map(|row| (stated, f64::from(row % 2) * 2.0)).collect() };
        // A mean square of one.
        assert_eq!(noise_scale(&rows(4.0)), 0.25);
        assert_eq!((noise_scale(&rows(1.0)), noise_scale(&rows(0.3))), (1.0, 1.0));
        // A sixth is within what the noise of a sensor is known to.
        assert_eq!(noise_scale(&rows(1.2)), 1.0);
    }
}
