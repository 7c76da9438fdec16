//! Rows of free motion, and what of the force there goes with the place or with the speed.

use super::data::Data;
use super::fit::Fit;
use super::parasitic_force::{Along, ParasiticForce};
use super::rest::integrated_autocorrelation;
use super::trial::ContactTrial;
use crate::diagnose::linalg::{energy, solve};

/// Rows from which a force is looked for.
const LEAST_ROWS: usize = 80;

/// A row of free motion.
struct FreeRow {
    trial: usize,
    /// One over the force sensor's deviation.
    weight: f64,
    /// Since the trial began, s.
    time: f64,
    position: f64,
    velocity: f64,
    acceleration: f64,
    /// Change of the acceleration, m/s^3 or rad/s^3.
    jerk: f64,
}

/// Free motion away from the surface, where nothing of the contact acts.
pub(super) struct FreeRows {
    rows: Vec<FreeRow>,
    /// What a law leaves there, weighted.
    left: Vec<f64>,
    trials: usize,
}

/// Of the acceleration of `trial` about its `row`.
fn jerk(trial: &ContactTrial, row: usize) -> f64 {
    let (before, after) = (row.saturating_sub(1), (row + 1).min(trial.len() - 1));
    (trial.acceleration[after] - trial.acceleration[before]) / (trial.time[after] - trial.time[before])
}

impl FreeRows {
    /// The rows of `data` before the surface of `law`, but for the nearest share `near` of them, in which the surface may lie and adhesion acts; `None` where
    /// they are too few, or where the tool is held on both sides.
    pub fn of(data: &Data<'_>, law: &Fit, near: f64) -> Option<Self> {
        if law.model.bilateral {
            return None;
        }
        let height = |&(number, row): &(usize, usize)| {
            law.model.surface(&law.values, number) - data.trials[number].position[row]
        };
        let all =
            (0..data.trials.len()).flat_map(|number| (0..data.trials[number].len()).map(move |row| (number, row)));
        let free: Vec<(usize, usize)> = all.filter(|at| data.trials[at.0].counts[at.1] && height(at) > 0.0).collect();
        let mut heights: Vec<f64> = free.iter().map(height).collect();
        heights.sort_unstable_by(f64::total_cmp);
        let lowest = *heights.get((near * heights.len() as f64) as usize)?;
        let residual = data.residuals(&law.model, &law.values);
        let (mut left, mut rows) = (Vec::new(), Vec::new());
        for (number, row) in free.into_iter().filter(|at| height(at) > lowest) {
            let trial = &data.trials[number];
            let weight = trial.force_variance.sqrt().recip();
            left.push(weight * residual[number][row]);
            rows.push(FreeRow {
                trial: number,
                weight,
                time: trial.time[row],
                position: trial.position[row],
                velocity: trial.velocity[row],
                acceleration: trial.acceleration[row],
                jerk: jerk(trial, row),
            });
        }
        (rows.len() >= LEAST_ROWS).then_some(Self { rows, left, trials: data.trials.len() })
    }

    /// Each force that could be there, with what it gains beyond the price of its values, nats.
    pub fn forces(&self) -> Vec<(ParasiticForce, f64)> {
        let largest =
            |value: &dyn Fn(&FreeRow) -> f64| self.rows.iter().map(|row| value(row).abs()).fold(0.0, f64::max);
        let origin = self.rows.iter().map(|row| row.position).sum::<f64>() / self.rows.len() as f64;
        let place = |order| ParasiticForce {
            along: Along::Place,
            origin,
            unit: largest(&|row| row.position - origin),
            zero: 0.0,
            parts: vec![0.0; order],
        };
        let velocity = |order| ParasiticForce {
            along: Along::Velocity,
            origin: 0.0,
            unit: largest(&|row| row.velocity),
            zero: 0.0,
            parts: vec![0.0; order],
        };
        let beside = self.beside();
        let each = (1..=3).map(place).chain((1..=2).map(velocity)).filter(|force| force.unit > 0.0);
        each.filter_map(|force| self.fitted(&beside, force)).collect()
    }

