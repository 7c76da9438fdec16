//! The instant at which a law jumps: the change point of least squares.

use super::data::Data;
use super::fit::{Effort, Fit};
use super::model::ContactModel;
use crate::effects::Limit;

/// Rounds in which an instant is looked for beside the values that the one before gave.
const ROUNDS: usize = 3;

/// Which values of `fit` are instants at which its law jumps.
#[must_use]
pub fn jumps(fit: &Fit) -> Vec<usize> {
    let terms = fit.model.terms.iter().enumerate().flat_map(|(nth, term)| {
        let first = fit.model.first_value_of(nth);
        let own = term.parameters().iter().enumerate();
        own.filter(|(_, parameter)| parameter.limit == Limit::InstantOfJump).map(move |(offset, _)| first + offset)
    });
    terms.collect()
}

impl Data<'_> {
    /// `fit` with each instant at which its law jumps where least squares has it beside the other values, and those fitted again from there, as far as
    /// that leaves less: no derivative leads to an instant (J. Bai, *Rev. Econ. Stat.* 79, 1997, 551).
    #[must_use]
    pub fn with_instants(&self, mut fit: Fit, effort: Effort) -> Fit {
        let jumps = jumps(&fit);
        for _ in 0..if jumps.is_empty() { 0 } else { ROUNDS } {
            let mut values = fit.values.clone();
            for &at in &jumps {
                values[at] = self.least_squares_instant(&fit.model, &values, at);
            }
            let moved = self.fit_holding(&fit.model, &values, effort, &|_| false);
            if moved.energy >= fit.energy {
                break;
            }
            fit = moved;
        }
        fit
    }

    /// The instant in the place `at` of `values`, s, that leaves the least: of the rows before it the squares without the jump count, of those after it
    /// the ones with it. For a law that remembers what it did before, that is nearly so.
    fn least_squares_instant(&self, model: &ContactModel, values: &[f64], at: usize) -> f64 {
        let range = model.ranges(values)[at];
        let squares = |instant: f64| {
            let mut values = values.to_vec();
            values[at] = instant;
            self.weighted_residual(model, &values).into_iter().map(|residual| residual * residual)
        };
        let times = self.trials.iter().flat_map(|trial| trial.time.iter().copied());
        let mut rows: Vec<(f64, f64)> =
            times.zip(squares(range.high).zip(squares(range.low)).map(|(without, with)| without - with)).collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut left, mut least, mut instant) = (0.0, 0.0, range.low);
        for pair in rows.windows(2) {
            left += pair[0].1;
            if left < least && pair[1].0 > pair[0].0 {
                (least, instant) = (left, 0.5 * (pair[0].0 + pair[1].0));
            }
        }
        instant
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{RATE, TestContact};
    use super::*;

    /// K rises by a fifth in the midst of a contact. A search from an instant two contacts earlier stays there, however right its other values are.
    #[test]
    fn a_jump_is_found_from_far_away() {
        const INSTANT: f64 = 4.25;
        let (model, values) = TestContact::PLAIN.law_with("time_varying_stiffness", 1, &[0.2, INSTANT]);
        let mut trials = [TestContact::PLAIN.trial(3)];
        let without = [&values[..values.len() - 2], &[0.0, INSTANT]].concat();
        let [stiffer, softer] = [&values, &without].map(|values| model.predicted(values, &trials[0], 0));
        for (force, (with, without)) in trials[0].force.iter_mut().zip(stiffer.iter().zip(&softer)) {
            *force += with - without;
        }
        let data = Data::new(&trials);
        let mut far = values.clone();
        *far.last_mut().unwrap() = 1.6;
        let stays = data.fit_holding(&model, &far, Effort::FULL, &|_| false);
        assert!((stays.values.last().unwrap() - INSTANT).abs() > 1.0, "{:?}", stays.values);
        let found = data.fit(&model, &far, Effort::FULL);
        let [change, instant] = found.values[values.len() - 2..] else { panic!("two values") };
        // Within a row or two, and a level to some hundredths, of 250 rows a second and 0.02 N of some newtons.
        assert!((instant - INSTANT).abs() < 3.0 / RATE && (change - 0.2).abs() < 0.02, "{change} {instant}");
    }
}
