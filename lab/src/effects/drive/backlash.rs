//! Play between motor and tool.

use super::two_mass_link::{FRICTION_SHARE, MOTOR_SHARE, TwoMassLink};
use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start, linear,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Backlash;

const GAP: Parameter = Parameter::new("gap", Word::new("m", "rad"), "whole width of the play", 0.0, f64::INFINITY);

const LINK_STIFFNESS: Parameter = Parameter::fixed(
    "link_stiffness",
    Word::new("N/m", "N m/rad"),
    "of the flanks, in a simulation: as stiff as the recording could not tell from rigid",
);

static SPEC: EffectSpec = EffectSpec {
    name: "backlash",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
    statement: "Between motor and tool there is play: after a reversal the motor runs free before it takes the tool along",
    forms: &[
        Form {
            name: "two_masses",
            equation: "m1 d2y/dt2 = effort - T, m1 = motor_share m; T = 0 while |y - x| < gap/2, a stiff damped link beyond; (m - m1) a + b v = T - F",
            parameters: &[GAP, MOTOR_SHARE, LINK_STIFFNESS],
        },
        Form {
            name: "friction_on_both_sides",
            equation: "m1 d2y/dt2 + b1 v_y = effort - T, m1 = motor_share m, b1 = friction_share b; T = 0 while |y - x| < gap/2, a stiff damped link beyond; (m - m1) a + (b - b1) v = T - F",
            parameters: &[GAP, MOTOR_SHARE, LINK_STIFFNESS, FRICTION_SHARE],
        },
    ],
    excited_by: "reversals of the effort, in free motion and in contact",
    resembles: &["coulomb_friction", "transmission_compliance", "lost_motion"],
    source: "M. Nordin, P.-O. Gutman, Automatica 38 (2002) 1633",
};

/// Swings of the flanks, over those of the slowest link that can be identified: stiff beside all that a recording shows.
const FLANK_RATE_RATIO: f64 = 2.2;

impl Effect for Backlash {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // Without a force sensor nothing tells which side of the teeth bears.
        if !scene.has_force {
            return Vec::new();
        }
        let (way, pulse) = (scene.travel.1 - scene.travel.0, FLANK_RATE_RATIO * scene.min_link_rate());
        let start = |share: f64| {
            Start::sized(&[0.01 * way, share, share * scene.inertia * pulse * pulse, 0.5][..3 + form], &[0])
        };
        linear(0.1, 0.79, 8).into_iter().map(start).collect()
    }

    fn act_on_drive(&self, form: usize, values: &[f64], state: &mut EffectState, push: &mut DriveState) {
        // Flanks that ring three times.
        let motor = values[1] * push.inertia;
        let damping = 0.6 * (values[2] * motor).max(0.0).sqrt();
        let viscous = if form == 0 { 0.0 } else { values[3] * push.viscous };
        TwoMassLink { stiffness: values[2], damping, inertia: motor, viscous, gap: values[0] }.carry(state, push);
    }
}
