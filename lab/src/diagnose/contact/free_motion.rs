//! The noise of the force sensor in free motion, in which no law of the contact has a force.

use super::beside_motion::{MotionRow, without_motion};
use super::criteria::{LARGEST_SHARE_BY_PLACE, LEAST_PART_OF_COEFFICIENTS, LEAST_STRETCHES, MOST_TAKEN};
use super::fit::Fit;
use super::rest::integrated_autocorrelation;
use super::trial::ContactTrial;
use crate::diagnose::interval::NORMAL_97_5;
use crate::diagnose::linalg::{correlation_ratio, energy};
use crate::diagnose::median::median;

/// Fewest rows whose mean is taken off.
const SHORTEST_STRETCH: usize = 8;

/// Rows that a power is taken of at the least: it is known to a sixth then.
const LEAST_ROWS: usize = 80;

/// Whether there is free motion in which nothing acts on the tool: a law that is wrong can put its surface far into the contact, and before it
/// the force then follows the position (correlation ratio).
#[must_use]
pub fn has_free_motion(trials: &[ContactTrial], fit: &Fit) -> bool {
    let (mut rows, mut all) = (0, 0);
    for (number, trial) in trials.iter().enumerate() {
        let surface = fit.model.surface(&fit.values, number);
        let free = |column: &[f64]| -> Vec<f64> {
            let rows = column.iter().zip(&trial.position).filter(|(_, position)| **position <= surface);
            rows.map(|(value, _)| *value).collect()
        };
        let (position, force) = (free(&trial.position), free(&trial.force));
        if fit.model.bilateral || correlation_ratio(&position, &force) > LARGEST_SHARE_BY_PLACE {
            return false;
        }
        (rows, all) = (rows + position.len(), all + trial.len());
    }
    rows as f64 >= LEAST_PART_OF_COEFFICIENTS * all as f64
}

/// Where a row lies.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Free,
    InContact,
}

/// Trial and row of each row there that measures the law, in their order.
fn rows_at(place: Place, trials: &[ContactTrial], fit: &Fit, noise: &[Vec<f64>]) -> Vec<(usize, usize)> {
    let is_free = |number: usize, row: usize| trials[number].position[row] <= fit.model.surface(&fit.values, number);
    (0..trials.len())
        .flat_map(|number| (0..trials[number].len()).map(move |row| (number, row)))
        .filter(|&(number, row)| noise[number][row].is_finite() && is_free(number, row) == (place == Place::Free))
        .collect()
}

/// `rows` in pieces whose rows follow each other.
fn runs_of(rows: &[(usize, usize)]) -> impl Iterator<Item = &[(usize, usize)]> {
    rows.chunk_by(|before, after| before.0 == after.0 && before.1 + 1 == after.1)
}

/// What a force of the height alone, the same on the way in as on the way out, leaves of the force in free motion, and what `residual`, of a law,
/// leaves there: mean squares over what is stated. `None` where it is too short.
#[must_use]
pub fn left_by_height_and_law(
    trials: &[ContactTrial],
    fit: &Fit,
    noise: &[Vec<f64>],
    residual: &[Vec<f64>],
) -> Option<[f64; 2]> {
    let rows = rows_at(Place::Free, trials, fit, noise);
    let deviation = |&(number, row): &(usize, usize)| noise[number][row].sqrt();
    let positions =
        rows.iter().map(|&(number, row)| trials[number].position[row] - fit.model.surface(&fit.values, number));
    let forces: Vec<f64> = rows.iter().map(|at| trials[at.0].force[at.1] / deviation(at)).collect();
    let left: Vec<f64> = rows.iter().map(|at| residual[at.0][at.1] / deviation(at)).collect();
    let count = rows.len() as f64;
    let mean = forces.iter().sum::<f64>() / count.max(1.0);
    let squares: f64 = forces.iter().map(|force| (force - mean).powi(2)).sum();
    let by_height = squares * (1.0 - correlation_ratio(&positions.collect::<Vec<_>>(), &forces));
    (rows.len() >= LEAST_ROWS && !fit.model.bilateral).then(|| [by_height / count, energy(&left) / count])
}

