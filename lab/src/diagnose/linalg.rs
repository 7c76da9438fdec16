//! Linear algebra on columns: products and least squares.

use nalgebra::{DMatrix, DVector, DVectorView};

use super::ends::ends;

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

/// Products of each of `columns` with each (J. P. Gram), symmetric.
#[must_use]
pub fn gram(columns: &[Vec<f64>]) -> DMatrix<f64> {
    let count = columns.len();
    let mut matrix = DMatrix::zeros(count, count);
    for row in 0..count {
        for column in 0..=row {
            let product = dot(&columns[row], &columns[column]);
            (matrix[(row, column)], matrix[(column, row)]) = (product, product);
        }
    }
    matrix
}

/// Stretches of `along` that a correlation ratio groups by.
const STRETCHES: usize = 20;

/// Share of the variance of `values` between stretches of `along` (the correlation ratio, eta squared: K. Pearson 1905): all of it where they
/// follow any curve over it, and stretches over rows where they are independent of it; 0 where one does not vary.
#[must_use]
pub fn correlation_ratio(along: &[f64], values: &[f64]) -> f64 {
    let [low, high] = ends(along.iter().copied());
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let mut stretches = [(0.0, 0.0); STRETCHES];
    let mut squares = 0.0;
    for (at, value) in along.iter().zip(values) {
        let part = (at - low) / (high - low).max(f64::MIN_POSITIVE);
        let (rows, sum) = &mut stretches[((part * STRETCHES as f64) as usize).min(STRETCHES - 1)];
        (*rows, *sum) = (*rows + 1.0, *sum + value - mean);
        squares += (value - mean).powi(2);
    }
    let between: f64 = stretches.iter().filter(|(rows, _)| *rows > 0.0).map(|(rows, sum)| sum * sum / rows).sum();
    // The mean of a constant is it to rounding.
    let rows = values.len() as f64;
    let rounding = rows * (f64::EPSILON * rows * mean).powi(2);
    if squares > rounding { between / squares } else { 0.0 }
}

/// Least squares of `target` on `directions`; `None` where there are none.
#[must_use]
pub fn solve(directions: &[(usize, Vec<f64>)], target: &[f64]) -> Option<DVector<f64>> {
    let n = directions.len();
    if n == 0 {
        return None;
    }
    // Directions differ in size by their units: each is taken as long as one.
    let size = |direction: &[f64]| energy(direction).sqrt();
    // One of nothing but zeros takes nothing.
    let sizes: Vec<f64> = directions.iter().map(|(_, d)| size(d)).map(|d| if d > 0.0 { d } else { 1.0 }).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_correlation_ratio_is_one_of_a_curve_and_small_of_what_goes_by_itself() {
        let along: Vec<f64> = (0..4000).map(|row| (row as f64 * 0.01).sin()).collect();
        // A parabola has no correlation with its argument. Within a twentieth of the way it varies by a hundredth of its variance.
        let curve: Vec<f64> = along.iter().map(|at| at * at).collect();
        assert!(correlation_ratio(&along, &curve) > 0.98);
        // A tone of another period: 20 stretches over 4000 rows, which are not independent.
        let tone: Vec<f64> = (0..4000).map(|row| (row as f64 * 1.618).cos()).collect();
        assert!(correlation_ratio(&along, &tone) < 0.02);
        assert_eq!(correlation_ratio(&along, &vec![0.3; 4000]), 0.0);
        assert_eq!(correlation_ratio(&[], &[]), 0.0);
    }

    #[test]
    fn a_direction_of_zeros_takes_nothing() {
        let directions = [(0, vec![1.0, 2.0, 3.0]), (1, vec![0.0; 3])];
        let found = solve(&directions, &[2.0, 4.0, 6.0]).unwrap();
        // The diagonal is a thousand-millionth too large.
        assert!((found[0] - 2.0).abs() < 4e-9 && found[1] == 0.0, "{found}");
    }

    #[test]
    fn products_of_columns_are_those_of_the_matrix() {
        let columns = [vec![1.0, 2.0, 3.0], vec![0.5, -1.0, 4.0]];
        let matrix = DMatrix::from_fn(3, 2, |row, column| columns[column][row]);
        assert_eq!(gram(&columns), matrix.transpose() * matrix);
    }
}
