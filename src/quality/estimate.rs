//! The estimate with its intervals and flags, in SI.

use crate::contact::Impedance;
use crate::error::{ConfigError, require_not_negative};
use crate::front_end::FrontEnd;
use crate::math::sym2::Sym2;
use crate::math::{larger, near_sqrt};
use crate::quality::confidence::Confidence;
use crate::quality::flags::Flags;
use crate::quality::step::Step;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// An estimate with its quality, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// K and B; zero out of contact.
    pub impedance: Impedance,
    /// Half-widths of the 95 % intervals; infinite where nothing is known, zero out of contact.
    pub half_width: Impedance,
    /// Force minus what the estimate before this sample predicted [N or N m]; out of contact the force itself.
    pub innovation: f32,
    /// Share of the window or memory that is filled, 0 to 1.
    pub fill: f32,
    /// Independence of penetration and rate, 0 to 1.
    pub excitation: f32,
    /// Conditions that limit the validity of the estimate.
    pub flags: Flags,
}

impl Estimate {
    /// In contact, with no information yet.
    pub const UNKNOWN: Self = Self {
        half_width: Impedance { stiffness: f32::INFINITY, damping: f32::INFINITY },
        flags: Flags::HELD,
        ..Self::NO_CONTACT
    };

    /// Out of contact.
    pub const NO_CONTACT: Self = Self {
        impedance: Impedance::ZERO,
        half_width: Impedance::ZERO,
        innovation: 0.0,
        fill: 0.0,
        excitation: 0.0,
        flags: Flags::NO_CONTACT,
    };
}

/// Resolution and noise of the sensors, in SI; zero where unknown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SensorResolution {
    /// One count of the position sensor [m or rad].
    pub position_resolution: f32,
    /// Standard deviation of the force sensor's noise, its rounding included [N or N m]. Where it is given, a window too
    /// short to measure it has intervals all the same.
    pub force_noise: f32,
}

impl SensorResolution {
    pub(crate) fn check(self) -> Result<(), ConfigError> {
        require_not_negative(self.position_resolution, "sensors.position_resolution")?;
        require_not_negative(self.force_noise, "sensors.force_noise")
    }
}

/// Converts the outcome of a law into an [`Estimate`]: internal units to SI, confidence to 95 % intervals.
///
/// The half-width is `sqrt(t^2 variance + (0.95 offset_gain K * half a count)^2) + |startup_bias|`, with the parts of
/// [`crate::Confidence`]: the surface lies anywhere within a count, so 95 % of its places lie within 0.95 of half a count, and
/// two independent errors add as squares. The residual is coloured by the filter, so n samples count as n over
/// `correlated_samples`; t is Student's for that number less two, or for ten where the force noise is known beforehand; and
/// the noise is never taken to be less than that of both sensors. It covers noise, rounding, start-up and a surface_error
/// surface; not the bias of a model, of [`crate::Velocity::Paper`], or of a motion of angular frequency w sampled every T
/// seconds, (w T)^2 / 12 of B.
#[derive(Debug, Clone, Copy)]
pub struct IntervalEstimator {
    /// One internal unit of K and of B.
    unit: Impedance,
    force_unit: f32,
    correlated_samples: f32,
    half_count: f32,
    position_variance: f32,
    force_variance: f32,
}

impl IntervalEstimator {
    /// Share of the value above which an interval is flagged.
    const MAX_RELATIVE_HALF_WIDTH: f32 = 0.3;

    /// Share of half a count that contains 95 % of the possible positions of the surface.
    const SURFACE_COVERAGE: f32 = 0.95;

    /// Degrees of freedom attributed to a force noise that is known beforehand.
    const KNOWN_NOISE_FREEDOM: f32 = 10.0;

    pub(crate) fn new(front_end: &FrontEnd, sensors: SensorResolution) -> Self {
        let units = front_end.config().units;
        let position = sensors.position_resolution / units.penetration;
        let force = sensors.force_noise / units.force;
        Self {
            unit: units.impedance(),
            force_unit: units.force,
            correlated_samples: front_end.correlated_samples(),
            half_count: 0.5 * position,
            position_variance: position * position / 12.0,
            force_variance: force * force,
        }
    }

