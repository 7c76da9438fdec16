//! The drive's law of motion: a mass and viscous friction, and everything that can be there beside them.
//!
//! inertia a = effort - force - viscous v - load(x) - sign(v) dry(|v|, force + weight(x)) + disturbance

pub use crate::rig::TransmissionSide as Side;

use super::course::Course;
use super::curve::Curve;
use super::dry_friction::DryFriction;
use super::effort_limit::EffortLimit;
use super::presliding::{Slips, Step};
use super::viscous_motion::ViscousMotion;

/// What lies between motor and load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// N/m or N m/rad.
    pub stiffness: f64,
    /// N s/m or N m s/rad.
    pub damping: f64,
    /// Total play, m or rad; zero where there is none.
    pub play: f64,
    /// Share of the whole inertia on the load's side, 0 to 1.
    pub load_share: f64,
    /// Viscous friction on the load's side, beside that of the law, which acts on the motor, N s/m or N m s/rad.
    pub load_viscous: f64,
    /// Which side the encoder measures.
    pub encoder: Side,
}

impl Link {
    /// Force through the link, positive when the motor pushes the load: `ahead` is the motor's lead, `rate` its rate. In the play
    /// nothing passes.
    #[must_use]
    pub fn transmitted(&self, ahead: f64, rate: f64) -> f64 {
        let stretch = ahead - ahead.clamp(-0.5 * self.play, 0.5 * self.play);
        if self.play > 0.0 && stretch == 0.0 { 0.0 } else { self.stiffness * stretch + self.damping * rate }
    }
}

/// A load that repeats along the way: sine sin(k x) + cosine cos(k x).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Periodic {
    /// N or N m.
    pub sine: f64,
    /// N or N m.
    pub cosine: f64,
    /// rad/m, or periods a turn.
    pub wavenumber: f64,
}

impl Periodic {
    fn at(&self, position: f64) -> f64 {
        let (sine, cosine) = (self.wavenumber * position).sin_cos();
        self.sine * sine + self.cosine * cosine
    }
}

/// What the axis carries: constant + sine sin(k x) + cosine cos(k x).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Weight {
    /// N or N m.
    pub constant: f64,
    /// What changes with the position.
    pub along: Periodic,
}

impl Weight {
    fn at(&self, position: f64) -> f64 {
        self.constant + self.along.at(position)
    }
}

/// What acts on a body through a step.
#[derive(Debug, Clone, Copy)]
pub struct Acting {
    /// Everything that does not depend on the motion, N or N m.
    pub push: f64,
    /// What is borne beside the weight of the law, N or N m: friction can grow with it.
    pub borne: f64,
    /// What dry friction is multiplied by.
    pub friction_factor: f64,
    /// What viscous friction is multiplied by.
    pub viscous_factor: f64,
}

/// The law with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveLaw {
    /// Everything that moves, kg or kg m^2.
    pub inertia: f64,
    /// N s/m or N m s/rad.
    pub viscous: f64,
    /// By how much the effort acts later than it is recorded, s; may be a part of a row, early or late.
    pub effort_delay_s: f64,
    /// How much the effort is averaged where it is recorded, rows^2: what acts is the record less so many of its second differences. Zero: each
    /// row is what acts until the next; a quarter: the mean of what acts before and after its row.
    pub effort_averaging: f64,
    /// First-order lag of the effort, s.
    pub effort_lag_s: f64,
    /// How the effort ends.
    pub limit: EffortLimit,
    /// What the given load is multiplied by.
    pub load_scale: f64,
    /// Dry friction, on the motor's side.
    pub friction: DryFriction,
    /// How friction or effort changes, of no law.
    pub course: Course,
    /// Half of the difference between friction forward and backward, N or N m.
    pub offset: f64,
    /// What the axis carries; dry friction can grow with it.
    pub weight: Weight,
    /// Cogging.
    pub ripples: Vec<Periodic>,
    /// Load by position, of no law.
    pub curve: Curve,
    /// What the force sensor shows too much, as a share of the force.
    pub force_gain_error: f64,
    /// By how much the force is recorded later than it acts, s.
    pub force_delay_s: f64,
    /// Mass beyond the force sensor, which the sensor feels and the drive moves, kg or kg m^2.
    pub tool_inertia: f64,
    /// What lies between motor and load; `None`: nothing that gives.
    pub link: Option<Link>,
}

