//! What a model leaves of rows that its values were not fitted to.

use super::fit::Fit;
use super::levenberg_marquardt::search_values;
use super::likelihood::Data;
use super::missing_force::missing_force;
use super::noise::Noise;
use super::noise_search::search_noise;
use super::trial::DriveTrial;

/// Two halves of the recordings: every other trial, or the halves of a single one. Each is fitted once and judged once.
pub struct Folds {
    halves: [Vec<DriveTrial>; 2],
    /// For each half, the trial and the first row of each of its pieces.
    places: [Vec<(usize, usize)>; 2],
}

/// Missing force under the values of the other half, a column a trial.
pub struct HeldOut {
    /// N or N m, row by row.
    pub missing: Vec<Vec<f64>>,
    /// Density of the force disturbance that each half's values leave of the other half, the most likely one there, in the mean over all
    /// rows, N^2 s or (N m)^2 s.
    pub density: f64,
}

/// Steps of the search on a half, from the values of the whole.
const STEPS: usize = 5;

impl Folds {
    /// The halves of `trials`.
    #[must_use]
    pub fn of(trials: &[DriveTrial]) -> Self {
        let mut folds = Self { halves: [Vec::new(), Vec::new()], places: [Vec::new(), Vec::new()] };
        let mut put = |half: usize, trial: usize, rows: std::ops::Range<usize>| {
            folds.places[half].push((trial, rows.start));
            folds.halves[half].push(trials[trial].slice(rows));
        };
        match trials {
            [single] => {
                let middle = single.len() / 2;
                put(0, 0, 0..middle);
                put(1, 0, middle..single.len());
            }
            all => all.iter().enumerate().for_each(|(at, trial)| put(at % 2, at, 0..trial.len())),
        }
        folds
    }

    /// Fits the values of `fit` on each half and takes what is missing on the other, smoothed with `common` noise for all models alike.
    #[must_use]
    pub fn held_out(&self, data: &Data<'_>, fit: &Fit, common: &Noise) -> HeldOut {
        let mut missing: Vec<Vec<f64>> = data.trials.iter().map(|trial| vec![0.0; trial.len()]).collect();
        let (mut density, mut rows) = (0.0, 0);
        for half in [0, 1] {
            let own = Data { trials: &self.halves[half], ..*data };
            let unseen = Data { trials: &self.halves[1 - half], ..*data };
            let mut values = fit.values.clone();
            search_values(&own, &fit.model, &mut values, &fit.noise, STEPS);
            let mut noise = fit.noise;
            search_noise(&unseen, &fit.model, &values, &mut noise);
            let own_rows = unseen.trials.iter().map(DriveTrial::len).sum::<usize>();
            density += unseen.unexplained_density(&fit.model, &noise) * own_rows as f64;
            rows += own_rows;
            let law = fit.model.law(&values);
            for (piece, (trial, start)) in self.halves[1 - half].iter().zip(&self.places[1 - half]) {
                let force = missing_force(piece, &law, &fit.noise, common);
                missing[*trial][*start..*start + force.len()].copy_from_slice(&force);
            }
        }
        HeldOut { missing, density: density / rows.max(1) as f64 }
    }
}

/// What fixed values leave, a column a trial.
#[must_use]
pub fn missing_forces(data: &Data<'_>, fit: &Fit, common: &Noise) -> Vec<Vec<f64>> {
    let law = fit.model.law(&fit.values);
    data.trials.iter().map(|trial| missing_force(trial, &law, &fit.noise, common)).collect()
}

/// Root mean square over all trials.
#[must_use]
pub fn rms(columns: &[Vec<f64>]) -> f64 {
    let rows: usize = columns.iter().map(Vec::len).sum();
    (columns.iter().flatten().map(|value| value * value).sum::<f64>() / rows.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::fit::{Effort, fit};
    use super::super::model::Model;
    use super::super::term::Term;
    use super::*;
    use crate::diagnose::drive::testing::{SCALES, TestDrive};

    /// A load that is there in the first of two trials alone: values of the other half know nothing of it.
    #[test]
    fn what_lives_in_one_half_is_not_taken_from_it_by_the_other() {
        let trials = [TestDrive { load: 0.3, ..TestDrive::PLAIN }.trial(3.0, 1), TestDrive::PLAIN.trial(3.0, 2)];
        let data = Data { trials: &trials, least_encoder_variance: 1e-12 };
        let model = Model { terms: vec![Term::ConstantLoad], scales: SCALES };
        let noise = Noise { ln_disturbance: (1e-5f64).ln(), ln_encoder: (25e-12f64).ln() };
        let whole = fit(&data, &model, &[0.8, 4.0, 0.0, 0.15], noise, Effort::FULL);
        let common = noise.with_crossing(15.0, 1e-3, 0.8);
        let held = Folds::of(&trials).held_out(&data, &whole, &common);
        // The first half is judged by the second's value, zero, and the second by the first's, 0.3: both leave all of it. A leak
        // leaves nothing of it, the whole's value half of it.
        for column in &held.missing {
            let left = rms(std::slice::from_ref(column));
            assert!((0.27..0.33).contains(&left), "{left}");
        }
        // Its density is that of a step of 0.3 N that a filter takes up within a few of its time constants; where both halves say the
        // same, of the encoder's noise alone.
        let alike = [
            TestDrive { load: 0.3, ..TestDrive::PLAIN }.trial(3.0, 1),
            TestDrive { load: 0.3, ..TestDrive::PLAIN }.trial(3.0, 2),
        ];
        let same = Folds::of(&alike).held_out(&Data { trials: &alike, ..data }, &whole, &common);
        assert!(same.density < 0.1 * held.density, "{} {}", same.density, held.density);
    }
}
