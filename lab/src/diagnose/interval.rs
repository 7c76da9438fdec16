//! How far a value can be trusted: by what twins of the answer make of it.

use super::fit;
use super::fold::HeldOut;
use super::stand::Stand;

/// A value without the bias that twins show, and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Ends of the interval.
    pub ends: [f64; 2],
}

/// Of every value of `stand`'s model.
///
/// A twin is made from known values; what the fit makes of it, less those, is the error of the method: its mean is a bias,
/// which is taken off, its spread the interval. What the recording shows beyond the twins' residual widens the interval, and so does what its two halves disagree about.
#[must_use]
pub fn estimates(stand: &Stand, held: &HeldOut) -> Vec<Estimate> {
    let axes = fit::axes(&stand.model, &stand.values, &stand.scene);
    let count = stand.twins.len().max(2) as f64;
    let wider = stand.power_ratio().max(1.0).sqrt();
    (0..stand.values.len())
        .map(|at| {
            let mean = stand.twins.iter().map(|view| view.shift[at]).sum::<f64>() / count;
            let variance = stand.twins.iter().map(|view| (view.shift[at] - mean).powi(2)).sum::<f64>() / (count - 1.0);
            let noise = student(count - 1.0) * wider * (variance * (1.0 + 1.0 / count)).sqrt();
            // Two halves of the data that differ by more than noise say how far the law itself can be trusted: half their
            // difference is the deviation of their mean.
            let apart = match held.taught.as_slice() {
                [first, second] => Z * 0.5 * (first[at] - second[at]).abs(),
                _ => 0.0,
            };
            let half = noise.hypot(apart);
            let (low, high) = (axes[at].low, axes[at].high);
            let value = (stand.origin[at] - mean).clamp(low, high);
            Estimate { value, ends: [(value - half).max(low), (value + half).min(high)] }
        })
        .collect()
}

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_964;

/// The 97.5 % point of Student's t with `freedom` degrees, to a part in a thousand from 8 on (Abramowitz and Stegun 26.7.5).
fn student(freedom: f64) -> f64 {
    Z + (Z.powi(3) + Z) / (4.0 * freedom) + (5.0 * Z.powi(5) + 16.0 * Z.powi(3) + 3.0 * Z) / (96.0 * freedom * freedom)
}
