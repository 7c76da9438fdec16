//! The median.

/// The middle one of `values`, the upper one of two; `None` where there is none.
#[must_use]
pub fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = values.collect();
    let middle = all.len() / 2;
    if all.is_empty() { None } else { Some(*all.select_nth_unstable_by(middle, f64::total_cmp).1) }
}
