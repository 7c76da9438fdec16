//! The effort of a recording that holds none, as the rig's `[effort]` computes it.

use super::Recording;
use crate::rig::EffortLaw;

/// Rows on either side over which a velocity is fitted to positions.
const HALF_WINDOW: usize = 10;

/// The effort by `law`, row by row; `input` is what is recorded of the motor. `None` where a column that it needs is absent.
///
/// A velocity that is not recorded is the slope of a parabola fitted to the positions of 21 rows.
pub fn effort(law: &EffortLaw, recording: &Recording, input: Option<&[f64]>) -> Option<Vec<f64>> {
    let (time, position) = (&recording.time, &recording.position);
    let rows = time.len();
    let velocity = match &recording.velocity {
        Some(velocity) => velocity.clone(),
        None if law.needs_velocity() => slopes(time, position),
        None => vec![0.0; rows],
    };
    if law.input().is_some() {
        return Some(
            input?.iter().zip(&velocity).map(|(input, velocity)| law.effort(*input, *velocity, 0.0)).collect(),
        );
    }
    let reference = recording.reference.as_ref()?;
    let rates = slopes(time, reference);
    let row = |at: usize| law.effort(reference[at] - position[at], velocity[at], rates[at]);
    Some((0..rows).map(row).collect())
}

/// The slope at each row of the parabola through the rows around it, by least squares; rows need not be uniform.
fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let slope = |at: usize| {
        // The same rows on both sides: the ends have a narrower window.
        let half = HALF_WINDOW.min(at).min(time.len() - 1 - at);
        let range = if half == 0 { at.saturating_sub(1)..=(at + 1).min(time.len() - 1) } else { at - half..=at + half };
        let (start, middle) = (time[at], values[at]);
        let points = || range.clone().map(|row| (time[row] - start, values[row] - middle));
        if half < 2 {
            let (first, last) = (*range.start(), *range.end());
            return (values[last] - values[first]) / (time[last] - time[first]);
        }
        // Moments of y = a + b t + c t^2, about the row itself.
        let moment = |power: i32| points().map(|(t, _)| t.powi(power)).sum::<f64>();
        let product = |power: i32| points().map(|(t, y)| t.powi(power) * y).sum::<f64>();
        let matrix = nalgebra::Matrix3::new(
            moment(0),
            moment(1),
            moment(2),
            moment(1),
            moment(2),
            moment(3),
            moment(2),
            moment(3),
            moment(4),
        );
        // Times are scaled by the window's length, or the moments differ by many powers of ten.
        let right = nalgebra::Vector3::new(product(0), product(1), product(2));
        let scale = (time[*range.end()] - time[*range.start()]).max(f64::MIN_POSITIVE);
        let units = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0 / scale, 1.0 / (scale * scale)));
        let solution = (units * matrix * units).lu().solve(&(units * right));
        solution.map_or(0.0, |solution| solution[1] / scale)
    };
    (0..time.len()).map(slope).collect()
}
