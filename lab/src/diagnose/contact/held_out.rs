//! What a law leaves of rows that its values were not fitted to.

use super::criteria::{SEEN_BY_BOTH, SEEN_BY_EITHER_TRIALS};
use super::data::Data;
use super::fit::{Effort, Fit};
use super::model::{ContactModel, index};
use super::trial::ContactTrial;
use crate::diagnose::ends::ends;
use crate::threshold::Threshold;

/// Two halves of the rows: every other trial, where both halves see the forces of the other, or every other block of each, of which there are so many that
/// both do. Each is fitted once and judged once.
pub struct Folds {
    /// For each half, whether each row of each trial belongs to it.
    halves: [Vec<Vec<bool>>; 2],
}

/// Residuals under the values of the other half.
pub struct HeldOut {
    /// Measured less predicted, N or N m, a column a trial.
    pub residual: Vec<Vec<f64>>,
    /// Squares of it, weighted.
    pub energy: f64,
}

/// Blocks of a single trial, the fewest and the most.
const BLOCKS: usize = 40;
const MOST_BLOCKS: usize = 320;

/// Steps of the search on a half, from the values of the whole.
const STEPS: Effort = Effort(6);

impl Folds {
    /// The halves of the rows of `data`.
    #[must_use]
    pub fn of(data: &Data<'_>) -> Self {
        let in_blocks = || {
            let doubled = std::iter::successors(Some(BLOCKS), |blocks| Some(2 * blocks));
            let mut tried =
                doubled.take_while(|blocks| *blocks < MOST_BLOCKS).map(|blocks| Self::in_blocks(data, blocks));
            tried.find(|folds| folds.both_see(data, SEEN_BY_BOTH)).unwrap_or_else(|| Self::in_blocks(data, MOST_BLOCKS))
        };
        Self::by_trials(data).unwrap_or_else(in_blocks)
    }

    /// The same with `blocks` of each trial, where trials are not halves.
    #[must_use]
    pub fn with_blocks(data: &Data<'_>, blocks: usize) -> Self {
        Self::by_trials(data).unwrap_or_else(|| Self::in_blocks(data, blocks))
    }

    /// Every other trial; `None` of a single one, and where one half does not see what the other has: a step to each of three depths teaches nothing of the
    /// next, and no law is wrong for that.
    fn by_trials(data: &Data<'_>) -> Option<Self> {
        let folds = (data.trials.len() > 1).then(|| Self::halved(data, |number, _| number));
        folds.filter(|folds| folds.both_see(data, SEEN_BY_EITHER_TRIALS))
    }

    /// Every other of so many blocks of each trial.
    fn in_blocks(data: &Data<'_>, blocks: usize) -> Self {
        Self::halved(data, |number, row| number + row / data.trials[number].len().div_ceil(blocks).max(1))
    }

    /// Halves of parts by turns: `part` numbers that of a row of a trial.
    fn halved(data: &Data<'_>, part: impl Fn(usize, usize) -> usize) -> Self {
        let half = |wanted: usize| {
            let trials = data.trials.iter().enumerate();
            let of_trial = |(number, trial): (usize, &ContactTrial)| {
                (0..trial.len()).map(|row| part(number, row) % 2 == wanted).collect()
            };
            trials.map(of_trial).collect()
        };
        Self { halves: [half(0), half(1)] }
    }

    /// Whether either half sees so great a `part` of the force's range.
    fn both_see(&self, data: &Data<'_>, part: Threshold) -> bool {
        let rows = || data.trials.iter().zip(&data.weights).zip(&self.halves[0]);
        let range = |wanted: Option<bool>| {
            let counted = rows().flat_map(|((trial, weights), is_first)| {
                let own = trial.force.iter().zip(weights).zip(is_first);
                own.filter(|((_, weight), is_first)| **weight > 0.0 && wanted.is_none_or(|half| half == **is_first))
                    .map(|((force, _), _)| *force)
            });
            let [low, high] = ends(counted);
            high - low
        };
        [true, false].into_iter().all(|half| range(Some(half)) >= part * range(None))
    }

    pub(super) fn masked<'a>(&self, data: &Data<'a>, half: usize) -> Data<'a> {
        let weights = data.weights.iter().zip(&self.halves[half]).map(|(weights, own)| {
            weights.iter().zip(own).map(|(weight, own)| if *own { *weight } else { 0.0 }).collect()
        });
        Data { noise: data.noise.clone(), weights: weights.collect(), ..*data }
    }

    /// Fits `fit` on each half and takes what is left on the other. What belongs to an unseen trial alone, where the law says so, is
    /// fitted to that trial; nothing else is.
    #[must_use]
    pub fn held_out(&self, data: &Data<'_>, fit: &Fit) -> HeldOut {
        let taught = [0, 1].map(|half| self.masked(data, half).fit(&fit.model, &fit.values, STEPS).values);
        self.judged(data, &fit.model, taught)
    }

    /// Whether each row, trial after trial, belongs to the first half.
    #[must_use]
    pub fn is_first(&self) -> Vec<bool> {
        self.halves[0].concat()
    }

    /// What `model` leaves of each half with the values that the other half gave, `taught`.
    #[must_use]
    pub fn judged(&self, data: &Data<'_>, model: &ContactModel, taught: [Vec<f64>; 2]) -> HeldOut {
        let mut residual: Vec<Vec<f64>> = data.trials.iter().map(|trial| vec![0.0; trial.len()]).collect();
        let mut energy = 0.0;
        let has_own = (0..taught[0].len()).any(|at| model.owner(at).is_some());
        for (half, taught) in taught.into_iter().enumerate() {
            let unseen = self.masked(data, 1 - half);
            let placed = if has_own && data.trials.len() > 1 {
                let is_shared = |at: usize| model.owner(at).is_none() && !(model.own.surface && at == index::SURFACE);
                unseen.fit_holding(model, &taught, STEPS, &is_shared).values
            } else {
                taught
            };
            for (number, weights) in unseen.weights.iter().enumerate() {
                let own = data.residual(model, &placed, number);
                for (row, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                    residual[number][row] = own[row];
                    energy += (own[row] * weight).powi(2);
                }
            }
        }
        HeldOut { residual, energy }
    }
}

