//! The forces at the knots of a learned element, as a penalised least-squares spline.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::data::Data;
use super::fit::Fit;
use super::held_out::Folds;
use super::model::ContactModel;
use super::rest::Rest;
use crate::diagnose::linalg::{dot, energy, gram};
use crate::effects::{LEARNED_KNOTS, geometric};

/// Rows that a spline is fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The first half.
    FirstHalf,
    /// The second.
    SecondHalf,
    /// Both.
    All,
}

/// Normal equations of some rows.
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// Squares of the target.
    squares: f64,
}

/// The linear least-squares problem for one travel of the turn.
pub struct Spline {
    /// Values of the law, the turn and the knots' places.
    before: Vec<f64>,
    /// Of both halves.
    halves: [Normal; 2],
    /// What is known before any row of each force of the mean, and of the loop: one over its variance, in squares of the weighted
    /// residual.
    prior: [f64; 2],
}

/// Least and greatest penalty of second differences, in mean squares of a column, and how many are tried between them.
const PENALTIES: [f64; 2] = [1e-6, 10.0];
const PENALTY_COUNT: usize = 8;

/// Forces at the knots: of the mean, and of the loop.
const FORCES: usize = 2 * LEARNED_KNOTS;

impl Spline {
    /// The forces at `places` that take what `law` leaves, where the element of `model` turns within `turn`.
    #[must_use]
    pub fn of(data: &Data<'_>, law: &Fit, model: &ContactModel, turn: f64, places: &[f64], folds: &Folds) -> Self {
        let before: Vec<f64> = law.values.iter().copied().chain([turn]).chain(places.iter().copied()).collect();
        let mut values = before.clone();
        // The step of the derivatives, which are exact at any: the force is linear in them.
        values.resize(model.count(), 1e-2 * model.scales.force);
        let ranges = model.ranges(&values);
        let free: Vec<usize> = (before.len()..values.len()).collect();
        let base = data.weighted_residual(model, &values);
        let mut columns = data.columns(model, &values, &ranges, &free, &base);
        let mut target: Vec<f64> = base.iter().map(|rest| -rest).collect();
        for (column, &at) in columns.iter_mut().zip(&free) {
            column.iter_mut().for_each(|slope| *slope /= ranges[at].size);
            target.iter_mut().zip(&*column).for_each(|(target, slope)| *target += slope * values[at]);
        }
        let is_first = folds.is_first();
        let halves = [true, false].map(|first| {
            let taken = |rows: &[f64]| -> Vec<f64> {
                rows.iter().zip(&is_first).map(|(row, is_first)| if *is_first == first { *row } else { 0.0 }).collect()
            };
            Normal::of(&columns.iter().map(|column| taken(column)).collect::<Vec<_>>(), &taken(&target))
        });
        Self { before, halves, prior: [model.scales.force.powi(-2); 2] }
    }

    /// The same with what is known of the loop counted against rows of which one in `rest` tells no more than one: it deviates by no more
    /// than the range of the recorded force. A loop without a way back is none, and what was seen on the way in is the mean's.
    #[must_use]
    pub fn where_left(self, rest: &Rest) -> Self {
        let [mean, half] = self.prior;
        Self { prior: [mean, half * rest.power * rest.correlated_rows], ..self }
    }

    /// The penalty under which either half leaves least of the other, and what that is.
    #[must_use]
    pub fn best_penalty(&self) -> Option<(f64, f64)> {
        let [first, second] = &self.halves;
        let tried = geometric(PENALTIES[0], PENALTIES[1], PENALTY_COUNT).into_iter().filter_map(|penalty| {
            let left = second.left(&self.forces(penalty, Part::FirstHalf)?)
                + first.left(&self.forces(penalty, Part::SecondHalf)?);
            Some((penalty, left))
        });
        tried.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The model's values with the forces that the rows of `part` give.
    #[must_use]
    pub fn values(&self, penalty: f64, part: Part) -> Option<Vec<f64>> {
        let forces = self.forces(penalty, part)?;
        Some(self.before.iter().chain(forces.iter()).copied().collect())
    }

    /// Covariance of the forces: of the posterior whose prior the penalty is (G. Wahba, *J. R. Stat. Soc. B* 45, 1983), rows that tell no
    /// more than one in `rest` counted once.
    #[must_use]
    pub fn covariance(&self, penalty: f64, rest: &Rest) -> Option<DMatrix<f64>> {
        let (factors, _) = self.factors(penalty, Part::All)?;
        Some(factors.inverse() * (rest.power * rest.correlated_rows))
    }

    fn forces(&self, penalty: f64, part: Part) -> Option<DVector<f64>> {
        let (factors, right) = self.factors(penalty, part)?;
        Some(factors.solve(&right))
    }

    fn factors(&self, penalty: f64, part: Part) -> Option<(Cholesky<f64, Dyn>, DVector<f64>)> {
        let [first, second] = &self.halves;
        let (matrix, right) = match part {
            Part::FirstHalf => (first.matrix.clone(), first.right.clone()),
            Part::SecondHalf => (second.matrix.clone(), second.right.clone()),
            Part::All => (&first.matrix + &second.matrix, &first.right + &second.right),
        };
        let size = (first.matrix.trace() + second.matrix.trace()) / FORCES as f64;
        let prior = DVector::from_fn(FORCES, |at, _| self.prior[at / LEARNED_KNOTS]);
        let known = roughness() * (penalty * size) + DMatrix::from_diagonal(&prior);
        Some(((matrix + known).cholesky()?, right))
    }
}

impl Normal {
    fn of(columns: &[Vec<f64>], target: &[f64]) -> Self {
        let count = columns.len();
        let right = DVector::from_iterator(count, columns.iter().map(|column| dot(column, target)));
        Self { matrix: gram(columns), right, squares: energy(target) }
    }

