//! What one law of the contact is worth beside another: likelihood, share and price of its values.

use super::criteria::{
    FAR_FROM_NOISE, FAR_LEAST_PART_OF_ALL, FAR_LEAST_SHARE, LEAST_GAIN, LEAST_PART_OF_ALL, LEAST_PART_OF_FORCE,
    LEAST_SHARE, LEAST_TOLD_SHARE, LEAST_VUONG, NOISE_POWER_KNOWN_TO, NOTABLE_POWER, TOLD_SHARE, VUONG_BLOCK_TIMES,
};
use super::data::Data;
use super::fit::Fit;
use super::rest::Rest;
use super::search::Search;
use crate::diagnose::evidence::share_beyond_noise;
use crate::diagnose::model_comparison::{block_gains, vuong};

/// What a larger model has over a smaller one.
#[derive(Debug, Clone, Copy)]
pub struct Worth {
    /// Log likelihood, nats, rows that belong together counted once.
    pub gain: f64,
    /// Share of what the smaller leaves above the sensors' noise.
    pub share: f64,
    /// What it takes, in root mean square, over all that the nominal law leaves above the noise.
    pub part_of_all: f64,
    /// The same over the force's deviation.
    pub part_of_force: f64,
    /// Vuong's statistic over blocks.
    pub vuong: f64,
    /// Power that the larger leaves over the sensors' own.
    pub left: f64,
    /// The same of the smaller, or where that is more of those rows alone in which the two differ.
    pub left_before: f64,
    /// What a value more has to gain, nats.
    pub price: f64,
}

/// Blocks that likelihoods are compared over: as many independent rows tell the power of a part of them to a quarter.
const BLOCKS: usize = 40;

impl Search<'_> {
    /// What `more` has over `less`.
    #[must_use]
    pub fn worth(&self, more: &Fit, less: &Fit) -> Worth {
        let (rest, before) = (Rest::of(&self.data, more), Rest::of(&self.data, less));
        let taken = less.energy - more.energy;
        let above = |energy: f64| (energy - self.data.expected()).max(0.0);
        let scale = 0.5 / (rest.power * rest.correlated_rows);
        let logs = |rows: &[f64]| -> Vec<f64> { rows.iter().map(|row| -scale * row * row).collect() };
        let block = (self.data.rows() / BLOCKS).max((VUONG_BLOCK_TIMES * rest.correlated_rows).value() as usize).max(4);
        Worth {
            gain: scale * taken,
            share: taken.max(0.0) / above(less.energy).max(taken.max(f64::MIN_POSITIVE)),
            part_of_all: (taken.max(0.0) / above(self.nominal.energy).max(taken.max(f64::MIN_POSITIVE))).sqrt(),
            part_of_force: self.part_of_force(taken),
            vuong: vuong(&block_gains(&logs(&rest.rows), &logs(&before.rows), block)),
            left: rest.over_sensors,
            left_before: before.over_sensors.max(left_where_they_differ(
                &before.rows,
                &rest.rows,
                rest.correlated_rows,
            )),
            price: self.price_of_value(&rest),
        }
    }

    /// What squares of a weighted residual are, in root mean square, of the force's deviation.
    #[must_use]
    pub fn part_of_force(&self, energy: f64) -> f64 {
        (energy.max(0.0) / self.force_energy()).sqrt()
    }

    /// Squares of the force about its mean, each over its deviation.
    fn force_energy(&self) -> f64 {
        let rows = || {
            self.data.trials.iter().zip(&self.data.weights).flat_map(|(trial, weights)| trial.force.iter().zip(weights))
        };
        let weight: f64 = rows().map(|(_, weight)| weight * weight).sum();
        let mean = rows().map(|(force, weight)| force * weight * weight).sum::<f64>() / weight.max(f64::MIN_POSITIVE);
        rows().map(|(force, weight)| ((force - mean) * weight).powi(2)).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// Whether `more` is worth its values.
    #[must_use]
    pub fn is_worth(&self, more: &Fit, less: &Fit) -> bool {
        if let Some(is_line) = self.is_worth_as_a_line(more, less) {
            return is_line;
        }
        let values = free(more).saturating_sub(free(less)).max(1);
        let worth = self.worth(more, less);
        // Far from the sensors' noise any bend of a law takes a little of what another one leaves.
        let [share, part] = if worth.left > FAR_FROM_NOISE {
            [FAR_LEAST_SHARE, FAR_LEAST_PART_OF_ALL]
        } else {
            [LEAST_SHARE, LEAST_PART_OF_ALL]
        };
        worth.gain > LEAST_GAIN + worth.price * values as f64
            && worth.share > share
            && worth.part_of_all > part
            && worth.part_of_force > LEAST_PART_OF_FORCE
            && are_told_apart(&worth)
    }

    /// What a value more has to gain, nats: half the logarithm of the rows that tell more than one (G. Schwarz, Ann. Stat. 6 (1978) 461).
    pub(super) fn price_of_value(&self, rest: &Rest) -> f64 {
        0.5 * (self.data.rows() as f64 / rest.correlated_rows).max(1.0).ln()
    }

    /// Whether `fit` is no answer beside `other`, which leaves nothing notable of `data` and takes so much of what `fit` leaves there beyond the
    /// sensors' noise that it stands for it. Where something notable is left, what leaves more may hold a part that the other lacks.
    pub(super) fn is_no_answer(&self, data: &Data<'_>, fit: &Fit, other: &Fit) -> bool {
        let taken = share_beyond_noise(fit.energy, other.energy, data.expected(), NOISE_POWER_KNOWN_TO.value());
        other.energy < NOTABLE_POWER * data.expected()
            && taken > TOLD_SHARE
            && !self.is_one_law(&fit.model, &other.model)
    }

    /// Squares that are left, in nats under `rest`, with what each value has to earn.
    pub(super) fn price(&self, fit: &Fit, rest: &Rest) -> f64 {
        0.5 / (rest.power * rest.correlated_rows) * fit.energy + self.price_of_value(rest) * free(fit) as f64
    }
}