/// Mean square in free motion over what is stated, of what is left beside the mean of each of [`LEAST_STRETCHES`] stretches or more, and beside
/// the motion; zero where it is too short. Where it is not the same near the surface and far from it, the lesser one: what pulls the tool near
/// it, as a neck does, is no noise.
#[must_use]
pub fn free_power(trials: &[ContactTrial], fit: &Fit, noise: &[Vec<f64>], residual: &[Vec<f64>]) -> f64 {
    let height = |number: usize, row: usize| fit.model.surface(&fit.values, number) - trials[number].position[row];
    let rows = rows_at(Place::Free, trials, fit, noise);
    let usual = median(rows.iter().map(|(number, row)| height(*number, *row))).unwrap_or(0.0);
    let longest = (rows.len() / LEAST_STRETCHES.value() as usize).max(SHORTEST_STRETCH);
    let moved = |&(number, row): &(usize, usize)| {
        let trial = &trials[number];
        let left = residual[number][row] / noise[number][row].sqrt();
        MotionRow { left, motion: [trial.position[row], trial.velocity[row], trial.acceleration[row]] }
    };
    let stretches =
        runs_of(&rows).flat_map(|run| run.chunks(longest)).filter(|stretch| stretch.len() >= SHORTEST_STRETCH);
    let is_far = |stretch: &&[(usize, usize)]| stretch.iter().all(|(number, row)| height(*number, *row) > usual);
    let (far, near): (Vec<_>, Vec<_>) = stretches.partition(is_far);
    let power = |side: Vec<&[(usize, usize)]>| {
        power_beside_means(&side.iter().map(|rows| beside_mean(rows.iter().map(moved).collect())).collect::<Vec<_>>())
    };
    match [far, near].map(power) {
        [Some(far), Some(near)] => far.with(&near),
        [far, near] => far.or(near).map_or(0.0, |one| one.power),
    }
}

/// Power of what is left in free motion, beside each trial's mean there, or in contact, over what is stated, and how many squares tell it;
/// `None` where they are too few.
fn told_of(
    trials: &[ContactTrial],
    fit: &Fit,
    noise: &[Vec<f64>],
    residual: &[Vec<f64>],
    place: Place,
) -> Option<Told> {
    let rows = rows_at(place, trials, fit, noise);
    if rows.len() < LEAST_ROWS {
        return None;
    }
    let left = |&(number, row): &(usize, usize)| residual[number][row] / noise[number][row].sqrt();
    let mean = |number: usize| {
        let (count, sum) =
            rows.iter().filter(|at| at.0 == number).fold((0.0, 0.0), |(count, sum), at| (count + 1.0, sum + left(at)));
        if place == Place::Free && count > 0.0 { sum / count } else { 0.0 }
    };
    let means: Vec<f64> = (0..trials.len()).map(mean).collect();
    let runs: Vec<Vec<f64>> = runs_of(&rows).map(|run| run.iter().map(|at| left(at) - means[at.0]).collect()).collect();
    let rows = rows.len() as f64;
    let squares: f64 = runs.iter().map(|run| energy(run)).sum();
    // What wanders for longer than a run is one error of all of its rows (B. R. Moulton, *Rev. Econ. Stat.* 72, 1990).
    let of_runs: f64 =
        runs.iter().map(|run| run.iter().sum::<f64>().powi(2)).sum::<f64>() / squares.max(f64::MIN_POSITIVE);
    let memory = integrated_autocorrelation(&runs.iter().map(Vec::as_slice).collect::<Vec<_>>()).max(of_runs);
    Some(Told { power: squares / rows, freedoms: rows / memory })
}

/// Power of the sensor's noise in contact, over what is stated, by free motion and contact together, where what `fit` leaves in contact is no more than what
/// is left in free motion, in which nothing is touched: no law of the contact leaves it. `None` where it is more, or where free motion has not as
/// many independent squares as [`LEAST_STRETCHES`] to tell its power by.
#[must_use]
pub fn power_of_all(trials: &[ContactTrial], fit: &Fit, noise: &[Vec<f64>], residual: &[Vec<f64>]) -> Option<f64> {
    if !has_free_motion(trials, fit) {
        return None;
    }
    let free = told_of(trials, fit, noise, residual, Place::Free)?;
    let in_contact = told_of(trials, fit, noise, residual, Place::InContact)?;
    (free.freedoms >= LEAST_STRETCHES.value() && !in_contact.is_more_than(&free)).then(|| in_contact.with(&free))
}

/// A power, and how many independent squares tell it.
struct Told {
    power: f64,
    freedoms: f64,
}

impl Told {
    /// Both together where their ratio is within what chance makes of it, else the lesser one: ln of the ratio of two means of squares has a
    /// variance of two over the freedoms of each (M. S. Bartlett, D. G. Kendall, *Suppl. J. R. Statist. Soc.* 8, 1946).
    fn with(&self, other: &Self) -> f64 {
        if self.is_more_than(other) || other.is_more_than(self) {
            return self.power.min(other.power);
        }
        self.pooled(other)
    }

    /// Whether it is more than `other` by what chance does not make of their ratio.
    fn is_more_than(&self, other: &Self) -> bool {
        let deviation = (2.0 / self.freedoms + 2.0 / other.freedoms).sqrt();
        (self.power / other.power).ln() > NORMAL_97_5 * deviation
    }

    fn pooled(&self, other: &Self) -> f64 {
        (self.power * self.freedoms + other.power * other.freedoms) / (self.freedoms + other.freedoms)
    }
}

/// Power of what is left in `stretches`, which are beside their means, and beside the motion, with what the means took of it: as many rows' as
/// tell no more than one. `None` where they are too few.
fn power_beside_means(stretches: &[Vec<MotionRow>]) -> Option<Told> {
    let left = without_motion(&stretches.concat());
    if left.len() < LEAST_ROWS {
        return None;
    }
    let mut rest = left.as_slice();
    let pieces = stretches.iter().map(|stretch| {
        let (piece, others) = rest.split_at(stretch.len());
        rest = others;
        piece
    });
    let memory = integrated_autocorrelation(&pieces.collect::<Vec<_>>());
    let rows = left.len() as f64;
    let taken = (memory * stretches.len() as f64 / rows).min(MOST_TAKEN.value());
    Some(Told { power: energy(&left) / (rows * (1.0 - taken)), freedoms: rows * (1.0 - taken) / memory })
}