    /// Squares of what `forces` leave of the target.
    fn left(&self, forces: &DVector<f64>) -> f64 {
        self.squares - 2.0 * self.right.dot(forces) + (&self.matrix * forces).dot(forces)
    }
}

/// Sum of squares of the second differences of either curve, as a quadratic form of its forces.
fn roughness() -> DMatrix<f64> {
    let mut form = DMatrix::zeros(FORCES, FORCES);
    for start in [0, LEARNED_KNOTS] {
        for first in start..start + LEARNED_KNOTS - 2 {
            let difference = [(first, 1.0), (first + 1, -2.0), (first + 2, 1.0)];
            for (row, a) in difference {
                for (column, b) in difference {
                    form[(row, column)] += a * b;
                }
            }
        }
    }
    form
}

#[cfg(test)]
mod tests {
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::super::trial::ContactTrial;
    use super::*;
    use crate::diagnose::term::Term;
    use crate::effects::{LEARNED, LEARNED_FORM};

    /// Curves learned from other recordings of the same contact differ by as much as their deviations say.
    #[test]
    fn curves_scatter_by_their_deviations() {
        let trials = |seed: u64| -> Vec<ContactTrial> {
            [2 * seed, 2 * seed + 1].map(|seed| TestContact::PLAIN.trial(seed)).to_vec()
        };
        let first = trials(0);
        let law = nominal_fit(&Data::new(&first), &TestContact::nominal());
        let model = law.model.with(Term { effect: LEARNED, form: LEARNED_FORM });
        let places: Vec<f64> = (0..LEARNED_KNOTS).map(|knot| -2e-3 + 11e-3 * knot as f64 / 23.0).collect();
        let learned = |trials: &[ContactTrial]| -> [Vec<f64>; 2] {
            let data = Data::new(trials);
            let spline = Spline::of(&data, &law, &model, 1e-3, &places, &Folds::of(&data));
            let values = spline.values(1e-6, Part::All).unwrap();
            let fit = Fit { model: model.clone(), values: values.clone(), energy: 0.0 };
            let covariance = spline.covariance(1e-6, &Rest::of(&data, &fit)).unwrap();
            let deviations = covariance.diagonal().iter().map(|variance| variance.sqrt()).collect();
            [values[values.len() - FORCES..].to_vec(), deviations]
        };
        let [reference, deviations] = learned(&first);
        // Where the tool was often, from before the touch to seven millimetres.
        let knots = 4..19;
        let mut squares = Vec::new();
        for seed in 1..6 {
            let [forces, _] = learned(&trials(seed));
            squares.extend(knots.clone().map(|at| ((forces[at] - reference[at]) / deviations[at]).powi(2) / 2.0));
        }
        // Of 75 differences that share a reference and neighbours.
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((0.4..2.0).contains(&mean), "{mean}");
    }

    #[test]
    fn a_straight_curve_is_not_rough_and_a_kink_is() {
        let of = |force: &dyn Fn(f64) -> f64| {
            let forces = DVector::from_fn(FORCES, |at, _| force((at % LEARNED_KNOTS) as f64));
            (roughness() * &forces).dot(&forces)
        };
        assert!(of(&|at| 3.0 * at - 1.0).abs() < 1e-9);
        // One second difference of two in either curve.
        assert!((of(&|at| (at - 5.0f64).abs()) - 8.0).abs() < 1e-9);
    }
}
