//! What adapts by itself, in double precision: another form of the cumulative sum, least squares with any prior and any number of
//! columns, directional forgetting by its covariance.

use super::{RegressionRow, Theta};
use nalgebra::{DMatrix, DVector, Matrix2};

/// Page's sum as the rise of a random walk above its least value so far, which needs no maximum with zero.
#[derive(Debug, Clone, Default)]
pub struct Cusum {
    walk: f64,
    least: f64,
    mean_square: f64,
    since: u32,
}

impl Cusum {
    /// Whether the innovation of one sample makes a change, and how far the rise is from the threshold, as a share of it.
    pub fn update(&mut self, config: &palpate::ChangeConfig, innovation: f64) -> (bool, f64) {
        if self.since < u32::from(config.settling) {
            self.since += 1;
            return (false, 1.0);
        }
        let usual = self.mean_square.max(f64::from(config.noise).powi(2));
        let counted = innovation.powi(2).min(f64::from(config.clip) * usual);
        let weight = 1.0 / f64::from(config.memory);
        self.mean_square = (1.0 - weight) * self.mean_square + weight * counted;
        self.walk += counted / usual - f64::from(config.allowance);
        self.least = self.least.min(self.walk);
        let rise = self.walk - self.least;
        let threshold = f64::from(config.threshold);
        if rise > threshold {
            *self = Self { mean_square: self.mean_square, ..Self::default() };
        }
        (rise > threshold, (rise / threshold - 1.0).abs())
    }
}

/// The minimiser of `sum lambda^(n-i) (F_i - phi_i'theta)^2 + lambda^n sum_j ridge_j (theta_j - at_j)^2`, by singular values.
pub fn ridged(rows: &[(Vec<f64>, f64)], lambda: f64, at: &[f64], ridge: &[f64]) -> DVector<f64> {
    let (count, width) = (rows.len(), at.len());
    let weight = |age: usize| lambda.powf(0.5 * age as f64);
    let scale: Vec<f64> =
        (0..width).map(|j| rows.iter().map(|(phi, _)| phi[j].powi(2)).sum::<f64>().max(ridge[j]).sqrt()).collect();
    let matrix = DMatrix::from_fn(count + width, width, |i, j| match i.checked_sub(count) {
        None => rows[i].0[j] * weight(count - 1 - i) / scale[j],
        Some(own) if own == j => ridge[j].sqrt() * weight(count) / scale[j],
        Some(_) => 0.0,
    });
    let right = DVector::from_fn(count + width, |i, _| match i.checked_sub(count) {
        None => rows[i].1 * weight(count - 1 - i),
        Some(own) => ridge[own].sqrt() * weight(count) * at[own],
    });
    let solution = matrix.svd(true, true).solve(&right, 0.0).expect("a solution");
    DVector::from_fn(width, |j, _| solution[j] / scale[j])
}

/// Rows of two columns.
pub fn columns(rows: &[RegressionRow]) -> Vec<(Vec<f64>, f64)> {
    rows.iter().map(|row| (vec![row.x, row.v], row.force)).collect()
}

/// Directional forgetting by the covariance: what is forgotten along `phi` is added to it, `(1 - lambda) / (lambda phi'R phi) phi phi'`.
#[derive(Debug, Clone)]
pub struct Directional {
    pub estimate: Theta,
    covariance: Matrix2<f64>,
    lambda: f64,
}

impl Directional {
    pub fn new(lambda: f64, variances: Theta) -> Self {
        Self { estimate: Theta::zeros(), covariance: Matrix2::from_diagonal(&variances), lambda }
    }

    pub fn update(&mut self, row: RegressionRow) {
        let phi = row.regressor();
        let known = phi.dot(&self.covariance.lu().solve(&phi).expect("a covariance"));
        if known > 0.0 {
            self.covariance += phi * phi.transpose() * ((1.0 - self.lambda) / (self.lambda * known));
        }
        let gain = self.covariance * phi / (1.0 + phi.dot(&(self.covariance * phi)));
        self.estimate += gain * row.residual(self.estimate);
        self.covariance -= gain * (phi.transpose() * self.covariance);
        self.covariance = 0.5 * (self.covariance + self.covariance.transpose());
    }
}