    /// What may be there anyway: each trial's zero and its drift, and a mass that the sensor carries. What the mass pulls with may be read before or after the position,
    /// as where the sensor is read once the effort has changed: that goes with the jerk, which of a vibration is as the speed.
    fn beside(&self) -> Vec<Vec<f64>> {
        let column = |value: &dyn Fn(&FreeRow) -> f64| -> Vec<f64> {
            self.rows.iter().map(|row| row.weight * value(row)).collect()
        };
        let of_trials = (0..self.trials).flat_map(|trial| {
            let only = move |row: &FreeRow, value: f64| if row.trial == trial { value } else { 0.0 };
            [column(&|row| only(row, 1.0)), column(&|row| only(row, row.time))]
        });
        let all = of_trials.chain([column(&|row| row.acceleration), column(&|row| row.jerk)]);
        all.filter(|column| energy(column) > 0.0).collect()
    }

    /// `force` with the parts that fit best beside the columns `beside`, and what it gains.
    fn fitted(&self, beside: &[Vec<f64>], force: ParasiticForce) -> Option<(ParasiticForce, f64)> {
        let own = (0..force.parts.len()).map(|at| {
            let value = |row: &FreeRow| row.weight * force.basis(row.position, row.velocity)[at];
            self.rows.iter().map(value).collect::<Vec<f64>>()
        });
        let (without, _) = self.least_squares(beside)?;
        let (rest, found) = self.least_squares(&beside.iter().cloned().chain(own).collect::<Vec<_>>())?;
        let count = rest.len() as f64;
        let correlated_rows = integrated_autocorrelation(&[&rest]);
        let price = 0.5 * (count / correlated_rows).max(1.0).ln() * force.parts.len() as f64;
        let power = (energy(&rest) / count).max(1.0);
        let gain = (energy(&without) - energy(&rest)) / (2.0 * power * correlated_rows) - price;
        let mut force = ParasiticForce { parts: found[beside.len()..].to_vec(), ..force };
        if force.along == Along::Place {
            // A constant of it is not told from the sensor's zero, and is taken for its own.
            let shown = self.rows.iter().zip(self.left.iter().zip(&rest));
            let zero = |(row, (left, rest)): (&FreeRow, (&f64, &f64))| {
                (left - rest) / row.weight - force.at(row.position, row.velocity)
            };
            force.zero = shown.map(zero).sum::<f64>() / count;
        }
        Some((force, gain))
    }

    /// What `columns` leave, and their parts.
    fn least_squares(&self, columns: &[Vec<f64>]) -> Option<(Vec<f64>, Vec<f64>)> {
        let directions: Vec<(usize, Vec<f64>)> = columns.iter().cloned().enumerate().collect();
        let found: Vec<f64> = solve(&directions, &self.left)?.iter().copied().collect();
        let mut rest = self.left.clone();
        for (column, part) in columns.iter().zip(&found) {
            rest.iter_mut().zip(column).for_each(|(rest, value)| *rest -= part * value);
        }
        Some((rest, found))
    }
}

#[cfg(test)]
mod tests {
    use super::super::criteria::LEAST_GAIN;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// A mass of 10 kg beyond the sensor that is read twelve rows before the position, as where the effort has changed meanwhile: what it pulls with goes with the jerk, too,
    /// which is as the speed where the tool swings. That is no force of the speed; one of 1 N s/m is found. Without the jerk the mass would have one of 15 nats.
    #[test]
    fn a_mass_that_is_read_early_is_no_force_of_the_speed() {
        let plain = [1, 2].map(|seed| TestContact::PLAIN.trial(seed));
        let law = nominal_fit(&Data::new(&plain), &TestContact::nominal());
        let gained = |more: &dyn Fn(&ContactTrial, usize) -> f64| {
            let trials = plain.clone().map(|mut trial| {
                let added: Vec<f64> = (0..trial.len()).map(|row| more(&trial, row)).collect();
                trial.force.iter_mut().zip(added).for_each(|(force, added)| *force += added);
                trial
            });
            let forces = FreeRows::of(&Data::new(&trials), &law, 0.5).expect("half of the free motion is far").forces();
            let gains = forces.into_iter().filter(|(force, _)| force.along == Along::Velocity).map(|(_, gain)| gain);
            gains.fold(f64::NEG_INFINITY, f64::max)
        };
        let early = gained(&|trial, row| 10.0 * trial.acceleration[(row + 12).min(trial.len() - 1)]);
        let water = gained(&|trial, row| trial.velocity[row]);
        assert!(early < LEAST_GAIN.value() && water > LEAST_GAIN.value(), "{early} and {water} nats");
    }
}
