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
        // By its value, not by the number of a knot: a law that is tried can throw the position beyond any number.
        if along >= (self.knots.len() - 1) as f64 {
            return *last;
        }
        let knot = along as usize;
        let Some(next) = self.knots.get(knot + 1) else { return *last };
        let part = along - knot as f64;
        self.knots[knot] * (1.0 - part) + next * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_straight_between_knots_and_constant_beyond() {
        let curve = Curve { origin: 1.0, spacing: 0.5, knots: vec![2.0, 4.0, 3.0] };
        assert_eq!([0.0, 1.25, 1.5, 1.75, 2.0, 9.0].map(|x| curve.at(x)), [2.0, 3.0, 4.0, 3.5, 3.0, 3.0]);
        assert_eq!([f64::NEG_INFINITY, -1e300, 1e300, f64::INFINITY].map(|x| curve.at(x)), [2.0, 2.0, 3.0, 3.0]);
        assert!(curve.at(f64::NAN).is_nan());
    }
}
