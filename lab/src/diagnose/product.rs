//! Products of columns.

use nalgebra::DVectorView;

/// Inner product.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    DVectorView::from_slice(a, a.len()).dot(&DVectorView::from_slice(b, b.len()))
}

/// Sum of squares.
#[must_use]
pub fn energy(values: &[f64]) -> f64 {
    dot(values, values)
}
