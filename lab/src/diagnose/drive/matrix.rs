//! Small square matrices on the stack.

/// N x N, by rows.
pub type Matrix<const N: usize> = [[f64; N]; N];

/// The identity.
#[must_use]
pub fn identity<const N: usize>() -> Matrix<N> {
    std::array::from_fn(|row| std::array::from_fn(|column| f64::from(row == column)))
}

/// a b
#[must_use]
pub fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let mut c = [[0.0; N]; N];
    for (row, out) in a.iter().zip(&mut c) {
        for (factor, line) in row.iter().zip(b) {
            for (sum, value) in out.iter_mut().zip(line) {
                *sum += factor * value;
            }
        }
    }
    c
}

/// a' v
#[must_use]
pub fn transposed_product<const N: usize>(a: &Matrix<N>, v: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for (row, factor) in a.iter().zip(v) {
        for (sum, value) in out.iter_mut().zip(row) {
            *sum += factor * value;
        }
    }
    out
}

/// a p a' + q for symmetric p and q; exactly symmetric.
#[must_use]
pub fn propagated<const N: usize>(a: &Matrix<N>, p: &Matrix<N>, q: &Matrix<N>) -> Matrix<N> {
    let ap = product(a, p);
    let mut c = *q;
    for row in 0..N {
        for column in 0..=row {
            let sum: f64 = ap[row].iter().zip(&a[column]).map(|(x, y)| x * y).sum();
            c[row][column] += sum;
            c[column][row] = c[row][column];
        }
    }
    c
}

/// exp(a step), by scaling and squaring of the Taylor series to the eighth order: 1e-14 of its size.
#[must_use]
pub fn exponential<const N: usize>(a: &Matrix<N>, step: f64) -> Matrix<N> {
    let size = a.iter().map(|row| row.iter().map(|x| (x * step).abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = if size > 0.0 { (size.log2().ceil() as i32 + 4).clamp(0, 60) } else { 0 };
    let scale = step / f64::from(halvings).exp2();
    let (mut term, mut sum) = (identity(), identity());
    for order in 1..=8 {
        let scaled = a.map(|row| row.map(|x| x * scale / f64::from(order)));
        term = product(&term, &scaled);
        for (out, add) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *out += add;
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_turns() {
        let turn = exponential(&[[0.0, -3.0], [3.0, 0.0]], 0.7);
        let (sine, cosine) = 2.1f64.sin_cos();
        for (found, truth) in turn.iter().flatten().zip([cosine, -sine, sine, cosine]) {
            assert!((found - truth).abs() < 1e-13);
        }
    }

    #[test]
    fn propagation_is_symmetric_and_matches_the_definition() {
        let (a, p, q) = ([[1.0, 2.0], [0.5, -1.0]], [[2.0, 0.3], [0.3, 1.0]], [[0.1, 0.0], [0.0, 0.2]]);
        let c = propagated(&a, &p, &q);
        // By hand: a p = [[2.6, 2.3], [0.7, -0.85]].
        assert!((c[0][0] - (2.6 + 4.6 + 0.1)).abs() < 1e-14);
        assert!((c[0][1] - (1.3 - 2.3)).abs() < 1e-14 && c[0][1] == c[1][0]);
        assert!((c[1][1] - (0.35 + 0.85 + 0.2)).abs() < 1e-14);
    }
}
