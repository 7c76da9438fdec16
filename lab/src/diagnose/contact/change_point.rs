//! Where a law jumps, in time or over the height above the surface: the change point of least squares.

use super::data::Data;
use super::fit::{Effort, Fit};
use super::model::ContactModel;
use super::trial::ContactTrial;
use crate::effects::Limit;

/// Rounds in which a jump is looked for beside the values that the one before gave.
const ROUNDS: usize = 3;

/// Which values of `fit` say where its law jumps, with what they are.
#[must_use]
pub fn jumps(fit: &Fit) -> Vec<(usize, Limit)> {
    let terms = fit.model.terms.iter().enumerate().flat_map(|(nth, term)| {
        let first = fit.model.first_value_of(nth);
        let own = term.parameters().iter().enumerate().map(move |(offset, own)| (first + offset, own.limit));
        own.filter(|(_, limit)| matches!(limit, Limit::InstantOfJump | Limit::HeightOfJump))
    });
    terms.collect()
}

impl Data<'_> {
    /// `fit` with each place at which its law jumps where least squares has it beside the other values, and those fitted again from there, as far as
    /// that leaves less: no derivative leads to a jump (J. Bai, *Rev. Econ. Stat.* 79, 1997, 551).
    #[must_use]
    pub fn with_jumps(&self, mut fit: Fit, effort: Effort) -> Fit {
        let jumps = jumps(&fit);
        for _ in 0..if jumps.is_empty() { 0 } else { ROUNDS } {
            let mut values = fit.values.clone();
            for &(at, limit) in &jumps {
                values[at] = self.least_squares_jump(&fit.model, &values, at, limit);
            }
            let moved = self.fit_holding(&fit.model, &values, effort, &|_| false);
            if moved.energy >= fit.energy {
                break;
            }
            fit = moved;
        }
        fit
    }

    /// The value in the place `at` of `values`, an instant or a height by `limit`, that leaves the least: of the rows before it the squares without the jump
    /// count, of those after it the ones with it. For a law that remembers what it did before, that is nearly so.
    fn least_squares_jump(&self, model: &ContactModel, values: &[f64], at: usize, limit: Limit) -> f64 {
        let range = model.ranges(values)[at];
        let squares = |jump: f64| {
            let mut values = values.to_vec();
            values[at] = jump;
            self.weighted_residual(model, &values).into_iter().map(|residual| residual * residual)
        };
        let along = |(number, trial): (usize, &ContactTrial)| match limit {
            Limit::HeightOfJump => heights_reached(trial, model.surface(values, number)),
            _ => trial.time.clone(),
        };
        let along = self.trials.iter().enumerate().flat_map(along);
        let mut rows: Vec<(f64, f64)> =
            along.zip(squares(range.high).zip(squares(range.low)).map(|(without, with)| without - with)).collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut left, mut least, mut jump) = (0.0, 0.0, range.low);
        for pair in rows.windows(2) {
            left += pair[0].1;
            if left < least && pair[1].0 > pair[0].0 {
                (least, jump) = (left, 0.5 * (pair[0].0 + pair[1].0));
            }
        }
        jump
    }
}

/// In each row of `trial`, how far above the `surface` the tool has been since it touched last: what lets go at a height holds on in the rows in which that is less.
fn heights_reached(trial: &ContactTrial, surface: f64) -> Vec<f64> {
    let mut most = 0.0f64;
    let reached = trial.position.iter().map(|position| {
        let height = surface - position;
        most = if height < 0.0 { 0.0 } else { most.max(height) };
        most
    });
    reached.collect()
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

    /// A surface that pulls by 0.2 N at 0.2 mm and lets go at 1.5 mm, where 2 % of the pull are left. A search from a height three times as great stays there: it moves the
    /// pull, and no derivative leads to the height.
    #[test]
    fn the_height_at_which_a_pull_lets_go_is_found_from_far_away() {
        let (model, values) = TestContact::PLAIN.law_with("adhesion", 8, &[0.2, 1.5e-3, 0.2e-3]);
        let mut trials = [TestContact::PLAIN.trial(3)];
        let mut without = values.clone();
        without[values.len() - 3] = 0.0;
        let [pulled, plain] = [&values, &without].map(|values| model.predicted(values, &trials[0], 0));
        for (force, (with, without)) in trials[0].force.iter_mut().zip(pulled.iter().zip(&plain)) {
            *force += with - without;
        }
        let data = Data::new(&trials);
        let mut far = values.clone();
        far[values.len() - 2] = 4.5e-3;
        let height = |fit: &Fit| fit.values[values.len() - 2];
        let stays = data.fit_holding(&model, &far, Effort::FULL, &|_| false);
        assert!(height(&stays) > 3e-3, "{:?}", stays.values);
        let found = data.fit(&model, &far, Effort::FULL);
        assert!((height(&found) / 1.5e-3 - 1.0).abs() < 0.1, "{:?}", found.values);
    }
}
