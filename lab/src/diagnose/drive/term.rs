//! What a model of the drive can hold beyond mass and viscous friction, and the values that each term brings.

use super::course::{Along, Course, Varying};
use super::criteria::{
    GENTLEST_LIMIT, LEAST_EXPONENT, LOAD_DEVIATION, LONGEST_PRESLIDING, MOST_EXPONENT, SLOWEST_SWING,
    STRONGEST_SMOOTH_LIMIT,
};
use super::curve::Curve;
use super::effort_limit::EffortLimit;
use super::law::{DriveLaw, Link, Periodic, Side};
use super::load_share::{self, OfHalves, of_friction};
use super::range::{Prior, Range};
use super::scales::Scales;
use crate::effects::MOST_PATTERNS;

/// A term with its law.
#[derive(Debug, Clone, PartialEq)]
pub enum Term {
    /// Dry friction of one level.
    Coulomb,
    /// The same of two levels, forward and backward.
    AsymmetricCoulomb,
    /// Dry friction that is larger when creeping (Gaussian decay).
    Stribeck,
    /// Friction that grows with a power of the speed below one, beside dry friction.
    Sublinear,
    /// The way over which dry friction builds up: no effect of its own, but a part of every dry friction.
    Presliding,
    /// Friction in proportion to what is borne.
    LoadFriction,
    /// A constant load.
    ConstantLoad,
    /// A load by angle or position with one slow period: gravity on an arm.
    AngleLoad,
    /// A load that repeats along the way many times.
    Cogging,
    /// So many such loads, two or more, as those of a magnet's pitch and of a slot's, or a wave and its harmonics.
    Ripples(usize),
    /// Effort that ends at a limit.
    EffortLimit,
    /// Effort that nears a limit, as of iron that saturates.
    SmoothLimit,
    /// Effort that follows its command by a first-order lag.
    EffortLag,
    /// A spring and damper between motor and load; the encoder sits on one side.
    Compliance(Side),
    /// The same behind a play.
    Play(Side),
    /// A force sensor that is off by a factor.
    ForceGain,
    /// A force that is recorded late.
    ForceDelay,
    /// A mass beyond the force sensor.
    ToolInertia,
    /// A factor of the load that a rigid-body model explains: a value of the rig file and no effect.
    LoadScale,
    /// Friction or effort that changes, of no law, by `count` knots.
    Course {
        /// What changes.
        of: Varying,
        /// What it changes with.
        along: Along,
        /// First knot, s after the first row, or m or rad.
        origin: f64,
        /// Distance of two knots.
        spacing: f64,
        /// How many.
        count: usize,
    },
    /// A load by position of no law, by `count` knots.
    Curve {
        /// First knot, m or rad.
        origin: f64,
        /// Distance of two knots, m or rad.
        spacing: f64,
        /// How many.
        count: usize,
    },
}

/// Share of the effort that a force steps by in a search.
const FORCE_STEP: f64 = 0.05;

/// Shortest way over which a search lets dry friction build up, over the travel: what bends a millionth is rigid.
const SHORTEST_PRESLIDING: f64 = 1e-6;

/// Longest pitch of a ripple that turns: two a turn.
const LONGEST_PITCH_RAD: f64 = std::f64::consts::PI;

/// Ratio of the ends of a stiffness that may be none: of a deviation d of its logarithm, as its ends are told, they lie at exp(-1.96 d) and exp(1.96 d), and
/// 1 - 1.96 d is zero at their ratio of e^2.
const SPRINGLESS: f64 = std::f64::consts::E * std::f64::consts::E;

/// Largest error of the factor of a load, in its deviations, that is still one of its values.
const WORST_LOAD: f64 = 3.0;

/// Where the wavenumbers stand among the values of ripples.
const PITCHES: [usize; MOST_PATTERNS] = [2, 5, 8, 11, 14, 17];

/// Lowest limit of an effort: what is often passed is no limit, but what the friction takes of it.
fn lowest_limit(scales: &Scales) -> f64 {
    scales.usual_effort.max(0.2 * scales.effort)
}

