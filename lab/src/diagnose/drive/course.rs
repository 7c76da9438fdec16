//! How friction or effort changes over a trial or along the way, of no law: what warms up, wears, fades or is greased in places.

use super::curve::Curve;

/// What changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Varying {
    /// Dry friction.
    #[default]
    DryFriction,
    /// Viscous friction.
    ViscousFriction,
    /// What the drive makes of its effort.
    Effort,
}

/// What it changes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Along {
    /// Time since the trial's first row.
    #[default]
    Time,
    /// Position.
    Place,
}

/// By how much something is more, as a share of itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// What changes.
    pub of: Varying,
    /// What it changes with.
    pub along: Along,
    /// The share, straight between knots over that; no knots: none.
    pub curve: Curve,
}

impl Course {
    /// What `of` is multiplied by `time` seconds after the first row, at `position`.
    #[must_use]
    pub fn factor(&self, of: Varying, time: f64, position: f64) -> f64 {
        if of != self.of || self.curve.knots.is_empty() {
            return 1.0;
        }
        1.0 + self.curve.at(if self.along == Along::Time { time } else { position })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_changes_does_and_along_what_it_changes_with() {
        let curve = Curve { origin: 0.0, spacing: 2.0, knots: vec![0.0, 1.0] };
        let warming = Course { of: Varying::ViscousFriction, along: Along::Time, curve: curve.clone() };
        let of = [Varying::DryFriction, Varying::ViscousFriction, Varying::Effort];
        assert_eq!(of.map(|of| warming.factor(of, 1.0, 9.0)), [1.0, 1.5, 1.0]);
        let along = Course { of: Varying::Effort, along: Along::Place, curve };
        assert_eq!(of.map(|of| along.factor(of, 9.0, 0.5)), [1.0, 1.0, 1.25]);
        assert_eq!(of.map(|of| Course::default().factor(of, 1.0, 1.0)), [1.0; 3]);
    }
}
