//! Dry friction of the drive, set-valued at rest.

use super::position_dependent_friction::StickyPatches;

/// All dry friction of the drive.
#[derive(Debug, Clone, Default)]
pub struct DryFriction {
    /// Against motion forward and backward, N.
    pub coulomb: (f64, f64),
    /// More while it is slow.
    pub stribeck: Option<StribeckCurve>,
    /// Per newton of contact force.
    pub load: f64,
    /// Places where it sticks.
    pub spots: Option<StickyPatches>,
}

/// `S exp(-(|v|/u)^n)` on top of what remains at speed.
#[derive(Debug, Clone, Copy)]
pub struct StribeckCurve {
    pub(crate) kinetic: f64,
    pub(crate) extra: f64,
    pub(crate) speed: f64,
    pub(crate) exponent: i32,
}

impl DryFriction {
    /// Friction against motion forward and backward, N, at `velocity` under contact force `load`.
    #[must_use]
    pub fn brake(&self, position: f64, velocity: f64, load: f64) -> (f64, f64) {
        let mut both = self.load * load.abs();
        if let Some(StribeckCurve { kinetic, extra, speed, exponent }) = self.stribeck {
            both += kinetic + extra * (-(velocity.abs() / speed).powi(exponent)).exp();
        }
        if let Some(spots) = &self.spots {
            both += spots.at(position);
        }
        (self.coulomb.0 + both, self.coulomb.1 + both)
    }
}
