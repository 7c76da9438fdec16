//! Internal units: SI outside, numbers of a convenient size inside.

use crate::contact::{Impedance, Observation};
use crate::error::{ConfigError, require};
use crate::math::nearest_power_of_two;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// The size of one internal unit, in SI.
///
/// The settings of the paper (an initial covariance of 10, a perturbation gain of 100, ...) are numbers for its bench:
/// millimetres, tenths of a metre a second, newtons. On a rig of other proportions the same number means something
/// else, and in single precision the fourth powers of nanonewtons are zero. Internal units carry the settings over:
/// they act as they do on the paper's bench. All three are powers of two where [`Units::for_range`] makes them, so
/// converting back and forth is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Units {
    /// One internal unit of penetration [m or rad].
    pub penetration: f32,
    /// One internal unit of rate [m/s or rad/s].
    pub rate: f32,
    /// One internal unit of force [N or N m].
    pub force: f32,
}

impl Units {
    /// Internal units are SI: settings mean what the paper prints.
    pub const SI: Self = Self { penetration: 1.0, rate: 1.0, force: 1.0 };

    /// Full scale of the paper's bench: 13.5 mm, 0.2 m/s, 4 N.
    pub const BENCH_RANGE: Observation = Observation { penetration: 0.0135, rate: 0.2, force: 4.0 };

    /// Within this factor of the bench's full scale a quantity stays in SI.
    const BENCH_LIKE: f32 = 16.0;

    /// Units for a rig whose penetration, rate and force reach about `range` (SI, each above zero).
    ///
    /// Within a factor of 16 of the paper's bench a unit is SI itself, so that settings keep their printed meaning;
    /// beyond it, it is the power of two that maps `range` onto the bench's.
    pub fn for_range(range: Observation) -> Self {
        let unit = |value: f32, bench: f32| {
            let ratio = value / bench;
            let like_the_bench = (1.0 / Self::BENCH_LIKE..=Self::BENCH_LIKE).contains(&ratio);
            if like_the_bench || !(ratio >= f32::MIN_POSITIVE && ratio.is_finite()) {
                1.0
            } else {
                nearest_power_of_two(ratio)
            }
        };
        Self {
            penetration: unit(range.penetration, Self::BENCH_RANGE.penetration),
            rate: unit(range.rate, Self::BENCH_RANGE.rate),
            force: unit(range.force, Self::BENCH_RANGE.force),
        }
    }

    pub(crate) fn check(self) -> Result<(), ConfigError> {
        for (value, name) in
            [(self.penetration, "units.penetration"), (self.rate, "units.rate"), (self.force, "units.force")]
        {
            require((1e-18..=1e18).contains(&value), name, "a unit between 1e-18 and 1e18")?;
        }
        Ok(())
    }

    /// One internal unit of K and of B, in SI.
    pub fn impedance(self) -> Impedance {
        Impedance { stiffness: self.force / self.penetration, damping: self.force / self.rate }
    }

    /// Internal from SI.
    pub fn observation_from_si(self, si: Observation) -> Observation {
        Observation {
            penetration: si.penetration / self.penetration,
            rate: si.rate / self.rate,
            force: si.force / self.force,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bench_stays_in_si_and_nanonewtons_do_not() {
        assert_eq!(Units::for_range(Units::BENCH_RANGE), Units::SI);
        assert_eq!(Units::for_range(Observation { penetration: 0.1, rate: 1.0, force: 30.0 }), Units::SI);
        let afm = Units::for_range(Observation { penetration: 2e-6, rate: 2e-6, force: 1e-9 });
        for unit in [afm.penetration, afm.rate, afm.force] {
            assert_eq!(unit.to_bits() & 0x007f_ffff, 0, "{unit} is no power of two");
        }
        let inside = afm.observation_from_si(Observation { penetration: 2e-6, rate: 2e-6, force: 1e-9 });
        let bench = Units::BENCH_RANGE;
        for (got, want) in
            [(inside.penetration, bench.penetration), (inside.rate, bench.rate), (inside.force, bench.force)]
        {
            assert!((0.7..=1.42).contains(&(got / want)), "{got} is not within half a power of two of {want}");
        }
    }

    #[test]
    fn within_a_factor_of_sixteen_either_way_units_are_si() {
        let of = |factor: f32| {
            let bench = Units::BENCH_RANGE;
            let range = [bench.penetration, bench.rate, bench.force].map(|value| value * factor);
            Units::for_range(Observation { penetration: range[0], rate: range[1], force: range[2] })
        };
        for factor in [1.0, 8.0, 15.0, 1.0 / 8.0, 1.0 / 15.0] {
            assert_eq!(of(factor), Units::SI, "{factor}");
        }
        assert_eq!(of(32.0), Units { penetration: 32.0, rate: 32.0, force: 32.0 });
        assert_eq!(of(1.0 / 64.0), Units { penetration: 1.0 / 64.0, rate: 1.0 / 64.0, force: 1.0 / 64.0 });
        for no_range in [0.0, f32::INFINITY, f32::NAN, 1e-40] {
            assert_eq!(of(no_range), Units::SI, "{no_range}");
        }
    }

    #[test]
    fn units_are_checked_at_their_limits() {
        for (unit, accepted) in [(1e-18, true), (1e18, true), (0.9e-18, false), (1.1e18, false), (f32::NAN, false)] {
            for units in [
                Units { penetration: unit, ..Units::SI },
                Units { rate: unit, ..Units::SI },
                Units { force: unit, ..Units::SI },
            ] {
                assert_eq!(units.check().is_ok(), accepted, "{units:?}");
            }
        }
        let units = Units { penetration: 0.25, rate: 0.5, force: 4.0 };
        assert_eq!(units.impedance(), Impedance { stiffness: 16.0, damping: 8.0 });
    }
}