impl Term {
    /// Name of the effect, as the contract has it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Coulomb | Self::AsymmetricCoulomb => "coulomb_friction",
            Self::Stribeck => "stribeck_friction",
            Self::Sublinear => "sublinear_friction",
            Self::Presliding => "presliding",
            Self::LoadFriction => "load_dependent_friction",
            Self::ConstantLoad | Self::AngleLoad => "gravity_load",
            Self::Cogging | Self::Ripples(_) => "cogging",
            Self::EffortLimit | Self::SmoothLimit => "effort_saturation",
            Self::EffortLag => "effort_lag",
            Self::Compliance(_) => "transmission_compliance",
            Self::Play(_) => "backlash",
            Self::ForceGain => "force_gain",
            Self::ForceDelay => "channel_delay",
            Self::ToolInertia => "tool_inertia",
            Self::LoadScale => "load_scale",
            Self::Course { .. } => "course",
            Self::Curve { .. } => "learned",
        }
    }

    /// Whether it is told as physics of its own.
    #[must_use]
    pub const fn is_told(&self) -> bool {
        !matches!(self, Self::Presliding | Self::LoadScale)
    }

    /// Whether it is dry friction, which holds at rest.
    #[must_use]
    pub const fn is_friction(&self) -> bool {
        matches!(self, Self::Coulomb | Self::AsymmetricCoulomb | Self::Stribeck | Self::Sublinear | Self::LoadFriction)
    }

    /// Whether it repeats along the way many times.
    #[must_use]
    pub const fn is_ripple(&self) -> bool {
        matches!(self, Self::Cogging | Self::Ripples(_))
    }

    /// Whether it parts motor and load.
    #[must_use]
    pub fn is_link(&self) -> bool {
        matches!(self, Self::Compliance(_) | Self::Play(_))
    }

    /// Where the encoder sits, of a term that parts motor and load.
    #[must_use]
    pub fn encoder(&self) -> Option<Side> {
        match self {
            Self::Compliance(side) | Self::Play(side) => Some(*side),
            _ => None,
        }
    }

    /// The ranges of its values.
    #[must_use]
    pub fn ranges(&self, scales: &Scales) -> Vec<Range> {
        let force = FORCE_STEP * scales.effort;
        let any = Range::absolute(f64::NEG_INFINITY, f64::INFINITY, force);
        let positive = Range::absolute(0.0, f64::INFINITY, force);
        let swing = SLOWEST_SWING.value() / scales.duration_s;
        let fastest = 4.0 / scales.period_s;
        let stiffness = Range::relative(scales.inertia * swing * swing, scales.inertia * fastest * fastest);
        let damping = Range::relative(1e-2 * scales.inertia / scales.duration_s, scales.inertia / scales.period_s);
        match self {
            Self::Coulomb => vec![positive],
            Self::AsymmetricCoulomb => vec![positive, positive],
            Self::Stribeck => {
                vec![positive, positive, Range::relative(1e-3 * scales.speed, 0.5 * scales.speed)]
            }
            Self::Sublinear => {
                vec![positive, Range::absolute(LEAST_EXPONENT.value(), MOST_EXPONENT.value(), 0.1)]
            }
            Self::Presliding => {
                vec![Range::relative(SHORTEST_PRESLIDING * scales.travel, (LONGEST_PRESLIDING * scales.travel).value())]
            }
            Self::LoadFriction => vec![Range::absolute(0.0, 1.0, 0.02)],
            Self::ConstantLoad => vec![any],
            // An arm's weight comes round once a turn, beside a constant; on a slide nobody knows the length.
            Self::AngleLoad if scales.is_rotary => vec![any, any, any],
            Self::AngleLoad => vec![any, any, Range::relative(0.5 / scales.travel, 12.0 / scales.travel)],
            Self::Cogging => {
                let finest = (2.0 * scales.resolution).max(1e-5 * scales.travel);
                // Once a turn is a load by angle, whatever it comes from.
                let turn = if scales.is_rotary { LONGEST_PITCH_RAD } else { f64::INFINITY };
                vec![any, any, Range::relative(wavenumber((0.5 * scales.travel).min(turn)), wavenumber(finest))]
            }
            Self::Ripples(count) => Self::Cogging.ranges(scales).repeat(*count),
            Self::EffortLimit => {
                vec![Range::absolute(lowest_limit(scales), scales.peak_effort, 0.02 * scales.effort)]
            }
            Self::SmoothLimit => {
                let lowest = (STRONGEST_SMOOTH_LIMIT * lowest_limit(scales)).value();
                vec![Range::relative(lowest, (GENTLEST_LIMIT * scales.peak_effort).value())]
            }
            Self::EffortLag => vec![Range::relative(0.05 * scales.period_s, 0.05 * scales.duration_s)],
            Self::Compliance(side) => {
                let share = load_share::range(self, scales);
                vec![stiffness, damping, share, of_friction(*side, &share)]
            }
            Self::Play(side) => {
                let play = Range::relative(0.05 * scales.resolution, 0.2 * scales.travel);
                let share = load_share::range(self, scales);
                vec![stiffness, damping, share, play, of_friction(*side, &share)]
            }
            Self::ForceGain => vec![Range::absolute(-0.5, 1.0, 0.02)],
            Self::ForceDelay => vec![Range::absolute(-2.0 * scales.period_s, 0.05, scales.period_s)],
            Self::ToolInertia => vec![Range::absolute(0.0, 0.8 * scales.inertia, 0.02 * scales.inertia)],
            Self::LoadScale => {
                let deviation = LOAD_DEVIATION.value();
                let worst = WORST_LOAD * deviation;
                let range = Range::absolute(1.0 - worst, 1.0 + worst, 0.1 * deviation);
                vec![range.known(Prior { mean: 1.0, deviation })]
            }
            Self::Course { count, .. } => vec![Range::absolute(-1.0, f64::INFINITY, 0.1); *count],
            Self::Curve { count, .. } => vec![any; *count],
        }
    }

    /// Whether a value of it ended where its search did, of those values that make it what it is.
    #[must_use]
    pub fn is_at_end(&self, values: &[f64], scales: &Scales) -> bool {
        let ranges = self.ranges(scales);
        self.telling(scales).iter().any(|at| ranges[*at].is_at_end(values[*at]))
    }

    /// Whether the 95 % interval of a value that makes it what it is, of those in `ends`, is all of the value's range: the recordings do not
    /// show it (practical non-identifiability: A. Raue et al., *Bioinformatics* 25, 2009, 1923). Or that of a level or an excess of Stribeck friction, or of
    /// the stiffness of a link (`SPRINGLESS`), holds zero, where it is none (A. Wald, *Trans. Am. Math. Soc.* 54, 1943): motor and load without a spring between
    /// them are held by a damper, as of a wheel that slips. Parts of another friction stand for each other and are judged by their likelihood alone.
    #[must_use]
    pub fn is_undetermined(&self, ends: &[[f64; 2]], scales: &Scales) -> bool {
        let ranges = self.ranges(scales);
        self.telling(scales).iter().any(|at| {
            let ([low, high], range) = (ends[*at], &ranges[*at]);
            let may_be_none = match self {
                Self::Stribeck => low <= range.low && range.low == 0.0,
                Self::Compliance(_) => *at == 0 && high >= SPRINGLESS * low,
                _ => false,
            };
            may_be_none || low <= range.low && high >= range.high
        })
    }

    /// Which of its values make it what it is.
    const fn telling(&self, scales: &Scales) -> &'static [usize] {
        match self {
            Self::Coulomb
            | Self::EffortLag
            | Self::EffortLimit
            | Self::SmoothLimit
            | Self::LoadFriction
            | Self::ForceGain
            | Self::ForceDelay
            | Self::ToolInertia => &[0],
            // A weight of which a slide shows less than half a radian is any force that grows with the position.
            Self::AngleLoad if !scales.is_rotary => &[2],
            // What is gone where it moves is no dry friction: a coarse encoder that stands still looks like it.
            Self::Stribeck => &[0, 1, 2],
            Self::AsymmetricCoulomb | Self::Sublinear => &[0, 1],
            Self::Cogging => &[2],
            Self::Ripples(count) => PITCHES.split_at(*count).0,
            // Seen from the load alone, one share of the inertia is as good as another (see [`OfHalves`]).
            Self::Compliance(Side::Load) => &[0],
            Self::Compliance(Side::Motor) => &[0, 2],
            Self::Play(Side::Load) => &[3],
            Self::Play(Side::Motor) => &[2, 3],
            _ => &[],
        }
    }

    /// Whether a value of it sets its shape, beside its size.
    #[must_use]
    pub const fn has_free_shape(&self, scales: &Scales) -> bool {
        matches!(self, Self::Cogging | Self::Ripples(_) | Self::Sublinear)
            || (matches!(self, Self::AngleLoad) && !scales.is_rotary)
    }

    /// Puts it into `law` with `values`.
    pub fn apply(&self, values: &[f64], scales: &Scales, law: &mut DriveLaw) {
        match self {
            Self::Coulomb => law.friction.coulomb += values[0],
            Self::AsymmetricCoulomb => {
                law.friction.coulomb += 0.5 * (values[0] + values[1]);
                law.offset += 0.5 * (values[0] - values[1]);
            }
            Self::Stribeck => {
                law.friction.coulomb += values[0];
                law.friction.stribeck_excess = values[1];
                law.friction.stribeck_speed = values[2];
            }
            Self::Sublinear => {
                law.friction.sublinear = values[0];
                law.friction.sublinear_exponent = values[1];
                law.friction.reference_speed = scales.speed;
            }
            Self::Presliding => law.friction.presliding = values[0],
            Self::LoadFriction => law.friction.load_share = values[0],
            Self::ConstantLoad => law.weight.constant += values[0],
            Self::AngleLoad if scales.is_rotary => {
                law.weight.along = Periodic { sine: values[0], cosine: values[1], wavenumber: 1.0 };
                law.weight.constant += values[2];
            }
            Self::AngleLoad => law.weight.along = periodic(values),
            Self::Cogging => law.ripples.push(periodic(values)),
            Self::Ripples(_) => {
                values.chunks_exact(3).for_each(|one| Self::Cogging.apply(one, scales, law));
            }
            Self::EffortLimit => law.limit = EffortLimit::Sharp(values[0]),
            Self::SmoothLimit => law.limit = EffortLimit::Smooth(values[0]),
            Self::EffortLag => law.effort_lag_s = values[0],
            Self::Compliance(encoder) | Self::Play(encoder) => {
                let (play, friction_share) = match self {
                    Self::Play(_) => (values[3], values[4]),
                    _ => (0.0, values[3]),
                };
                let of_halves = OfHalves::new(*encoder, values[2]);
                let load_viscous = (of_halves.friction * friction_share).min(1.0) * law.viscous;
                law.viscous -= load_viscous;
                law.link = Some(Link {
                    stiffness: of_halves.stiffness * values[0],
                    damping: of_halves.stiffness * values[1],
                    load_share: values[2],
                    play: of_halves.play * play,
                    load_viscous,
                    encoder: *encoder,
                });
            }
            Self::ForceGain => law.force_gain_error = values[0],
            Self::ForceDelay => law.force_delay_s = values[0],
            Self::ToolInertia => law.tool_inertia = values[0],
            Self::LoadScale => law.load_scale = values[0],
            Self::Course { of, along, origin, spacing, .. } => {
                let curve = Curve { origin: *origin, spacing: *spacing, knots: values.to_vec() };
                law.course = Course { of: *of, along: *along, curve };
            }
            Self::Curve { origin, spacing, .. } => {
                law.curve = Curve { origin: *origin, spacing: *spacing, knots: values.to_vec() };
            }
        }
    }
}

