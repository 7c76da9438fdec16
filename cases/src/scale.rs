//! From the simulator's own metres and newtons to the size and coordinate of a case.

use serde::Serialize;

/// How large a case is. Everything is simulated at the size of a bench; time never scales.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Scale {
    /// Metres (or radians) of the case per metre of the bench.
    pub length: f64,
    /// Newtons (or newton metres) of the case per newton of the bench.
    pub force: f64,
    /// Radians and newton metres instead of metres and newtons.
    pub rotary: bool,
}

/// The dimension of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A pure number.
    One,
    /// An angle that is no position, rad.
    Angle,
    /// s
    Time,
    /// Hz
    Frequency,
    /// m
    Length,
    /// 1/m
    PerLength,
    /// m/s
    Velocity,
    /// N
    Force,
    /// N/s
    ForceRate,
    /// N/m
    Stiffness,
    /// N/m^3
    Hardening,
    /// N s/m
    Damping,
    /// N s/m^2
    DampingGradient,
    /// N s^2/m^2
    Drag,
    /// kg
    Mass,
}

impl Unit {
    /// Powers of length and of force.
    fn powers(self) -> (i32, i32) {
        match self {
            Self::One | Self::Angle | Self::Time | Self::Frequency => (0, 0),
            Self::Length | Self::Velocity => (1, 0),
            Self::PerLength => (-1, 0),
            Self::Force | Self::ForceRate => (0, 1),
            Self::Stiffness | Self::Damping | Self::Mass => (-1, 1),
            Self::DampingGradient | Self::Drag => (-2, 1),
            Self::Hardening => (-3, 1),
        }
    }

    /// As a report writes it.
    #[must_use]
    pub fn name(self, rotary: bool) -> &'static str {
        let (linear, turned) = match self {
            Self::One => ("1", "1"),
            Self::Angle => ("rad", "rad"),
            Self::Time => ("s", "s"),
            Self::Frequency => ("Hz", "Hz"),
            Self::Length => ("m", "rad"),
            Self::PerLength => ("1/m", "1/rad"),
            Self::Velocity => ("m/s", "rad/s"),
            Self::Force => ("N", "N m"),
            Self::ForceRate => ("N/s", "N m/s"),
            Self::Stiffness => ("N/m", "N m/rad"),
            Self::Hardening => ("N/m^3", "N m/rad^3"),
            Self::Damping => ("N s/m", "N m s/rad"),
            Self::DampingGradient => ("N s/m^2", "N m s/rad^2"),
            Self::Drag => ("N s^2/m^2", "N m s^2/rad^2"),
            Self::Mass => ("kg", "kg m^2"),
        };
        if rotary { turned } else { linear }
    }
}

impl Scale {
    /// A bench as it is.
    pub const BENCH: Self = Self { length: 1.0, force: 1.0, rotary: false };

    /// `value` of the bench at the size of the case.
    #[must_use]
    pub fn apply(&self, value: f64, unit: Unit) -> f64 {
        let (length, force) = unit.powers();
        value * self.length.powi(length) * self.force.powi(force)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scaled_spring_pulls_a_scaled_force() {
        let scale = Scale { length: 1e-3, force: 1e-5, rotary: false };
        let force = scale.apply(300.0, Unit::Stiffness) * scale.apply(0.004, Unit::Length);
        assert!((force / scale.apply(1.2, Unit::Force) - 1.0).abs() < 1e-12);
    }
}
