//! Contact laws beyond `F = K x + B v` that are linear in what is not known of them.

use crate::error::{ConfigError, require};
use crate::front_end::units::Units;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Most parameters of a contact law.
pub const MAX_PARAMETERS: usize = 3;

/// Which columns a row of the regression has. x: penetration, v: its rate, a: the tool's acceleration, F: measured force.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum ContactModel {
    /// `F = K x + B v`: K (N/m), B (N s/m).
    KelvinVoigt,
    /// `F = K x^n + B x^n v` at a given n (K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440): K (N/m^n),
    /// B (N s/m^(n+1)). 1.5 for a sphere on an elastic half space, 1 for a flat punch.
    HuntCrossley {
        /// n, 0.5 to 3.
        exponent: f32,
    },
    /// `F = K x + B v + alpha x v`: damping that grows with depth from B at the surface; alpha (N s/m^2).
    GrowingDamping,
    /// `F = K x + B v + c`: a force sensor whose zero is off by c (N), or a surface that lies deeper than it was said, by
    /// `-c / K` ([`contact_plane`]). In contact the two cannot be distinguished.
    BiasedKelvinVoigt,
    /// `F = K x + B v + m a`: the mass m (kg) beyond the force sensor.
    ToolMass,
}

impl ContactModel {
    /// How many parameters it has.
    pub const fn parameters(self) -> usize {
        match self {
            Self::KelvinVoigt | Self::HuntCrossley { .. } => 2,
            Self::GrowingDamping | Self::BiasedKelvinVoigt | Self::ToolMass => 3,
        }
    }

    /// The name in words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::KelvinVoigt => "kelvin_voigt",
            Self::HuntCrossley { .. } => "hunt_crossley",
            Self::GrowingDamping => "growing_damping",
            Self::BiasedKelvinVoigt => "biased_kelvin_voigt",
            Self::ToolMass => "tool_mass",
        }
    }

    pub(crate) fn check(self) -> Result<Self, ConfigError> {
        if let Self::HuntCrossley { exponent } = self {
            require((0.5..=3.0).contains(&exponent), "exponent", "0.5 to 3")?;
        }
        Ok(self)
    }

    /// One internal unit of each parameter, in SI; 1 for those that it has not.
    pub fn units(self, units: Units) -> [f32; MAX_PARAMETERS] {
        let (k, b) = (units.force / units.penetration, units.force / units.rate);
        match self {
            Self::KelvinVoigt => [k, b, 1.0],
            Self::HuntCrossley { exponent } => {
                let power = libm::powf(units.penetration, exponent);
                [units.force / power, units.force / (power * units.rate), 1.0]
            }
            Self::GrowingDamping => [k, b, units.force / (units.penetration * units.rate)],
            Self::BiasedKelvinVoigt => [k, b, units.force],
            Self::ToolMass => [k, b, units.force / units.rate],
        }
    }

    /// The columns between two depths that are `elapsed` seconds apart, not yet filtered. `way` is what a depth gained in a
    /// second makes of the rate in internal units. Products of depth and rate are differences of powers of the depth, so that the
    /// mean over the interval is exact.
    pub(crate) fn columns(self, before: f32, now: f32, elapsed: f32, to_rate: f32) -> [f32; MAX_PARAMETERS] {
        let slope = |from: f32, to: f32| (to - from) / elapsed * to_rate;
        let (x, v) = (0.5 * (before + now), slope(before, now));
        match self {
            Self::KelvinVoigt | Self::ToolMass => [x, v, 0.0],
            Self::HuntCrossley { exponent } => {
                let powers = [libm::powf(before, exponent), libm::powf(now, exponent)];
                let [first, last] = powers;
                let over = 1.0 / (exponent + 1.0);
                [0.5 * (first + last), slope(first * before * over, last * now * over), 0.0]
            }
            Self::GrowingDamping => [x, v, slope(0.5 * before * before, 0.5 * now * now)],
            Self::BiasedKelvinVoigt => [x, v, 1.0],
        }
    }
}

/// Where the surface lies, counted from where it was said to lie, positive into the environment: `-c / K` of the parameters of
/// [`ContactModel::BiasedKelvinVoigt`]. Not finite where K is zero.
pub fn contact_plane(parameters: [f32; MAX_PARAMETERS]) -> f32 {
    let [stiffness, _, constant] = parameters;
    -constant / stiffness
}