fn periodic(values: &[f64]) -> Periodic {
    Periodic { sine: values[0], cosine: values[1], wavenumber: values[2] }
}

/// Of a pattern that repeats every `pitch`.
#[must_use]
pub fn wavenumber(pitch: f64) -> f64 {
    std::f64::consts::TAU / pitch
}

#[cfg(test)]
mod tests {
    use super::super::testing::SCALES;
    use super::*;

    #[test]
    fn friction_that_is_gone_in_motion_is_no_stribeck_friction() {
        let [speed, excess] = [0.1 * SCALES.speed, 0.1 * SCALES.effort];
        assert!(Term::Stribeck.is_at_end(&[0.0, excess, speed], &SCALES));
        assert!(!Term::Stribeck.is_at_end(&[0.5 * excess, excess, speed], &SCALES));
        // Without an excess it is Coulomb friction.
        assert!(Term::Stribeck.is_at_end(&[excess, 0.0, speed], &SCALES));
    }

    /// What the effort passes for more than a quarter of the time is no limit, nor is what it comes nowhere near.
    #[test]
    fn what_the_effort_usually_passes_is_no_limit() {
        for limit in [Term::EffortLimit, Term::SmoothLimit] {
            let lowest = SCALES.usual_effort * if limit == Term::SmoothLimit { 2.0 } else { 1.0 };
            let is_at_end = |value: f64| limit.is_at_end(&[value], &SCALES);
            assert!(is_at_end(lowest) && !is_at_end(1.05 * lowest));
            assert!(!is_at_end(0.98 * SCALES.peak_effort) && is_at_end(3.0 * SCALES.peak_effort));
        }
    }