/// Turns of the direction that are followed within a row: more is chatter, and ends at rest.
const TURNS_PER_ROW: usize = 3;

impl DriveLaw {
    /// Mass and viscous friction alone.
    #[must_use]
    pub fn nominal(inertia: f64, viscous: f64, effort_delay_s: f64) -> Self {
        Self {
            inertia,
            viscous,
            effort_delay_s,
            effort_averaging: 0.0,
            effort_lag_s: 0.0,
            limit: EffortLimit::None,
            load_scale: 1.0,
            friction: DryFriction::NONE,
            course: Course::default(),
            offset: 0.0,
            weight: Weight::default(),
            ripples: Vec::new(),
            curve: Curve::default(),
            force_gain_error: 0.0,
            force_delay_s: 0.0,
            tool_inertia: 0.0,
            link: None,
        }
    }

    /// Load that depends on the position alone, N or N m.
    #[must_use]
    pub fn load(&self, position: f64) -> f64 {
        let ripples = self.ripples.iter().map(|ripple| ripple.at(position)).sum::<f64>();
        self.offset + self.weight.at(position) + self.curve.at(position) + ripples
    }

    /// What dry friction grows with at `position` where `borne` acts beside the weight, N or N m.
    #[must_use]
    pub fn borne(&self, borne: f64, position: f64) -> f64 {
        if self.friction.load_share == 0.0 { borne } else { borne + self.weight.at(position) }
    }

    /// Position and velocity of one body of `inertia` after `step` seconds under what is `acting`; `slips` is what friction remembers of
    /// the way, where it builds up over one. Viscous friction is exact, and other friction that of the step's middle; a turn is
    /// met at its instant, and there the body stays where friction can hold it.
    #[must_use]
    pub fn advance(&self, state: [f64; 2], slips: &mut Slips, acting: &Acting, inertia: f64, step: f64) -> [f64; 2] {
        let [mut position, mut velocity] = state;
        let Acting { push, borne, friction_factor, viscous_factor } = *acting;
        let viscous = viscous_factor * self.viscous;
        let middle = position + 0.5 * step * velocity;
        let (push, borne) = (push - self.load(middle), self.borne(borne, middle));
        let damping = viscous / inertia;
        if !self.friction.acts() {
            let [way, after] = ViscousMotion::new(velocity, push / inertia, damping).after(step);
            return [position + way, after];
        }
        if self.friction.presliding > 0.0 {
            let level = friction_factor * self.friction.level(velocity.abs(), borne);
            let step = Step { velocity, push, viscous, inertia, duration: step };
            let [way, after] = slips.advance(level, self.friction.presliding, &step);
            return [position + way, after];
        }
        let level = |speed: f64| friction_factor * self.friction.level(speed, borne);
        let mut left = step;
        for _ in 0..TURNS_PER_ROW {
            let Some(direction) = Self::direction(velocity, push, || level(0.0)) else { return [position, 0.0] };
            let motion = |speed: f64| {
                let acceleration = (push - direction * level(speed)) / inertia;
                ViscousMotion::new(velocity, acceleration, damping)
            };
            let [_, middle] = motion(velocity.abs()).after(0.5 * left);
            let motion = motion(if middle * direction < 0.0 { 0.0 } else { middle.abs() });
            let [way, after] = motion.after(left);
            if after * direction >= 0.0 {
                return [position + way, after];
            }
            if velocity == 0.0 {
                return [position, 0.0];
            }
            let turn = motion.stops_after().clamp(0.0, left);
            position += motion.after(turn)[0];
            left -= turn;
            velocity = 0.0;
        }
        [position, 0.0]
    }

