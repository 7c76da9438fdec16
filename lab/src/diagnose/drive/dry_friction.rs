//! The law of dry friction by speed and load.

use super::presliding::Slips;

/// Dry friction: level + excess exp(-(v / speed)^2) + sublinear (|v| / reference)^exponent + share |borne|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DryFriction {
    /// N or N m.
    pub coulomb: f64,
    /// What creeping adds, N or N m.
    pub stribeck_excess: f64,
    /// Speed at which that is gone, m/s or rad/s.
    pub stribeck_speed: f64,
    /// Friction that grows more slowly than speed, at the reference speed, N or N m.
    pub sublinear: f64,
    /// Its power of the speed, 0 to 1.
    pub sublinear_exponent: f64,
    /// The speed at which it is `sublinear`.
    pub reference_speed: f64,
    /// Share of what is borne: the contact's force and a load that is known.
    pub load_share: f64,
    /// Way over which it builds up after a turn, m or rad; zero: at once.
    pub presliding: f64,
}

impl DryFriction {
    /// No friction.
    pub const NONE: Self = Self {
        coulomb: 0.0,
        stribeck_excess: 0.0,
        stribeck_speed: 1.0,
        sublinear: 0.0,
        sublinear_exponent: 0.5,
        reference_speed: 1.0,
        load_share: 0.0,
        presliding: 0.0,
    };

    /// Its size at `speed` (positive) while `borne` rests on what rubs; at rest it holds up to that.
    #[must_use]
    pub fn level(&self, speed: f64, borne: f64) -> f64 {
        let mut level = self.coulomb + self.load_share * borne.abs();
        if self.stribeck_excess != 0.0 {
            level += self.stribeck_excess * (-(speed / self.stribeck_speed).powi(2)).exp();
        }
        if self.sublinear != 0.0 {
            level += self.sublinear * (speed / self.reference_speed).powf(self.sublinear_exponent);
        }
        level
    }

    /// Takes what it remembers of the way along by `way`, as where a position turns out to be another.
    pub fn follow(&self, slips: &mut Slips, way: f64) {
        if self.presliding > 0.0 {
            slips.follow(way, self.presliding);
        }
    }

    /// Whether there is any.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.coulomb != 0.0 || self.stribeck_excess != 0.0 || self.sublinear != 0.0 || self.load_share != 0.0
    }
}
