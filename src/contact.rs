//! The contact model and its sign convention, stated once.
//!
//! `F = K x + B v` while the tool is in the surface, else zero. Penetration `x` is positive into the environment, its
//! rate `v` is positive while the tool moves inward, and the force `F` is positive when the tool pushes. All SI: metre,
//! metre a second, newton; or, for a rotary joint, radian, radian a second, newton metre.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// One reading of the sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Sample {
    /// Tool position along the contact normal, positive into the environment [m or rad].
    pub position: f32,
    /// Measured contact force, positive when the tool pushes [N or N m].
    pub force: f32,
    /// Time since the sample before, above zero, in seconds.
    pub elapsed: f32,
}

/// One row of the regression `F = K x + B v`, in the internal units that [`crate::Units`] sets.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observation {
    /// x: depth into the surface.
    pub penetration: f32,
    /// v: its rate.
    pub rate: f32,
    /// F: the force that the regression explains.
    pub force: f32,
}

impl Observation {
    /// The force that `estimate` predicts here, `K x + B v`.
    pub fn predicted_by(&self, estimate: Impedance) -> f32 {
        estimate.stiffness * self.penetration + estimate.damping * self.rate
    }

    /// Force minus prediction: the innovation where `estimate` is older than this row, else the residual.
    pub fn residual(&self, estimate: Impedance) -> f32 {
        self.force - self.predicted_by(estimate)
    }
}

/// What is estimated. Also any pair that has one entry for each of the two.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Impedance {
    /// K [N/m or N m/rad].
    pub stiffness: f32,
    /// B [N s/m or N m s/rad].
    pub damping: f32,
}

impl Impedance {
    /// Nothing is touched.
    pub const ZERO: Self = Self { stiffness: 0.0, damping: 0.0 };

    /// `self + factor * direction`.
    #[must_use]
    pub fn moved(self, factor: f32, direction: Self) -> Self {
        Self {
            stiffness: self.stiffness + factor * direction.stiffness,
            damping: self.damping + factor * direction.damping,
        }
    }

    /// Whether both and their sum are finite: one test instead of two.
    pub fn is_finite(self) -> bool {
        (self.stiffness + self.damping).is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_finite_where_its_sum_is() {
        let finite = |stiffness, damping| Impedance { stiffness, damping }.is_finite();
        assert!(finite(1e30, 1e30) && finite(3e38, 0.0) && finite(3e38, -3e38));
        assert!(!finite(3e38, 3e38) && !finite(f32::INFINITY, 0.0) && !finite(0.0, f32::NAN));
    }

    #[test]
    fn a_residual_is_force_less_prediction() {
        let row = Observation { penetration: 2.0, rate: -3.0, force: 7.0 };
        let estimate = Impedance { stiffness: 5.0, damping: 0.5 };
        assert_eq!((row.predicted_by(estimate), row.residual(estimate)), (8.5, -1.5));
        let direction = Impedance { stiffness: 1.0, damping: -2.0 };
        assert_eq!(estimate.moved(-2.0, direction), Impedance { stiffness: 3.0, damping: 4.5 });
    }
}
