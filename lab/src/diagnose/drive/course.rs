//! How friction or effort changes over a trial, along the way or with the velocity, of no law: what warms up, wears, fades, is greased in places or
//! brakes one way.

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
    /// Velocity with its sign; at rest it has two values, one for each way, as of a damper that brakes one way.
    Velocity,
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
    /// What `of` is multiplied by `time` seconds after the first row, at this position and velocity.
    #[must_use]
    pub fn factor(&self, of: Varying, time: f64, [position, velocity]: [f64; 2]) -> f64 {
        if of != self.of || self.curve.knots.is_empty() {
            return 1.0;
        }
        1.0 + self.curve.at(match self.along {
            Along::Time => time,
            Along::Place => position,
            // The knots of both ways lie one after the other.
            Along::Velocity if velocity >= 0.0 => velocity + self.curve.spacing,
            Along::Velocity => velocity,
        })
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
        assert_eq!(of.map(|of| warming.factor(of, 1.0, [9.0, 5.0])), [1.0, 1.5, 1.0]);
        let along = Course { of: Varying::Effort, along: Along::Place, curve: curve.clone() };
        assert_eq!(of.map(|of| along.factor(of, 9.0, [0.5, 7.0])), [1.0, 1.0, 1.25]);
        let both_ways = Curve { origin: -2.0, spacing: 2.0, knots: vec![3.0, 1.0, 0.0, 0.5] };
        let braking = Course { of: Varying::ViscousFriction, along: Along::Velocity, curve: both_ways };
        let of_velocity = |v: f64| braking.factor(Varying::ViscousFriction, 9.0, [7.0, v]);
        assert_eq!([-2.0, -1.0, 0.0, 1.0, 3.0].map(of_velocity), [4.0, 3.0, 1.0, 1.25, 1.5]);
        assert_eq!(of.map(|of| Course::default().factor(of, 1.0, [1.0; 2])), [1.0; 3]);
    }
}