    /// The estimate in SI.
    // Inlined: what a law's step holds and no interval needs, is then not even computed.
    #[inline(always)]
    pub fn assess(&self, step: &Step) -> Estimate {
        let half_width = self.half_width(step.estimate.stiffness, &step.confidence);
        let mut flags = step.flags | Self::doubts(step.estimate, step.fill);
        let wide = |half_width: f32, value: f32| half_width > Self::MAX_RELATIVE_HALF_WIDTH * value.abs();
        flags.set(Flags::STIFFNESS_UNCERTAIN, wide(half_width.stiffness, step.estimate.stiffness));
        flags.set(Flags::DAMPING_UNCERTAIN, wide(half_width.damping, step.estimate.damping));
        Estimate {
            impedance: self.in_si(step.estimate),
            half_width: self.in_si(half_width),
            innovation: step.innovation * self.force_unit,
            fill: step.fill,
            excitation: step.excitation,
            flags,
        }
    }

    /// [`Flags::FILLING`] and [`Flags::NEGATIVE`] where they hold: what can be said of an estimate without its interval.
    #[inline(always)]
    pub(crate) fn doubts(estimate: Impedance, fill: f32) -> Flags {
        let mut flags = Flags::empty();
        flags.set(Flags::FILLING, fill < 0.99);
        flags.set(Flags::NEGATIVE, estimate.stiffness < 0.0 || estimate.damping < 0.0);
        flags
    }

    /// 95 % half-widths in SI of `estimate`, in internal units, by its confidence.
    pub(crate) fn half_width_in_si(&self, estimate: Impedance, confidence: &Confidence) -> Impedance {
        self.in_si(self.half_width(estimate.stiffness, confidence))
    }

    #[inline(always)]
    pub(crate) fn in_si(&self, internal: Impedance) -> Impedance {
        Impedance { stiffness: internal.stiffness * self.unit.stiffness, damping: internal.damping * self.unit.damping }
    }

    #[inline(always)]
    fn half_width(&self, stiffness: f32, c: &Confidence) -> Impedance {
        let diagonal = |m: Sym2| Impedance { stiffness: m.xx, damping: m.vv };
        self.widths(stiffness, c.samples, diagonal(c.noise), diagonal(c.noise_gain), c.startup_bias, c.offset_gain)
    }

    /// The formula of [`IntervalEstimator`] for both parameters. A function of numbers: they come in registers, and no law has the code
    /// again.
    #[inline(never)]
    fn widths(
        &self,
        stiffness: f32,
        samples: f32,
        noise: Impedance,
        noise_gain: Impedance,
        startup_bias: Impedance,
        offset_gain: Impedance,
    ) -> Impedance {
        let known = self.force_variance + stiffness * stiffness * self.position_variance;
        let measured = samples / self.correlated_samples - 2.0;
        let t = student_t_975(if self.force_variance > 0.0 {
            larger(measured, Self::KNOWN_NOISE_FREEDOM)
        } else {
            measured
        });
        let surface = Self::SURFACE_COVERAGE * stiffness * self.half_count;
        let width = |noise: f32, gain: f32, startup_bias: f32, offset: f32| {
            let variance = larger(noise * self.correlated_samples, known * gain);
            // Rounding may leave a variance of zero a trifle below it; NaN (nothing known) passes on.
            let variance = if variance < 0.0 { 0.0 } else { variance };
            let surface_error = offset * surface;
            let width = near_sqrt(t * t * variance + surface_error * surface_error) + startup_bias.abs();
            if width.is_nan() { f32::INFINITY } else { width }
        };
        Impedance {
            stiffness: width(noise.stiffness, noise_gain.stiffness, startup_bias.stiffness, offset_gain.stiffness),
            damping: width(noise.damping, noise_gain.damping, startup_bias.damping, offset_gain.damping),
        }
    }
}

