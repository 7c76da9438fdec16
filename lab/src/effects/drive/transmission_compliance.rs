//! A cable, belt or gear that gives.

use super::two_mass_link::{FRICTION_SHARE, MOTOR_SHARE, TwoMassLink};
use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Parameter, Place, Stage, Start, geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct TransmissionCompliance;

const LINK_STIFFNESS: Parameter = Parameter::new(
    "link_stiffness",
    Word::new("N/m", "N m/rad"),
    "of cable, belt or gear, at the tool",
    0.0,
    f64::INFINITY,
);

/// Largest damping ratio of a link: beyond it the damper alone acts within any time that a spring has, and what slips or is dragged along is no link.
pub const MOST_DAMPING_RATIO: f64 = 5.0;

const DAMPING_RATIO: Parameter = Parameter::new(
    "damping_ratio",
    Word::same("1"),
    "of the link, one where it stops ringing",
    0.0,
    MOST_DAMPING_RATIO,
);

static SPEC: EffectSpec = EffectSpec {
    name: "transmission_compliance",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
    statement: "Between motor and tool something gives: the two do not move as one",
    forms: &[
        Form {
            name: "two_masses",
            equation: "m1 d2y/dt2 = effort - T, m1 = motor_share m, T = link_stiffness (y - x) + c (v_y - v), c = 2 damping_ratio sqrt(link_stiffness m1); (m - m1) a + b v = T - F",
            parameters: &[LINK_STIFFNESS, MOTOR_SHARE, DAMPING_RATIO],
        },
        Form {
            name: "friction_on_both_sides",
            equation: "m1 d2y/dt2 + b1 v_y = effort - T, m1 = motor_share m, b1 = friction_share b, T = link_stiffness (y - x) + c (v_y - v), c = 2 damping_ratio sqrt(link_stiffness m1); (m - m1) a + (b - b1) v = T - F",
            parameters: &[LINK_STIFFNESS, MOTOR_SHARE, DAMPING_RATIO, FRICTION_SHARE],
        },
    ],
    excited_by: "quick changes of effort, frequencies near the resonance",
    resembles: &["effort_lag", "backlash"],
    source: "W. J. Book, J. Dyn. Syst. Meas. Control 115 (1993) 252: the two-mass drive",
};

impl Effect for TransmissionCompliance {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // Without a force sensor nothing but the noise of the acceleration stands against a hidden motor.
        if !scene.has_force {
            return Vec::new();
        }
        let mut starts = Vec::new();
        for pulse in geometric(1.05 * scene.min_link_rate(), 5.0 * scene.min_link_rate(), 6) {
            for share in [0.2, 0.6] {
                let values = [scene.inertia * pulse * pulse, share, 0.05, 0.5];
                starts.push(Start::at(&values[..3 + form]));
            }
        }
        starts
    }

    fn act_on_drive(&self, form: usize, values: &[f64], state: &mut EffectState, push: &mut DriveState) {
        let motor = values[1] * push.inertia;
        let viscous = if form == 0 { 0.0 } else { values[3] * push.viscous };
        let damping = 2.0 * values[2] * (values[0] * motor).max(0.0).sqrt();
        TwoMassLink { stiffness: values[0], damping, inertia: motor, viscous, gap: 0.0 }.carry(state, push);
    }
}