/// Root mean square over the rows that count.
#[must_use]
pub fn rms(data: &Data<'_>, columns: &[Vec<f64>]) -> f64 {
    let rows = columns.iter().zip(&data.weights).flat_map(|(column, weights)| column.iter().zip(weights));
    let (sum, count) = rows
        .filter(|(_, weight)| **weight > 0.0)
        .fold((0.0, 0usize), |(sum, count), (value, _)| (sum + value * value, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::nominal::nominal_fit;
    use super::super::testing::{RATE, TestContact};
    use super::*;
    use crate::diagnose::term::Term;

    /// A law with the sensor's bias, fitted to `trials` as a whole.
    fn with_bias(data: &Data<'_>) -> Fit {
        let nominal = nominal_fit(data, &TestContact::nominal());
        let bias = Term { effect: crate::effects::find("force_bias").unwrap(), form: 0 };
        let start: Vec<f64> = nominal.values.iter().copied().chain([0.1]).collect();
        data.fit(&nominal.model.with(bias), &start, Effort::FULL)
    }

    fn mean(column: &[f64]) -> f64 {
        column.iter().sum::<f64>() / column.len() as f64
    }

    /// A zero that is off by 0.4 N in the first of two trials alone: what the other taught knows nothing of it.
    #[test]
    fn what_lives_in_one_trial_is_not_taken_from_it_by_the_other() {
        let trials = [TestContact { zero: 0.4, ..TestContact::PLAIN }.trial(1), TestContact::PLAIN.trial(2)];
        let data = Data::new(&trials);
        let whole = with_bias(&data);
        let held = Folds::of(&data).held_out(&data, &whole);
        // The first is judged without a bias, the second with one of 0.4 N. A leak leaves nothing, the whole's value half of it.
        for (column, left) in held.residual.iter().zip([0.4, -0.4]) {
            assert!((mean(column) - left).abs() < 0.02, "{} N", mean(column));
        }
        // And the energy is that of these residuals.
        let rows = held.residual.iter().zip(&data.weights).flat_map(|(column, weights)| column.iter().zip(weights));
        let energy: f64 = rows.map(|(rest, weight)| (rest * weight).powi(2)).sum();
        assert!((held.energy / energy - 1.0).abs() < 1e-12);
    }

    /// A single trial is parted in stretches by turns: what lives in the even ones is left in them whole.
    #[test]
    fn what_lives_in_every_other_stretch_of_a_single_trial_is_not_taken_from_it() {
        let mut recording = TestContact::PLAIN.recording(3);
        let stretch = ((12.0 * RATE) as usize).div_ceil(BLOCKS);
        let force = recording.force.as_mut().unwrap();
        force
            .iter_mut()
            .enumerate()
            .filter(|(row, _)| (row / stretch).is_multiple_of(2))
            .for_each(|(_, force)| *force += 0.4);
        let trials: [ContactTrial; 1] = [TestContact::seen(&recording)];
        let data = Data::new(&trials);
        let held = Folds::of(&data).held_out(&data, &with_bias(&data));
        let side = |odd: usize| {
            let rows = held.residual[0].iter().enumerate().filter(|(row, _)| row / stretch % 2 == odd);
            mean(&rows.map(|(_, rest)| *rest).collect::<Vec<_>>())
        };
        assert!((side(0) - 0.4).abs() < 0.03 && (side(1) + 0.4).abs() < 0.03, "{} and {} N", side(0), side(1));
    }

    /// Of two trials the second is pressed by 0.6 of the first's force, or by 0.4: the first would be asked of the second for more than twice what that saw,
    /// and so each half is of both.
    #[test]
    fn a_trial_that_sees_less_than_half_of_the_force_is_no_half() {
        let halves = |part: f64| {
            let mut gentle = TestContact::PLAIN.recording(2);
            gentle.position.iter_mut().chain(gentle.force.iter_mut().flatten()).for_each(|value| *value *= part);
            let trials = [TestContact::PLAIN.trial(1), TestContact::seen(&gentle)];
            let first = Folds::of(&Data::new(&trials)).is_first();
            let of_first = |rows: &[bool]| rows.iter().filter(|is_first| **is_first).count() as f64 / rows.len() as f64;
            let (strong, gentle) = first.split_at(trials[0].len());
            [of_first(strong), of_first(gentle)]
        };
        assert_eq!(halves(0.6), [1.0, 0.0]);
        assert!(halves(0.4).into_iter().all(|part| (part - 0.5).abs() < 0.05), "{:?}", halves(0.4));
    }
}
