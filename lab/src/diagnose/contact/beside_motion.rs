//! What of a residual does not go with the motion.

use nalgebra::{Matrix3, Vector3};

/// A row, or a coefficient of a transform: what a law leaves, and position, velocity and acceleration there.
#[derive(Debug, Clone, Copy)]
pub struct MotionRow {
    /// What the law leaves, over its own deviation.
    pub left: f64,
    /// Position, velocity, acceleration.
    pub motion: [f64; 3],
}

/// What is left in `rows` beside the part of it that is linear in their motion.
#[must_use]
pub fn without_motion(rows: &[MotionRow]) -> Vec<f64> {
    let scale: [f64; 3] = std::array::from_fn(|at| {
        let squares = rows.iter().map(|row| row.motion[at].powi(2)).sum::<f64>();
        (squares / rows.len() as f64).sqrt().max(f64::MIN_POSITIVE)
    });
    let motion = |row: &MotionRow| Vector3::from_fn(|at, _| row.motion[at] / scale[at]);
    let (mut matrix, mut right) = (Matrix3::identity() * 1e-9, Vector3::zeros());
    for row in rows {
        let motion = motion(row);
        matrix += motion * motion.transpose();
        right += motion * row.left;
    }
    let parts = matrix.cholesky().map_or_else(Vector3::zeros, |factors| factors.solve(&right));
    rows.iter().map(|row| row.left - motion(row).dot(&parts)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_with_the_motion_is_taken_off_and_the_rest_stays() {
        let row = |at: usize| {
            let time = at as f64 * 0.01;
            let motion = [2.0 * time.sin(), 2e-3 * time.cos(), -5.0 * (3.0 * time).sin()];
            // Up and down from row to row: nothing of it is in the motion.
            let own = if at.is_multiple_of(2) { 1.0 } else { -1.0 };
            (MotionRow { left: 3.0 * motion[0] - 400.0 * motion[1] + 0.2 * motion[2] + own, motion }, own)
        };
        let (rows, own): (Vec<MotionRow>, Vec<f64>) = (0..4000).map(row).unzip();
        for (left, own) in without_motion(&rows).into_iter().zip(own) {
            // Its part along three slow waves is below three over the rows.
            assert!((left - own).abs() < 1e-3, "{left} {own}");
        }
    }
}
