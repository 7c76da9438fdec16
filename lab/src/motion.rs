//! The tool's motion behind encoder rows: position, velocity and acceleration with their variances.
//!
//! The motion is a third integral of white noise, x''' = w, seen by an encoder whose errors are independent from row to row, as [`EncoderReadings`] has them. The Kalman filter
//! and the fixed-interval smoother (A. E. Bryson, M. Frazier, 1963) are exact for rows at any instants. The density of w is the most likely one, so
//! that no bandwidth has to be chosen. Where a blow changes the velocity within a row, w is not white: there the velocity is free to jump
//! ([`velocity_jumps`]), so that the density of the whole trial is not that of its blows; where the motion is livelier than in the rest of the trial, its
//! density is greater ([`local_density`]).

mod criteria;
pub mod encoder_readings;
pub mod local_density;
mod rows;
mod third_integral;
pub mod velocity_jumps;

pub use criteria::ALL as THRESHOLDS;
use encoder_readings::EncoderReadings;
use rows::{Rows, rows_averaged};

/// Rows from which a motion is smoothed: three of them find where it starts, with which velocity and acceleration. Fewer stand as they are, at rest.
pub const FEWEST_ROWS: usize = 5;

/// Rounds in which the rows that are averaged and the density follow each other. The fourth changed neither by a tenth.
const SHARING_ROUNDS: usize = 3;

/// A smoothed motion, one entry a row.
#[derive(Debug, Clone, Default)]
pub struct Motion {
    /// m or rad.
    pub position: Vec<f64>,
    /// m/s or rad/s.
    pub velocity: Vec<f64>,
    /// m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
    /// Variance of the position.
    pub position_variance: Vec<f64>,
    /// Variance of the velocity.
    pub velocity_variance: Vec<f64>,
    /// Variance of the acceleration.
    pub acceleration_variance: Vec<f64>,
}

impl Motion {
    /// Of `count` rows, all at rest and known.
    fn zeros(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self {
            position: zeros(),
            velocity: zeros(),
            acceleration: zeros(),
            position_variance: zeros(),
            velocity_variance: zeros(),
            acceleration_variance: zeros(),
        }
    }

    /// That of the rows that `count` alone.
    fn only(self, count: &[bool]) -> Self {
        let only =
            |values: Vec<f64>| values.into_iter().zip(count).filter_map(|(value, is)| is.then_some(value)).collect();
        Self {
            position: only(self.position),
            velocity: only(self.velocity),
            acceleration: only(self.acceleration),
            position_variance: only(self.position_variance),
            velocity_variance: only(self.velocity_variance),
            acceleration_variance: only(self.acceleration_variance),
        }
    }
}

/// The motion behind `readings`, at the instants of the recording's rows.
#[must_use]
pub fn smoothed(readings: &EncoderReadings) -> Motion {
    let Some(mut rows) = Rows::of(readings) else {
        let motion = Motion { position: readings.position.clone(), ..Motion::zeros(readings.time.len()) };
        return motion.only(&readings.is_row);
    };
    let none = vec![0.0; readings.time.len()];
    let mut density = rows.most_likely_density(&none);
    for _ in 0..SHARING_ROUNDS {
        if readings.sharing.iter().all(|rows| *rows <= rows_averaged(density)) {
            break;
        }
        rows.averaged = rows_averaged(density);
        density = rows.most_likely_density(&none);
    }
    // Of rows with noise of their own nothing tells a noise that is louder for a while from motion.
    if readings.goes_in_steps() {
        rows.raise_where_lively(density);
    }
    let (jumps, density) = rows.jumps(density);
    rows.smooth(density, &jumps).motion.only(&readings.is_row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::Channel;
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, Normal};

    /// A sine under white noise, rows jittered by a third of their period: the errors are as large as the variances say.
    #[test]
    fn errors_of_the_motion_are_those_of_the_variances() {
        let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(3);
        let normal = Normal::new(0.0, 2e-5).unwrap();
        let jitter = Normal::new(0.0, 1e-4).unwrap();
        let mut late = || -> f64 { jitter.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|row| f64::from(row) * 1e-3 + late().clamp(-3e-4, 3e-4)).collect();
        let (size, pulse) = (5e-3, 12.0f64);
        let position: Vec<f64> =
            time.iter().map(|time| 0.3 + size * (pulse * time).sin() + normal.sample(&mut random)).collect();
        let motion = smoothed(&EncoderReadings::white(&time, &position, 4e-10));
        let (mut place, mut speed, mut change) = (0.0, 0.0, 0.0);
        for (row, time) in time.iter().enumerate().take(3900).skip(100) {
            let truth = (0.3 + size * (pulse * time).sin(), size * pulse * (pulse * time).cos());
            place += (motion.position[row] - truth.0).powi(2) / motion.position_variance[row];
            speed += (motion.velocity[row] - truth.1).powi(2) / motion.velocity_variance[row];
            let turned = -size * pulse * pulse * (pulse * time).sin();
            change += (motion.acceleration[row] - turned).powi(2) / motion.acceleration_variance[row];
            assert!(motion.position_variance[row] < 4e-10);
        }
        // A sine is smoother than what is assumed, the more so the higher the derivative, so that all come out below one; errors are alike
        // over some ten rows.
        let ratios = [place / 3800.0, speed / 3800.0, change / 3800.0];
        assert!(ratios.iter().all(|ratio| (0.1..1.6).contains(ratio)), "{ratios:?}");
    }

    /// A tool that goes slowly and stands still, read in steps of 0.1 mm without noise: its errors are as large as the variances say. Rows whose rounding were white
    /// would be known ten times better than they are.
    #[test]
    fn a_slow_motion_behind_a_coarse_encoder_is_known_as_well_as_it_says() {
        // Halves of a cosine of 300 rows between places at which it stands for 500.
        let places = [0.0, 1.13e-3, 0.42e-3, 2.71e-3, 1.87e-3, 0.09e-3, 0.96e-3, 1.55e-3, 1.5e-3];
        let at = |row: usize| {
            let part = 0.5 * (1.0 - f64::cos(std::f64::consts::PI * ((row % 800) as f64 / 300.0).min(1.0)));
            places[row / 800] + part * (places[row / 800 + 1] - places[row / 800])
        };
        let time: Vec<f64> = (0..6000).map(|row| f64::from(row) * 1e-3).collect();
        let position: Vec<f64> = (0..6000).map(|row| (at(row) / 1e-4).round() * 1e-4).collect();
        let encoder = Channel { resolution: 1e-4, noise: 1e-4 / 12f64.sqrt() };
        let weighed = |readings: &EncoderReadings| {
            let motion = smoothed(readings);
            let square = |row: usize| (motion.position[row] - at(row)).powi(2) / motion.position_variance[row];
            (100..5900).map(square).sum::<f64>() / 5800.0
        };
        let crossings = weighed(&EncoderReadings::of(&time, &position, encoder));
        let rows = weighed(&EncoderReadings::white(&time, &position, encoder.noise.powi(2)));
        assert!((0.7..1.6).contains(&crossings) && rows > 10.0, "{crossings} and {rows}");
    }
}