/// `rows` beside the mean of each of their columns.
fn beside_mean(mut rows: Vec<MotionRow>) -> Vec<MotionRow> {
    let count = rows.len() as f64;
    let left = rows.iter().map(|row| row.left).sum::<f64>() / count;
    let motion: [f64; 3] = std::array::from_fn(|at| rows.iter().map(|row| row.motion[at]).sum::<f64>() / count);
    for row in &mut rows {
        row.left -= left;
        row.motion.iter_mut().zip(motion).for_each(|(value, mean)| *value -= mean);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::super::data::Data;
    use super::super::fit::Effort;
    use super::super::model::index;
    use super::super::nominal::nominal_fit;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    #[test]
    fn two_powers_are_one_where_chance_makes_their_ratio() {
        let told = |power: f64, freedoms: f64| Told { power, freedoms };
        // Of fifty and fifty squares the ratio's logarithm has a deviation of 0.283: a factor of 1.74 at 1.96 of them.
        assert!((told(1.0, 50.0).with(&told(1.7, 50.0)) - 1.35).abs() < 1e-12);
        assert_eq!(told(1.0, 50.0).with(&told(1.8, 50.0)), 1.0);
        assert_eq!(told(1.8, 50.0).with(&told(1.0, 50.0)), 1.0);
    }

    #[test]
    fn before_a_surface_that_lies_within_the_contact_nothing_is_free() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial(seed));
        let data = Data::new(&trials);
        let mut fit = nominal_fit(&data, &TestContact::nominal());
        assert!(has_free_motion(&trials, &fit));
        // Four millimetres of eight: before it the spring's force is all that is left.
        fit.values[index::SURFACE] = 4e-3;
        assert!(!has_free_motion(&trials, &fit));
    }

    /// What the nominal law leaves of two trials, with the noise that is stated of each row.
    fn nominal_of(trials: &[ContactTrial]) -> (Fit, Data<'_>, Vec<Vec<f64>>) {
        let data = Data::new(trials);
        let first = nominal_fit(&data, &TestContact::nominal());
        let fit = data.fit(&first.model, &first.values, Effort::FULL);
        let residual = data.residuals(&fit.model, &fit.values);
        (fit, data, residual)
    }

    /// Noise of ten times the stated power, in which five rows say the same, is as loud in contact: no law leaves it. What a spring's bend leaves is
    /// in contact alone.
    #[test]
    fn what_is_as_loud_in_free_motion_is_the_sensors() {
        let heard = |trials: &[ContactTrial]| {
            let (fit, data, residual) = nominal_of(trials);
            power_of_all(trials, &fit, &data.noise, &residual)
        };
        let power = heard(&[1, 2].map(|seed| TestContact::PLAIN.remembering(5.0, 3.0 * FORCE_NOISE, seed))).unwrap();
        // 6000 rows of which ten say the same (1 + 2 sum of exp(-k / 5)): a power is known to sqrt(2 / 600), a seventeenth.
        assert!((power / 10.0 - 1.0).abs() < 0.2, "{power}");
        let bent = TestContact { exponent: 1.8, ..TestContact::PLAIN };
        assert_eq!(heard(&[1, 2].map(|seed| bent.trial(seed))), None);
        // A zero that wanders over the whole trial tells its power by a few squares: it may be a drift.
        assert_eq!(heard(&[1, 2].map(|seed| TestContact::PLAIN.remembering(500.0, 3.0 * FORCE_NOISE, seed))), None);
    }

    #[test]
    fn a_pull_that_is_the_same_both_ways_is_a_force_of_the_height() {
        let pulled = |both_ways: bool| {
            let trials = [1, 2].map(|seed| {
                let mut recording = TestContact::PLAIN.recording(seed);
                let before = [&recording.position[..1], &recording.position[..]].concat();
                let force = recording.force.as_mut().unwrap();
                for ((force, x), before) in force.iter_mut().zip(&recording.position).zip(before) {
                    if *x < 0.0 && (both_ways || *x < before) {
                        *force -= 0.4 / (1.0 - x / 5e-4).powi(2);
                    }
                }
                TestContact::seen(&recording)
            });
            let (fit, data, residual) = nominal_of(&trials);
            left_by_height_and_law(&trials, &fit, &data.noise, &residual).unwrap()
        };
        let [by_height, by_law] = pulled(true);
        assert!(by_height < 0.2 * by_law, "{by_height} {by_law}");
        // On the way out alone, half of the pull's power is between both ways.
        let [by_height, by_law] = pulled(false);
        assert!(by_height > 0.3 * by_law, "{by_height} {by_law}");
    }
}
