//! Free curves beside a law: broken lines over the place, the place and direction, or the speed in contact.

use super::data::Data;
use super::fit::Fit;
use super::model::index;
use crate::effects::{DAMPING_KNOTS, linear};

/// On what a free curve depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curve {
    /// The position.
    Place,
    /// The position, on the way in and on the way out for itself.
    PlaceAndDirection,
    /// The velocity, while something is touched.
    Speed,
    /// The velocity, while something is touched, in proportion to the depth: as stated at the greatest.
    SpeedTimesDepth,
}

/// Between which depths below its surface a curve beside `law` reaches, m or rad, where it goes on before the surface by the part `before` of the greatest depth: what pulls
/// or pushes before the touch. `None` where there is no way.
pub(super) fn way_below(law: &Fit, before: f64) -> Option<[f64; 2]> {
    let [low, high] = law.model.scales.positions.map(|position| position - law.values[index::SURFACE]);
    let from = if law.model.bilateral { low } else { low.max(-before * high.max(0.0)) };
    let way = high - from;
    (way.is_finite() && way > 0.0).then_some([from, high])
}

/// The speeds of the knots of a curve over the speed beside `law`: in equal steps up to the fastest in contact, one of them at rest.
pub(super) fn speeds(data: &Data<'_>, law: &Fit) -> Vec<f64> {
    let mut fastest = f64::MIN_POSITIVE;
    for (number, trial) in data.trials.iter().enumerate() {
        let surface = law.model.surface(&law.values, number);
        let is_touched = |row: &usize| law.model.bilateral || trial.position[*row] > surface;
        let touched = (0..trial.len()).filter(|row| data.weights[number][*row] > 0.0).filter(is_touched);
        fastest = touched.map(|row| trial.velocity[row].abs()).fold(fastest, f64::max);
    }
    // Squares: near rest a damper that thins with the speed, or friction, bends most.
    linear(-1.0, 1.0, DAMPING_KNOTS).into_iter().map(|part| fastest * part * part.abs()).collect()
}

/// What one newton at each of `knots` of a `curve` beside `law` adds to each row of `data`, weighted, trial after trial: a column a knot, and of one over place and
/// direction those of the way in before those of the way out.
pub(super) fn columns(data: &Data<'_>, law: &Fit, curve: Curve, knots: &[f64]) -> Vec<Vec<f64>> {
    let count = if curve == Curve::PlaceAndDirection { 2 * knots.len() } else { knots.len() };
    let mut columns = vec![Vec::new(); count];
    for (number, (trial, weights)) in data.trials.iter().zip(&data.weights).enumerate() {
        let surface = law.model.surface(&law.values, number);
        for (row, weight) in weights.iter().enumerate() {
            let (position, velocity) = (trial.position[row], trial.velocity[row]);
            let depth = position - surface;
            let touched = if law.model.bilateral || depth > 0.0 { *weight } else { 0.0 };
            let (at, size, first) = match curve {
                Curve::Place => (position, *weight, 0),
                Curve::PlaceAndDirection => (position, *weight, if velocity < 0.0 { knots.len() } else { 0 }),
                Curve::Speed => (velocity, touched, 0),
                Curve::SpeedTimesDepth => (velocity, touched * depth / law.model.scales.depth, 0),
            };
            columns.iter_mut().for_each(|column| column.push(0.0));
            for (column, hat) in columns[first..].iter_mut().zip(hats(knots, at)) {
                if let Some(last) = column.last_mut() {
                    *last = size * hat;
                }
            }
        }
    }
    columns
}

/// The part that each of `corners`, in rising order, has of a broken line through them at `x`; beyond them the line is level.
fn hats(corners: &[f64], x: f64) -> Vec<f64> {
    let mut parts = vec![0.0; corners.len()];
    let after = corners.partition_point(|corner| *corner <= x);
    match (after.checked_sub(1), corners.get(after)) {
        (None, _) => parts[0] = 1.0,
        (Some(before), None) => parts[before] = 1.0,
        (Some(before), Some(next)) => {
            let part = (x - corners[before]) / (next - corners[before]);
            (parts[before], parts[after]) = (1.0 - part, part);
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_broken_line_are_one_in_all() {
        let corners = [0.0, 1.0, 3.0];
        assert_eq!(hats(&corners, 1.5), [0.0, 0.75, 0.25]);
        for x in [-2.0, 0.0, 0.4, 3.0, 9.0] {
            assert!((hats(&corners, x).iter().sum::<f64>() - 1.0).abs() < 1e-12, "{x}");
        }
        assert_eq!((hats(&corners, -2.0), hats(&corners, 9.0)), (vec![1.0, 0.0, 0.0], vec![0.0, 0.0, 1.0]));
    }
}
