//! The quantile.

/// The value below which the share `at` of `values` lies; `None` where there are none.
#[must_use]
pub fn quantile(mut values: Vec<f64>, at: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let rank = (at * last as f64).round() as usize;
    Some(*values.select_nth_unstable_by(rank.min(last), f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn so_many_values_lie_below_it() {
        let values: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let found = [0.0, 0.25, 0.5, 1.0].map(|at| quantile(values.clone(), at));
        assert_eq!(found, [0.0, 25.0, 50.0, 100.0].map(Some));
        assert_eq!(quantile(Vec::new(), 0.5), None);
    }
}