/// The 97.5 % point of Student's distribution within 4 %, infinite below one degree of freedom.
fn student_t_975(freedom: f32) -> f32 {
    if freedom >= 1.0 {
        let inverse = 1.0 / freedom;
        1.96 + inverse * (2.4 + inverse * (2.0 + inverse * 6.3))
    } else {
        f32::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantile_is_that_of_the_printed_tables() {
        for (freedom, quantile) in
            [(1.0, 12.706), (2.0, 4.303), (3.0, 3.182), (5.0, 2.571), (10.0, 2.228), (30.0, 2.042), (1e4, 1.960)]
        {
            let error = student_t_975(freedom) / quantile - 1.0;
            assert!(error.abs() < 0.04, "{freedom}: {error}");
        }
        assert_eq!(student_t_975(0.9), f32::INFINITY);
        assert_eq!(student_t_975(f32::NAN), f32::INFINITY);
    }

    /// An estimator of intervals in internal units, and a step whose half-widths are `half_width` to the bit.
    fn assessed(estimate: [f32; 2], half_width: [f32; 2]) -> Estimate {
        use crate::front_end::{FrontEndConfig, Units};
        use crate::math::sym2::Sym2;
        use crate::quality::Confidence;
        let front_end = FrontEnd::new(FrontEndConfig { units: Units::SI, ..FrontEndConfig::BENCH }).expect("settings");
        let estimator = IntervalEstimator::new(&front_end, SensorResolution::default());
        let [of_k, of_b] = half_width;
        let confidence = Confidence {
            noise: Sym2::ZERO,
            noise_gain: Sym2::ZERO,
            startup_bias: Impedance { stiffness: of_k, damping: of_b },
            offset_gain: Impedance::ZERO,
            samples: 1e3,
        };
        let [stiffness, damping] = estimate;
        let estimate = Impedance { stiffness, damping };
        estimator.assess(&Step {
            estimate,
            innovation: 0.0,
            confidence,
            fill: 1.0,
            excitation: 1.0,
            flags: Flags::empty(),
        })
    }

    #[test]
    fn the_quantile_is_its_series() {
        for freedom in [1.0, 2.0, 4.0, 16.0, 1024.0_f32] {
            let inverse = 1.0 / f64::from(freedom);
            let series = 1.96 + 2.4 * inverse + 2.0 * inverse * inverse + 6.3 * inverse * inverse * inverse;
            assert!((f64::from(student_t_975(freedom)) / series - 1.0).abs() < 1e-6, "{freedom}");
        }
    }

    /// Factors that are all different and exact, two samples worth one.
    const ESTIMATOR: IntervalEstimator = IntervalEstimator {
        unit: Impedance { stiffness: 2.0, damping: 4.0 },
        force_unit: 8.0,
        correlated_samples: 2.0,
        half_count: 0.5,
        position_variance: 0.25,
        force_variance: 0.0625,
    };

    fn step(samples: f32) -> Step {
        Step {
            estimate: Impedance { stiffness: 3.0, damping: -0.5 },
            innovation: 0.75,
            confidence: crate::quality::Confidence {
                noise: crate::math::sym2::Sym2 { xx: 0.5, xv: 9.0, vv: 0.125 },
                noise_gain: crate::math::sym2::Sym2 { xx: 1.5, xv: 9.0, vv: 0.03125 },
                startup_bias: Impedance { stiffness: -0.25, damping: 0.375 },
                offset_gain: Impedance { stiffness: 1.25, damping: -2.5 },
                samples,
            },
            fill: 1.0,
            excitation: 0.625,
            flags: Flags::RESET,
        }
    }

    /// The formula of [`IntervalEstimator`] for one parameter, in double precision.
    fn width(e: &IntervalEstimator, freedom: f64, of: [f32; 4], stiffness: f32) -> f64 {
        let [noise, gain, bias, offset] = of.map(f64::from);
        let stiffness = f64::from(stiffness);
        let known = f64::from(e.force_variance) + stiffness.powi(2) * f64::from(e.position_variance);
        let variance = (noise * f64::from(e.correlated_samples)).max(known * gain);
        let t = 1.96 + 2.4 / freedom + 2.0 / freedom.powi(2) + 6.3 / freedom.powi(3);
        let surface = 0.95 * offset * stiffness * f64::from(e.half_count);
        (t.powi(2) * variance + surface.powi(2)).sqrt() + bias.abs()
    }

    #[test]
    fn a_half_width_is_made_of_noise_surface_and_bias() {
        // Samples over two, less two; ten at least where the noise is known beforehand.
        for (force_variance, samples, freedom) in
            [(0.0625, 100.0, 48.0), (0.0625, 12.0, 10.0), (0.0, 12.0, 4.0), (0.0, 100.0, 48.0)]
        {
            let estimator = IntervalEstimator { force_variance, ..ESTIMATOR };
            let step = step(samples);
            let found = estimator.half_width(step.estimate.stiffness, &step.confidence);
            let c = &step.confidence;
            let of_k = [c.noise.xx, c.noise_gain.xx, c.startup_bias.stiffness, c.offset_gain.stiffness];
            let of_b = [c.noise.vv, c.noise_gain.vv, c.startup_bias.damping, c.offset_gain.damping];
            for (found, of) in [(found.stiffness, of_k), (found.damping, of_b)] {
                let expected = width(&estimator, freedom, of, step.estimate.stiffness);
                assert!((f64::from(found) / expected - 1.0).abs() < 1e-6, "{samples}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_variance_that_rounding_made_negative_is_zero_and_one_that_is_none_is_infinite() {
        let mut step = step(100.0);
        (step.confidence.noise.xx, step.confidence.noise_gain.xx) = (-0.5, -1.0);
        (step.confidence.noise.vv, step.confidence.noise_gain.vv) = (f32::NAN, f32::NAN);
        let found = ESTIMATOR.half_width(step.estimate.stiffness, &step.confidence);
        // The surface alone, 0.95 * 1.25 * 3 * 0.5, and the bias.
        assert!((found.stiffness / (1.781_25 + 0.25) - 1.0).abs() < 1e-6, "{found:?}");
        assert_eq!(found.damping, f32::INFINITY);
    }

    #[test]
    fn an_estimate_is_told_in_si() {
        let step = step(100.0);
        let found = ESTIMATOR.assess(&step);
        let half = ESTIMATOR.half_width(step.estimate.stiffness, &step.confidence);
        assert_eq!(found.impedance, Impedance { stiffness: 6.0, damping: -2.0 });
        let expected = Impedance { stiffness: 2.0 * half.stiffness, damping: 4.0 * half.damping };
        assert_eq!((found.half_width, found.innovation), (expected, 6.0));
        assert_eq!((found.fill, found.excitation), (1.0, 0.625));
        assert!(found.flags.contains(Flags::RESET | Flags::NEGATIVE), "{:?}", found.flags);
    }

    #[test]
    fn a_window_is_filling_below_ninety_nine_hundredths() {
        for (fill, filling) in [(0.0, true), (0.98, true), (0.99, false), (1.0, false)] {
            let found = ESTIMATOR.assess(&Step { fill, ..step(100.0) });
            assert_eq!(found.flags.contains(Flags::FILLING), filling, "{fill}");
        }
    }

    #[test]
    fn the_sensors_enter_in_internal_units() {
        use crate::front_end::{FrontEndConfig, Units};
        let units = Units { penetration: 0.25, rate: 0.5, force: 4.0 };
        let front_end = FrontEnd::new(FrontEndConfig { units, ..FrontEndConfig::BENCH }).expect("settings");
        let sensors = SensorResolution { position_resolution: 0.75, force_noise: 2.0 };
        let found = IntervalEstimator::new(&front_end, sensors);
        assert_eq!((found.half_count, found.position_variance, found.force_variance), (1.5, 0.75, 0.25));
        assert_eq!((found.unit, found.force_unit), (Impedance { stiffness: 16.0, damping: 8.0 }, 4.0));
        assert_eq!(found.correlated_samples, front_end.correlated_samples());
        for (position_resolution, force_noise, sound) in
            [(0.0, 0.0, true), (1.0, 1.0, true), (-1.0, 0.0, false), (0.0, -1.0, false), (f32::NAN, 0.0, false)]
        {
            let checked = SensorResolution { position_resolution, force_noise }.check();
            assert_eq!(checked.is_ok(), sound, "{position_resolution} {force_noise}");
        }
    }

    #[test]
    fn a_width_of_exactly_the_share_is_no_doubt() {
        // Nothing of nothing, where the share is zero too.
        assert_eq!(assessed([0.0, 0.0], [0.0, 0.0]).flags, Flags::empty());
        assert_eq!(assessed([0.0, 0.0], [1e-6, 0.0]).flags, Flags::STIFFNESS_UNCERTAIN);
    }

    #[test]
    fn an_interval_is_flagged_above_thirty_hundredths_of_its_own_value() {
        let (of_k, of_b) = (Flags::STIFFNESS_UNCERTAIN, Flags::DAMPING_UNCERTAIN);
        for (half_width, want) in [
            ([0.0, 0.0], Flags::empty()),
            ([29.9, 2.99], Flags::empty()),
            ([30.1, 2.99], of_k),
            ([29.9, 3.01], of_b),
            ([30.1, 3.01], of_k | of_b),
        ] {
            let estimate = assessed([100.0, 10.0], half_width);
            assert_eq!([estimate.half_width.stiffness, estimate.half_width.damping], half_width);
            assert_eq!(estimate.flags, want, "{half_width:?}");
            assert_eq!(assessed([-100.0, -10.0], half_width).flags, want | Flags::NEGATIVE, "{half_width:?}");
        }
    }

    #[test]
    fn a_negative_value_of_either_parameter_is_flagged() {
        for (estimate, negative) in
            [([1.0, 1.0], false), ([0.0, 0.0], false), ([-1.0, 1.0], true), ([1.0, -1.0], true), ([-1.0, -1.0], true)]
        {
            assert_eq!(assessed(estimate, [0.0; 2]).flags.contains(Flags::NEGATIVE), negative, "{estimate:?}");
        }
    }
}