/// Mean square of `less`, what the smaller of two laws leaves, where the larger, which leaves `more`, differs from it ([`where_they_differ`]): a reading that is
/// clipped for a hundredth of the time leaves little on the whole. Zero where they hardly differ.
fn left_where_they_differ(less: &[f64], more: &[f64], correlated_rows: f64) -> f64 {
    let Some(rows) = where_they_differ(less, more, correlated_rows) else { return 0.0 };
    rows.iter().map(|row| less[*row] * less[*row]).sum::<f64>() / rows.len() as f64
}

/// The rows in which what two laws leave differs by more than a deviation of the sensors, in these; `None` where they tell no more than [`BLOCKS`] independent ones,
/// of which `correlated_rows` tell as much as one.
pub(super) fn where_they_differ(less: &[f64], more: &[f64], correlated_rows: f64) -> Option<Vec<usize>> {
    let rows: Vec<usize> = (0..less.len()).filter(|row| (less[*row] - more[*row]).abs() > 1.0).collect();
    (!rows.is_empty() && rows.len() as f64 >= BLOCKS as f64 * correlated_rows).then_some(rows)
}

/// Whether the recordings tell two laws apart: block by block, or, where few blocks speak, because the one leaves next to nothing of what the
/// other leaves far above the noise.
pub(super) fn are_told_apart(worth: &Worth) -> bool {
    worth.vuong > LEAST_VUONG || (worth.share > LEAST_TOLD_SHARE && worth.left_before > FAR_FROM_NOISE)
}

/// Values that are fitted.
pub(super) fn free(fit: &Fit) -> usize {
    fit.model.free_count()
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::fit::Effort;
    use super::super::identification::identify;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;
    use crate::diagnose::term::Term;

    /// A stretch of a hundredth in which one law is wrong by four deviations, on noise of one: on the whole it leaves 1.16 of the noise, there 17.
    #[test]
    fn a_law_that_is_wrong_for_a_hundredth_of_the_time_is_far_from_the_noise_there() {
        let right: Vec<f64> = (0..5000).map(|row| if row % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let wrong_for = |rows: usize, by: f64| -> Vec<f64> {
            right.iter().enumerate().map(|(at, row)| if at < rows { row + by } else { *row }).collect()
        };
        assert!((left_where_they_differ(&wrong_for(50, 4.0), &right, 1.0) - 17.0).abs() < 1e-12);
        // So few rows, or so little, are none; nor are as many that say the same.
        assert_eq!(left_where_they_differ(&wrong_for(30, 4.0), &right, 1.0), 0.0);
        assert_eq!(left_where_they_differ(&wrong_for(5000, 0.9), &right, 1.0), 0.0);
        assert_eq!(left_where_they_differ(&wrong_for(50, 4.0), &right, 2.0), 0.0);
    }

    #[test]
    fn what_is_significant_and_of_no_size_is_not_named() {
        let contact = TestContact { zero: 2.6e-3, ..TestContact::PLAIN };
        let trials = [1, 2].map(|seed| contact.trial(seed));
        let data = Data::new(&trials);
        let nominal = nominal_fit(&data, &TestContact::nominal());
        let bias = Term { effect: crate::effects::find("force_bias").unwrap(), form: 0 };
        let start: Vec<f64> = nominal.values.iter().copied().chain([1e-3]).collect();
        let more = data.fit(&nominal.model.with(bias), &start, Effort::FULL);
        let search = Search {
            coarse: Data::new(&trials),
            nominal: nominal.clone(),
            data,
            circumstances: Circumstances::default(),
        };
        let worth = search.worth(&more, &nominal);
        assert!(worth.gain > LEAST_GAIN + worth.price, "{} nats", worth.gain);
        assert!(!search.is_worth(&more, &nominal), "{} of the force", worth.part_of_force);
        let outcome = identify(trials.to_vec(), &trials, &TestContact::nominal(), Circumstances::default(), &|_| {});
        let outcome = outcome.unwrap();
        assert_eq!(outcome.chosen.model.names(outcome.known_terms), Vec::<&str>::new());
    }
}
