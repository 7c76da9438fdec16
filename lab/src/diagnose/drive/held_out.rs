//! What a model leaves of rows that its values were not fitted to.

use std::ops::Range;

use super::fit::Fit;
use super::halves::{half_of, parts};
use super::levenberg_marquardt::search_values;
use super::likelihood::Data;
use super::missing_force::missing_force;
use super::noise::Noise;
use super::noise_search::search_noise;
use super::trial::DriveTrial;

/// Two halves of the recordings, which take turns with the parts of each trial: each half sees every motion. Each is fitted once and judged
/// once.
pub struct Folds {
    halves: [Vec<DriveTrial>; 2],
    /// For each half, the trial and the rows of each of its pieces.
    places: [Vec<(usize, Range<usize>)>; 2],
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
        for (number, (trial, parts)) in trials.iter().zip(parts(trials)).enumerate() {
            for part in 0..parts {
                let rows = part * trial.len() / parts..(part + 1) * trial.len() / parts;
                let half = half_of(number, part);
                folds.halves[half].push(trial.slice(rows.clone()));
                folds.places[half].push((number, rows));
            }
        }
        folds
    }

    /// Fits the values of `fit` on each half and takes what is missing on the other, smoothed with `common` noise for all models alike: along whole
    /// trials, because a piece begins without knowing what the motion before it left, as the side of a play.
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
            for (number, (trial, missing)) in data.trials.iter().zip(&mut missing).enumerate() {
                let force = missing_force(trial, &law, &fit.noise, common);
                for (_, rows) in self.places[1 - half].iter().filter(|(of, _)| *of == number) {
                    missing[rows.clone()].copy_from_slice(&force[rows.clone()]);
                }
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
    use super::super::law::Side;
    use super::super::model::Model;
    use super::super::term::Term;
    use super::*;
    use crate::diagnose::drive::testing::{SCALES, TestDrive, TestLink};

    /// `trial` with a load of 0.3 N in those of its `parts` that `loaded` names: the effort bears it.
    fn with_load(mut trial: DriveTrial, parts: usize, loaded: &dyn Fn(usize) -> bool) -> DriveTrial {
        let rows = trial.effort.len();
        for (row, effort) in trial.effort.iter_mut().enumerate() {
            *effort += if loaded(parts * row / rows) { 0.3 } else { 0.0 };
        }
        trial
    }

    /// A load that is there in one half of the parts alone: values of the other half know nothing of it.
    #[test]
    fn what_lives_in_one_half_is_not_taken_from_it_by_the_other() {
        let trial = |number: usize| TestDrive::PLAIN.trial(6.0, number as u64 + 1);
        let parts = parts(&[0, 1].map(trial))[0];
        let trials = [0, 1].map(|number| with_load(trial(number), parts, &|part| half_of(number, part) == 0));
        let data = Data { trials: &trials, least_encoder_variance: 1e-12 };
        let model = Model { terms: vec![Term::ConstantLoad], scales: SCALES };
        let noise = Noise { ln_disturbance: (1e-5f64).ln(), ln_encoder: (25e-12f64).ln() };
        let whole = fit(&data, &model, &[0.8, 4.0, 0.0, 0.0, 0.15], noise, Effort::FULL);
        let common = noise.with_crossing(15.0, 1e-3, 0.8);
        let held = Folds::of(&trials).held_out(&data, &whole, &common);
        // One half is judged by the other's value, zero, and the other by the one's, 0.3: both leave all of it. A leak leaves nothing of it,
        // the whole's value half of it.
        for column in &held.missing {
            let left = rms(std::slice::from_ref(column));
            assert!((0.27..0.33).contains(&left), "{left}");
        }
        // Its density is that of a step of 0.3 N that a filter takes up within a few of its time constants; where both halves say the
        // same, of the encoder's noise alone.
        let alike = [0, 1].map(|number| with_load(trial(number), parts, &|_| true));
        let same = Folds::of(&alike).held_out(&Data { trials: &alike, ..data }, &whole, &common);
        assert!(same.density < 0.1 * held.density, "{} {}", same.density, held.density);
    }

    /// A slow trial beside a fast one: a half that saw the slow one alone would not know the inertia.
    #[test]
    fn each_half_sees_parts_of_every_trial_and_no_row_is_in_both() {
        let trials = [TestDrive::PLAIN.trial(6.0, 1), TestDrive::PLAIN.trial(0.9, 2)];
        let folds = Folds::of(&trials);
        for (number, trial) in trials.iter().enumerate() {
            let mut seen = vec![0; trial.len()];
            for half in [0, 1] {
                let own = folds.places[half].iter().zip(&folds.halves[half]).filter(|((of, _), _)| *of == number);
                let mut rows = 0;
                for ((_, place), piece) in own {
                    assert_eq!(place.len(), piece.len());
                    seen[place.clone()].iter_mut().for_each(|times| *times += 1);
                    rows += piece.len();
                }
                assert!((rows as f64 / trial.len() as f64 - 0.5).abs() < 0.01, "half {half} of trial {number}: {rows}");
            }
            assert!(seen.iter().all(|times| *times == 1), "trial {number}");
        }
    }

    /// A play of a millimetre: where a held-out piece began without knowing on which side of it the load is, it would leave more than
    /// ten times what the whole does. Values of one half, which saw other strikes, leave two and a half times that.
    #[test]
    fn held_out_rows_of_a_play_are_followed_from_where_the_load_was() {
        let link = TestLink { stiffness: 4e4, damping: 30.0, play: 1e-3, load_share: 0.5, friction_share: 0.5 };
        let drive = TestDrive { link: Some(link), encoder: 1e-6, ..TestDrive::PLAIN };
        let trials = [drive.trial(4.0, 93), drive.trial(4.0, 94)];
        let data = Data { trials: &trials, least_encoder_variance: 3e-13 };
        let model = Model { terms: vec![Term::Play(Side::Motor)], scales: SCALES };
        let noise = Noise { ln_disturbance: (1e-7f64).ln(), ln_encoder: (1e-12f64).ln() };
        let whole = fit(&data, &model, &[0.8, 4.0, 0.0, 0.0, 4e4, 30.0, 0.5, 1e-3, 0.5], noise, Effort::FULL);
        let common = noise.with_crossing(15.0, 1e-3, 0.8);
        let held = rms(&Folds::of(&trials).held_out(&data, &whole, &common).missing);
        let own = rms(&missing_forces(&data, &whole, &common));
        assert!(held < 3.0 * own, "{held} {own}");
    }
}
