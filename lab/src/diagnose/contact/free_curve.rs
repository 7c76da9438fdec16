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

/// The speeds of the knots of a curve over the speed beside `law`: up to the fastest in contact, denser towards rest, one of them at rest.
pub(super) fn speeds(data: &Data<'_>, law: &Fit) -> Vec<f64> {
    let mut fastest = f64::MIN_POSITIVE;
    for (number, trial) in data.trials.iter().enumerate() {
        let surface = law.model.surface(&law.values, number);
        let is_touched = |row: &usize| law.model.bilateral || trial.position[*row] > surface;
        let touched = (0..trial.len()).filter(|row| data.weights[number][*row] > 0.0).filter(is_touched);
        fastest = touched.map(|row| trial.velocity[row].abs()).fold(fastest, f64::max);
    }
    // Near rest a damper that thins with the speed, or friction, bends most. A broken line of n pieces is nearest to the root of the speed where its corners lie at the
    // powers 5/2 of equal steps by the mean square, and 4 by the greatest error (J. R. Rice, in *Approximations with Special Emphasis on Spline Functions*, 1969, 133:
    // corners as dense as the root of the curvature, or its power 2/5): cubes lie between.
    linear(-1.0, 1.0, DAMPING_KNOTS).into_iter().map(|part| fastest * part.powi(3)).collect()
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
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// Between corners a and b a broken line is off the root by (√b - √a)² / 4 (√a + √b) at most: by 0.031 of the greatest force next to rest, and by less elsewhere. With corners at the
    /// squares it would be 0.0625.
    #[test]
    fn a_damper_of_the_root_of_the_speed_is_followed_near_rest() {
        let trials = [TestContact::PLAIN.trial(1)];
        let data = Data::new(&trials);
        let corners = speeds(&data, &nominal_fit(&data, &TestContact::nominal()));
        let fastest = corners[DAMPING_KNOTS - 1];
        let root = |speed: f64| (speed.abs() / fastest).sqrt() * speed.signum();
        let off = (-1000..=1000).map(|part| f64::from(part) * 1e-3 * fastest).map(|speed| {
            let line: f64 = hats(&corners, speed).iter().zip(&corners).map(|(part, corner)| part * root(*corner)).sum();
            (line - root(speed)).abs()
        });
        let most = off.fold(0.0, f64::max);
        assert!(most > 0.025 && most < 0.0313, "{most}");
    }

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
