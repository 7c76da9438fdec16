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

/// Mean square in free motion over what is stated, of what is left beside the mean of each of [`LEAST_STRETCHES`] stretches or more, and beside
/// the motion; zero where it is too short. Where it is not the same near the surface and far from it, the lesser one: what pulls the tool near
/// it, as a neck does, is no noise.
#[must_use]
pub fn free_power(trials: &[ContactTrial], fit: &Fit, noise: &[Vec<f64>], residual: &[Vec<f64>]) -> f64 {
    let height = |number: usize, row: usize| fit.model.surface(&fit.values, number) - trials[number].position[row];
    let rows: Vec<(usize, usize)> = (0..trials.len())
        .flat_map(|number| (0..trials[number].len()).map(move |row| (number, row)))
        .filter(|&(number, row)| height(number, row) >= 0.0 && noise[number][row].is_finite())
        .collect();
    let usual = median(rows.iter().map(|(number, row)| height(*number, *row))).unwrap_or(0.0);
    let runs = rows.chunk_by(|before, after| before.0 == after.0 && before.1 + 1 == after.1);
    let longest = (rows.len() / LEAST_STRETCHES.value() as usize).max(SHORTEST_STRETCH);
    let moved = |&(number, row): &(usize, usize)| {
        let trial = &trials[number];
        let left = residual[number][row] / noise[number][row].sqrt();
        MotionRow { left, motion: [trial.position[row], trial.velocity[row], trial.acceleration[row]] }
    };
    let stretches = runs.flat_map(|run| run.chunks(longest)).filter(|stretch| stretch.len() >= SHORTEST_STRETCH);
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

/// A power, and how many independent squares tell it.
struct Told {
    power: f64,
    freedoms: f64,
}

impl Told {
    /// Both together where their ratio is within what chance makes of it, else the lesser one: ln of the ratio of two means of squares has a
    /// variance of two over the freedoms of each (M. S. Bartlett, D. G. Kendall, *Suppl. J. R. Statist. Soc.* 8, 1946).
    fn with(&self, other: &Self) -> f64 {
        let deviation = (2.0 / self.freedoms + 2.0 / other.freedoms).sqrt();
        if (self.power / other.power).ln().abs() > NORMAL_97_5 * deviation {
            return self.power.min(other.power);
        }
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
    use super::super::model::index;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
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
}
