//! What each row is worth beside a law: its own variance, and that of what the law leaves.

use rayon::prelude::*;

use super::colour::noise_power;
use super::criteria::LEAST_COLOUR;
use super::data::Data;
use super::fit::Fit;
use super::free_motion::power_of_all;
use super::variance::{law_variance, noise_along, noise_scale};

impl Data<'_> {
    /// The same with each row worth what is expected of it under `fit`: to the force's variance come those of position, velocity and
    /// acceleration, each by how much the force changes with it (effective variance: J. Orear, *Am. J. Phys.* 50, 1982), and one variance
    /// for what the law itself leaves. Where `fit` leaves less than the sensors are said to, they leave no more than that; where their noise
    /// remembers, they leave what that comes to.
    #[must_use]
    pub fn weighed(&self, fit: &Fit) -> Self {
        let noise: Vec<Vec<f64>> = self
            .trials
            .par_iter()
            .enumerate()
            .map(|(number, trial)| noise_along(&fit.model, &fit.values, trial, number))
            .collect();
        let residual = self.residuals(&fit.model, &fit.values);
        let rows = noise.iter().flatten().zip(residual.iter().flatten()).filter(|(variance, _)| variance.is_finite());
        let rows: Vec<(f64, f64)> = rows.map(|(variance, residual)| (*variance, residual * residual)).collect();
        let coloured = noise_power(self.trials, fit, &noise, &residual);
        let scale = if coloured > LEAST_COLOUR { coloured } else { noise_scale(&rows) };
        let noise: Vec<Vec<f64>> =
            noise.iter().map(|trial| trial.iter().map(|variance| scale * variance).collect()).collect();
        let rows: Vec<(f64, f64)> =
            rows.iter().map(|(variance, square)| (scale.max(1.0) * variance, *square)).collect();
        let misfit = law_variance(&rows);
        let weight = |variance: &f64| if variance.is_finite() { (variance + misfit).sqrt().recip() } else { 0.0 };
        let weights = noise.iter().map(|trial| trial.iter().map(weight).collect());
        Self { trials: self.trials, weights: weights.collect(), noise, noise_factor: scale }
    }

    /// The same with the sensors' noise as loud as what `fit` leaves, where that is as loud in free motion.
    #[must_use]
    pub fn heard_in_free_motion(mut self, fit: &Fit) -> Self {
        let residual = self.residuals(&fit.model, &fit.values);
        let power = power_of_all(self.trials, fit, &self.noise, &residual).unwrap_or(1.0).max(1.0);
        self.noise.iter_mut().flatten().for_each(|variance| *variance *= power);
        self.noise_factor *= power;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::fit::Effort;
    use super::super::nominal::nominal_fit;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    /// Rows that are weighed by a sensor's figures, and noise of ten times their power in free motion and in contact.
    #[test]
    fn noise_that_is_as_loud_in_free_motion_is_what_the_sensors_leave() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.remembering(5.0, 3.0 * FORCE_NOISE, seed));
        let data = Data::new(&trials);
        let first = nominal_fit(&data, &TestContact::nominal());
        let fit = data.fit(&first.model, &first.values, Effort::FULL);
        let stated = data.expected_noise();
        let heard = data.heard_in_free_motion(&fit);
        // A power of ten, known to a seventeenth.
        assert!((heard.noise_factor / 10.0 - 1.0).abs() < 0.2, "{}", heard.noise_factor);
        assert!((heard.expected_noise() / stated - heard.noise_factor.sqrt()).abs() < 1e-9);
    }
}
