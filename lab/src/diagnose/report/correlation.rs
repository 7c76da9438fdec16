//! Correlations of the values that a report shows, from the covariance of those that were fitted.

use super::diagnosis::Correlations;

/// Step of a derivative, in deviations of the value.
const STEP: f64 = 1e-3;

/// Names and values that a report shows, of fitted values.
pub(super) type Shown<'a> = &'a dyn Fn(&[f64]) -> Vec<(String, f64)>;

/// Correlations of what `shown` makes of the fitted `values`, to first order: J C J' with C their `covariance`. Values that were not
/// fitted are left out; `None` where fewer than two are left, or the covariance is not known.
pub(super) fn correlations(
    channel: &'static str,
    values: &[f64],
    covariance: &[Vec<f64>],
    shown: Shown<'_>,
) -> Option<Correlations> {
    if covariance.len() != values.len() {
        return None;
    }
    let names: Vec<String> = shown(values).into_iter().map(|(name, _)| name).collect();
    // Derivatives of what is shown, by one deviation of each fitted value.
    let derivative = |at: usize| -> Vec<f64> {
        let deviation = covariance[at][at].sqrt();
        if !(deviation > 0.0 && deviation.is_finite()) {
            return vec![0.0; names.len()];
        }
        let moved = |steps: f64| {
            let mut moved = values.to_vec();
            moved[at] += steps * STEP * deviation;
            shown(&moved)
        };
        moved(1.0).iter().zip(moved(-1.0)).map(|((_, up), (_, down))| (up - down) / (2.0 * STEP)).collect()
    };
    let jacobian: Vec<Vec<f64>> = (0..values.len()).map(derivative).collect();
    let scaled = |i: usize, j: usize| {
        let size = (covariance[i][i] * covariance[j][j]).sqrt();
        if size > 0.0 && size.is_finite() { covariance[i][j] / size } else { 0.0 }
    };
    let product = |a: usize, b: usize| -> f64 {
        let each = (0..values.len()).flat_map(|i| (0..values.len()).map(move |j| (i, j)));
        each.map(|(i, j)| jacobian[i][a] * scaled(i, j) * jacobian[j][b]).sum()
    };
    let fitted: Vec<usize> =
        (0..names.len()).filter(|at| product(*at, *at) > 0.0 && product(*at, *at).is_finite()).collect();
    if fitted.len() < 2 {
        return None;
    }
    let correlation = |a: &usize, b: &usize| {
        if a == b { 1.0 } else { (product(*a, *b) / (product(*a, *a) * product(*b, *b)).sqrt()).clamp(-1.0, 1.0) }
    };
    Some(Correlations {
        channel,
        parameters: fitted.iter().map(|at| names[*at].clone()).collect(),
        matrix: fitted.iter().map(|a| fitted.iter().map(|b| correlation(a, b)).collect()).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reciprocal_turns_the_sign_and_a_value_that_was_not_fitted_is_left_out() {
        let covariance = vec![vec![4.0, 0.9, 0.0], vec![0.9, 0.25, 0.0], vec![0.0, 0.0, 0.0]];
        let shown = |values: &[f64]| {
            vec![("mass".to_owned(), values[0]), ("pitch".to_owned(), 1.0 / values[1]), ("fixed".to_owned(), values[2])]
        };
        let found = correlations("effort", &[100.0, 50.0, 1.0], &covariance, &shown).expect("two values");
        assert_eq!(found.parameters, ["mass", "pitch"]);
        assert!((found.matrix[0][1] + 0.9).abs() < 1e-4 && (found.matrix[1][0] + 0.9).abs() < 1e-4, "{found:?}");
        assert_eq!([found.matrix[0][0], found.matrix[1][1]], [1.0, 1.0]);
        assert!(correlations("effort", &[1.0], &[], &shown).is_none());
    }
}
