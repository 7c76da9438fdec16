//! Which effects each simulator has of its own.

use crate::effect::registry::{EXTERNAL_ONLY, EffectInfo, contact, drive, sensor};
use crate::simulator::{SimulatorKind, SupportedEffects};

/// MuJoCo: soft constraints, joint friction, tendons, actuator dynamics, a force sensor with a range and a delay.
const MUJOCO: [EffectInfo; 11] = [
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
    EXTERNAL_ONLY[0],
];

/// Drake: compliant point contact, friction of a shoe on a plane, a weld that feels.
const DRAKE: [EffectInfo; 6] = [
    contact("hunt_crossley_damping", false),
    drive("coulomb_friction"),
    drive("gravity_load"),
    drive("transmission_compliance"),
    drive("effort_saturation"),
    sensor("tool_inertia"),
];

/// Exudyn: contacts with an exponent, bristles with Stribeck's curve, limit stops.
const EXUDYN: [EffectInfo; 6] = [
    contact("nonlinear_stiffness", false),
    drive("coulomb_friction"),
    drive("stribeck_friction"),
    drive("gravity_load"),
    drive("transmission_compliance"),
    drive("backlash"),
];

/// The offer of `source`.
#[must_use]
pub fn effects_of(source: SimulatorKind) -> SupportedEffects {
    // The weight of what hangs beyond a force sensor is a bias of it, and what hangs there is part of the tool, which a
    // compliant transmission leaves light.
    match source {
        SimulatorKind::Own => SupportedEffects::OWN,
        SimulatorKind::Mujoco => SupportedEffects {
            effects: &MUJOCO,
            incompatible: &[
                ["gravity_load", "tool_inertia"],
                ["transmission_compliance", "tool_inertia"],
                ["backlash", "tool_inertia"],
                ["backlash", "transmission_compliance"],
            ],
        },
        SimulatorKind::Drake => SupportedEffects {
            effects: &DRAKE,
            incompatible: &[["gravity_load", "tool_inertia"], ["transmission_compliance", "tool_inertia"]],
        },
        SimulatorKind::Exudyn => {
            SupportedEffects { effects: &EXUDYN, incompatible: SupportedEffects::OWN.incompatible }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::registry::{ActsIn, find};

    #[test]
    fn what_is_offered_acts_where_our_own_does() {
        for source in SimulatorKind::ALL {
            for offered in effects_of(source).effects {
                let ours = find(offered.name).unwrap();
                assert_eq!((offered.acts_in, offered.listed), (ours.acts_in, ours.listed), "{}", offered.name);
                assert_eq!(offered.needs_effort, offered.acts_in == ActsIn::Drive || offered.name == "force_gain");
            }
        }
    }
}