    /// An excess whose level where it moves may be none is an encoder that stands still.
    #[test]
    fn a_stribeck_friction_whose_interval_holds_zero_is_not_shown() {
        let [level, excess, speed] = [[0.0, 0.3], [0.5, 0.6], [0.1 * SCALES.speed, 0.2 * SCALES.speed]];
        assert!(Term::Stribeck.is_undetermined(&[level, excess, speed], &SCALES));
        assert!(!Term::Stribeck.is_undetermined(&[[0.1, 0.3], excess, speed], &SCALES));
        assert!(Term::Stribeck.is_undetermined(&[[0.1, 0.3], [0.0, 0.6], speed], &SCALES));
        assert!(!Term::Coulomb.is_undetermined(&[[0.0, 0.3]], &SCALES));
    }

    /// A stiffness that is known to a factor of three either way may be none: what holds motor and load together is a damper, as of a wheel that slips.
    #[test]
    fn a_link_whose_stiffness_may_be_none_is_not_shown() {
        for side in [Side::Motor, Side::Load] {
            let link = Term::Compliance(side);
            let mut ends: Vec<[f64; 2]> = link.ranges(&SCALES).iter().map(|range| [range.low, range.high]).collect();
            let stiffness = 10.0 * ends[0][0];
            ends[2] = [0.4, 0.6];
            let mut within_a_factor_of = |factor: f64| {
                ends[0] = [stiffness / factor, stiffness * factor];
                !link.is_undetermined(&ends, &SCALES)
            };
            assert!(
                within_a_factor_of(1.1)
                    && within_a_factor_of(2.7)
                    && !within_a_factor_of(2.72)
                    && !within_a_factor_of(9.0)
            );
        }
    }

