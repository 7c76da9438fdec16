//! Which effects each simulator has of its own.

use crate::effect::name::{ELSEWHERE, Known, contact, drive, sensor};
use crate::world::{Offer, Source};

/// MuJoCo: soft constraints, joint friction, tendons, actuator dynamics, a force sensor with a range and a delay.
const MUJOCO: [Known; 11] = [
    drive("coulomb_friction"),
    drive("gravity_load"),
    drive("transmission_compliance"),
    drive("backlash"),
    drive("effort_saturation"),
    drive("effort_lag"),
    sensor("tool_inertia"),
    sensor("channel_delay"),
    sensor("force_saturation"),
    contact("environment_mass", false),
    ELSEWHERE[0],
];

/// Drake: compliant point contact, friction of a shoe on a plane, a weld that feels.
const DRAKE: [Known; 6] = [
    contact("hunt_crossley_damping", false),
    drive("coulomb_friction"),
    drive("gravity_load"),
    drive("transmission_compliance"),
    drive("effort_saturation"),
    sensor("tool_inertia"),
];

/// Exudyn: contacts with an exponent, bristles with Stribeck's curve, limit stops.
const EXUDYN: [Known; 6] = [
    contact("nonlinear_stiffness", false),
    drive("coulomb_friction"),
    drive("stribeck_friction"),
    drive("gravity_load"),
    drive("transmission_compliance"),
    drive("backlash"),
];

/// The offer of `source`.
#[must_use]
pub fn of(source: Source) -> Offer {
    // The weight of what hangs beyond a force sensor is a bias of it, and what hangs there is part of the tool, which a
    // compliant transmission leaves light.
    match source {
        Source::Own => Offer::OWN,
        Source::Mujoco => Offer {
            effects: &MUJOCO,
            apart: &[
                ["gravity_load", "tool_inertia"],
                ["transmission_compliance", "tool_inertia"],
                ["backlash", "tool_inertia"],
                ["backlash", "transmission_compliance"],
            ],
        },
        Source::Drake => Offer {
            effects: &DRAKE,
            apart: &[["gravity_load", "tool_inertia"], ["transmission_compliance", "tool_inertia"]],
        },
        Source::Exudyn => Offer { effects: &EXUDYN, apart: Offer::OWN.apart },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::name::{Acts, known};

    #[test]
    fn what_is_offered_acts_where_our_own_does() {
        for source in Source::ALL {
            for offered in of(source).effects {
                let ours = known(offered.name).unwrap();
                assert_eq!((offered.acts, offered.listed), (ours.acts, ours.listed), "{}", offered.name);
                assert_eq!(offered.needs_effort, offered.acts == Acts::Drive || offered.name == "force_gain");
            }
        }
    }
}
