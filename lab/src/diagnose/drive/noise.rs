//! What is random: the encoder's noise and the force that no law accounts for.

use crate::diagnose::median::median;

use std::f64::consts::TAU;

/// Densities of the random part. The disturbance is white: dv = ... + sqrt(density) / inertia dW.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// ln of the density of the force disturbance, two-sided, N^2 s or (N m)^2 s.
    pub ln_disturbance: f64,
    /// ln of the variance of an encoder row, m^2 or rad^2.
    pub ln_encoder: f64,
}

impl Noise {
    /// Density of the force disturbance, N^2 s.
    #[must_use]
    pub fn disturbance(&self) -> f64 {
        self.ln_disturbance.exp()
    }

    /// Variance of an encoder row.
    #[must_use]
    pub fn encoder(&self) -> f64 {
        self.ln_encoder.exp()
    }

    /// Frequency, Hz, up to which the disturbance exceeds what the encoder's noise amounts to as a force, inertia (2 pi f)^2 x:
    /// above it nothing can be said of a force from rows that are `period_s` apart.
    #[must_use]
    pub fn crossing_hz(&self, period_s: f64, inertia: f64) -> f64 {
        let ratio = self.disturbance() / (self.encoder() * period_s * inertia * inertia);
        ratio.sqrt().sqrt() / TAU
    }

    /// The density at which that frequency is `band_hz`.
    #[must_use]
    pub fn with_crossing(self, band_hz: f64, period_s: f64, inertia: f64) -> Self {
        let density = self.encoder() * period_s * inertia * inertia * (TAU * band_hz).powi(4);
        Self { ln_disturbance: density.ln(), ..self }
    }
}

/// Coefficients of a sixth difference.
const DIFFERENCE: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];

/// Variance of the white noise in `values`, by their sixth differences: a motion that a polynomial of the fifth degree
/// follows over seven rows leaves none. The coefficients' squares sum to 924.
#[must_use]
pub fn white_variance(values: &[f64]) -> f64 {
    let windows = values.windows(DIFFERENCE.len());
    let count = windows.len().max(1) as f64;
    windows.map(sixth_difference_squared).sum::<f64>() / (924.0 * count)
}

/// The same by the median of the squares, over that of a squared Gaussian of variance one: a few jumps of the signal do not count.
#[must_use]
pub fn robust_white_variance(values: &[f64]) -> f64 {
    median(values.windows(DIFFERENCE.len()).map(sixth_difference_squared)).unwrap_or(0.0) / (0.4549 * 924.0)
}

fn sixth_difference_squared(window: &[f64]) -> f64 {
    window.iter().zip(DIFFERENCE).map(|(x, c)| c * x).sum::<f64>().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crossing_and_its_density_are_inverse() {
        let noise = Noise { ln_disturbance: 0.0, ln_encoder: (1e-10f64).ln() }.with_crossing(17.0, 1e-3, 0.8);
        assert!((noise.crossing_hz(1e-3, 0.8) - 17.0).abs() < 1e-10);
    }

    #[test]
    fn a_fifth_degree_polynomial_has_no_noise_and_alternation_has_all_of_it() {
        let smooth: Vec<f64> = (0..60).map(|i| (0.1 * f64::from(i)).powi(5)).collect();
        assert!(white_variance(&smooth) < 1e-20);
        // +1, -1, ...: each sixth difference is the sum of the coefficients' sizes, 64.
        let alternating: Vec<f64> = (0..60).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!((white_variance(&alternating) - 64.0 * 64.0 / 924.0).abs() < 1e-12);
    }
}