    /// Where the mass sits makes a link what it is; its damping and its friction do not.
    #[test]
    fn a_link_whose_share_of_the_mass_may_be_any_is_not_shown() {
        let link = Term::Compliance(Side::Motor);
        let whole: Vec<[f64; 2]> = link.ranges(&SCALES).iter().map(|range| [range.low, range.high]).collect();
        let told = |values: &[usize]| {
            let narrow = whole.iter().enumerate().map(|(at, [low, high])| {
                if values.contains(&at) { [low + 0.4 * (high - low), low + 0.6 * (high - low)] } else { [*low, *high] }
            });
            !link.is_undetermined(&narrow.collect::<Vec<_>>(), &SCALES)
        };
        assert!(told(&[0, 2]) && told(&[0, 1, 2, 3]));
        assert!(!told(&[0, 1, 3]) && !told(&[1, 2, 3]) && !told(&[]));
        // Seen from the load alone the share is not told, and not asked for.
        let mut from_load = whole.clone();
        from_load[0] = [1.1 * from_load[0][0], 2.0 * from_load[0][0]];
        assert!(!Term::Compliance(Side::Load).is_undetermined(&from_load, &SCALES));
        assert!(link.is_undetermined(&from_load, &SCALES));
        // From an end of the range to within it, something is told.
        let mut half = whole.clone();
        half[0] = [2.0 * half[0][0], 4.0 * half[0][0]];
        half[2][1] *= 0.9;
        assert!(!link.is_undetermined(&half, &SCALES));
    }
}
