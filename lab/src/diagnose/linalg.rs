//! Linear algebra on columns: products and least squares.

use nalgebra::{DMatrix, DVector, DVectorView};

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

/// Least squares of `target` on `directions`; `None` where there are none.
#[must_use]
pub fn solve(directions: &[(usize, Vec<f64>)], target: &[f64]) -> Option<DVector<f64>> {
    let n = directions.len();
    if n == 0 {
        return None;
    }
    // Directions differ in size by their units: each is taken as long as one.
    let sizes: Vec<f64> = directions.iter().map(|(_, d)| dot(d, d).sqrt().max(f64::MIN_POSITIVE)).collect();
    let mut normal = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            let value = dot(&directions[i].1, &directions[j].1) / (sizes[i] * sizes[j]);
            (normal[(i, j)], normal[(j, i)]) = (value, value);
        }
    }
    let right = DVector::from_fn(n, |i, _| dot(&directions[i].1, target) / sizes[i]);
    (0..n).for_each(|i| normal[(i, i)] += 1e-9);
    normal
        .cholesky()
        .map(|factors| DVector::from_iterator(n, factors.solve(&right).iter().zip(&sizes).map(|(x, s)| x / s)))
}

/// Takes the part along `unit`, a vector of length one, off `values`.
pub fn remove(values: &mut [f64], unit: &[f64]) {
    let part = dot(values, unit);
    values.iter_mut().zip(unit).for_each(|(value, unit)| *value -= part * unit);
}