    /// Which way the body goes; `None` where friction holds it at rest, up to what it `holds`.
    fn direction(velocity: f64, push: f64, holds: impl FnOnce() -> f64) -> Option<f64> {
        if velocity != 0.0 {
            return Some(velocity.signum());
        }
        (push.abs() > holds()).then(|| push.signum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rubbing(coulomb: f64) -> DriveLaw {
        let mut law = DriveLaw::nominal(2.0, 0.0, 0.0);
        law.friction.coulomb = coulomb;
        law
    }

    fn pushed(push: f64) -> Acting {
        Acting { push, borne: 0.0, friction_factor: 1.0, viscous_factor: 1.0 }
    }

    #[test]
    fn friction_holds_what_is_below_it_and_brakes_what_is_above() {
        let law = rubbing(1.0);
        assert_eq!(law.advance([0.3, 0.0], &mut Slips::default(), &pushed(0.99), 2.0, 0.01), [0.3, 0.0]);
        assert_eq!(law.advance([0.3, 0.0], &mut Slips::default(), &pushed(-0.99), 2.0, 0.01), [0.3, 0.0]);
        let [_, velocity] = law.advance([0.3, 0.0], &mut Slips::default(), &pushed(1.5), 2.0, 0.01);
        assert!((velocity - 0.01 * 0.5 / 2.0).abs() < 1e-15);
    }

    /// A fifth of what is borne: the weight of 3 N downhill at a quarter of a turn, where nothing is borne beside it, and with 1 N on top.
    #[test]
    fn friction_grows_with_the_weight_where_the_body_is() {
        let mut law = DriveLaw::nominal(2.0, 0.0, 0.0);
        law.friction.load_share = 0.2;
        law.weight.along = Periodic { sine: 3.0, cosine: 0.0, wavenumber: 1.0 };
        let holds = |at: f64, borne: f64, push: f64| {
            let acting = Acting { borne, ..pushed(push) };
            law.advance([at, 0.0], &mut Slips::default(), &acting, 2.0, 0.01) == [at, 0.0]
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!(holds(quarter, 0.0, 3.0 + 0.599) && !holds(quarter, 0.0, 3.0 + 0.601));
        assert!(holds(quarter, 1.0, 3.0 - 0.799) && !holds(quarter, 1.0, 3.0 - 0.801));
        assert!(holds(0.0, 0.0, 0.0) && !holds(0.0, 0.0, 1e-9));
    }

    #[test]
    fn a_body_comes_to_rest_at_the_instant_of_physics_and_stays() {
        // 1 N against 2 kg at 2 mm/s: rest after 4 ms and 4 um, the rest of the step does nothing.
        let [position, velocity] = rubbing(1.0).advance([0.0, 2e-3], &mut Slips::default(), &pushed(0.0), 2.0, 0.01);
        assert_eq!(velocity, 0.0);
        assert!((position - 4e-6).abs() < 1e-18);
    }

    #[test]
    fn a_turn_within_a_step_goes_on_the_other_way_with_friction_against_it() {
        // -3 N: to rest against 4 N (friction helps) in 1 ms, then back with 2 N for 9 ms.
        let [_, velocity] = rubbing(1.0).advance([0.0, 2e-3], &mut Slips::default(), &pushed(-3.0), 2.0, 0.01);
        assert!((velocity + 9e-3 * 2.0 / 2.0).abs() < 1e-15);
    }

    #[test]
    fn viscous_friction_alone_decays_by_the_exponential() {
        let law = DriveLaw::nominal(0.8, 4.0, 0.0);
        // However long a row is beside the time in which the friction stops the body.
        for step in [1e-3, 0.1, 2.0] {
            let [position, velocity] = law.advance([0.0, 1.0], &mut Slips::default(), &pushed(0.0), 0.8, step);
            let decay = (-5.0 * step).exp();
            assert!((velocity - decay).abs() < 1e-14 && (position - (1.0 - decay) / 5.0).abs() < 1e-14);
        }
    }

    #[test]
    fn nothing_passes_a_play_and_beyond_it_a_spring_from_its_end() {
        let link = Link {
            stiffness: 100.0,
            damping: 2.0,
            play: 0.02,
            load_share: 0.5,
            load_viscous: 0.0,
            encoder: Side::Motor,
        };
        assert_eq!(link.transmitted(0.009, 5.0), 0.0);
        assert!((link.transmitted(0.03, 1.0) - (100.0 * 0.02 + 2.0)).abs() < 1e-12);
        assert!((link.transmitted(-0.03, 0.0) + 100.0 * 0.02).abs() < 1e-12);
    }
}
