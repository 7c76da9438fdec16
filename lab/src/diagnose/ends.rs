//! The least and the greatest.

/// The least and the greatest of `values`; of none, infinity and minus infinity. What is no number is not counted.
#[must_use]
pub fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_those_of_the_numbers() {
        assert_eq!(ends([2.0, -1.0, f64::NAN, 0.5].into_iter()), [-1.0, 2.0]);
        assert_eq!(ends(std::iter::empty()), [f64::INFINITY, f64::NEG_INFINITY]);
    }
}
