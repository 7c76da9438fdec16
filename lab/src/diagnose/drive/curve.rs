//! Any quantity along another one, of no law.

/// A quantity by another one, straight between knots and constant beyond them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Where the first knot is.
    pub origin: f64,
    /// Distance of two knots.
    pub spacing: f64,
    /// The quantity at each knot; none: zero everywhere.
    pub knots: Vec<f64>,
}

impl Curve {
    /// The quantity at `position`.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        let (Some(first), Some(last)) = (self.knots.first(), self.knots.last()) else { return 0.0 };
        let along = (position - self.origin) / self.spacing;
        if along <= 0.0 {
            return *first;
        }
        let knot = along as usize;
        if knot + 1 >= self.knots.len() {
            return *last;
        }
        let part = along - knot as f64;
        self.knots[knot] * (1.0 - part) + self.knots[knot + 1] * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_straight_between_knots_and_constant_beyond() {
        let curve = Curve { origin: 1.0, spacing: 0.5, knots: vec![2.0, 4.0, 3.0] };
        assert_eq!([0.0, 1.25, 1.5, 1.75, 9.0].map(|x| curve.at(x)), [2.0, 3.0, 4.0, 3.5, 3.0]);
    }
}
