//! Innovations of a trial.

use std::sync::Arc;

/// What the filter makes of a trial, row by row.
#[derive(Debug, Clone, Default)]
pub struct Innovations {
    /// Encoder row less its prediction, m or rad; zero where a stretch starts.
    pub innovation: Vec<f64>,
    /// Variance of it; of one body that of its gains, which laws share.
    pub variance: Arc<Vec<f64>>,
    /// Smoothed force that the law lacks, mean over the interval that ends at the row, N or N m. Empty unless asked for.
    pub disturbance: Vec<f64>,
    /// Encoder row less its smoothed position, m or rad; zero where a stretch starts. Of two bodies, where the disturbance was asked for.
    pub residual: Vec<f64>,
    /// By how much the motor is ahead of the load, smoothed, m or rad. Of two bodies, where the disturbance was asked for.
    pub stretch: Vec<f64>,
}
