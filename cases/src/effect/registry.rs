//! Every effect by name, and where it shows.

use serde::Serialize;

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ActsIn {
    /// In what the surface answers.
    Contact,
    /// Between the motor and the tool: it shows in the effort alone.
    Drive,
    /// In the force sensor.
    Sensor,
}

/// One effect that a case can hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectInfo {
    /// Its name.
    pub name: &'static str,
    /// Where it acts.
    pub acts_in: ActsIn,
    /// Among the effects that a diagnosis can name.
    pub listed: bool,
    /// It is there, and means the same, where the tool is clamped to its environment.
    pub bilateral: bool,
    /// It shows in the balance of the drive or not at all.
    pub needs_effort: bool,
}

pub(crate) const fn contact(name: &'static str, bilateral: bool) -> EffectInfo {
    EffectInfo { name, acts_in: ActsIn::Contact, listed: true, bilateral, needs_effort: false }
}

pub(crate) const fn drive(name: &'static str) -> EffectInfo {
    EffectInfo { name, acts_in: ActsIn::Drive, listed: true, bilateral: true, needs_effort: true }
}

pub(crate) const fn sensor(name: &'static str) -> EffectInfo {
    EffectInfo { name, acts_in: ActsIn::Sensor, listed: true, bilateral: true, needs_effort: false }
}

pub(crate) const fn outside(name: &'static str, acts_in: ActsIn) -> EffectInfo {
    let bilateral = !matches!(acts_in, ActsIn::Contact);
    EffectInfo { name, acts_in, listed: false, bilateral, needs_effort: matches!(acts_in, ActsIn::Drive) }
}

/// All of our own simulation.
pub const ALL: [EffectInfo; 40] = [
    contact("nonlinear_stiffness", true),
    contact("layered_stiffness", false),
    contact("hunt_crossley_damping", false),
    contact("quadratic_damping", true),
    contact("stress_relaxation", true),
    contact("hysteresis", true),
    contact("plastic_set", false),
    contact("adhesion", false),
    contact("lost_motion", true),
    contact("time_varying_stiffness", true),
    contact("surface_motion", true),
    contact("environment_mass", true),
    drive("coulomb_friction"),
    drive("stribeck_friction"),
    drive("load_dependent_friction"),
    drive("gravity_load"),
    drive("cogging"),
    drive("backlash"),
    drive("transmission_compliance"),
    drive("effort_saturation"),
    drive("effort_lag"),
    EffectInfo { needs_effort: true, ..sensor("force_gain") },
    // Clamped to a spring, a bias of the force is a shift of the spring.
    EffectInfo { bilateral: false, ..sensor("force_bias") },
    sensor("force_drift"),
    sensor("tool_inertia"),
    sensor("channel_delay"),
    sensor("force_lag"),
    sensor("force_saturation"),
    sensor("mains_hum"),
    outside("force_resonance", ActsIn::Sensor),
    outside("effort_crosstalk", ActsIn::Sensor),
    outside("thermal_wander", ActsIn::Sensor),
    outside("signed_damping", ActsIn::Drive),
    outside("sticky_spots", ActsIn::Drive),
    outside("outside_pushes", ActsIn::Drive),
    outside("buckling", ActsIn::Contact),
    outside("heartbeat", ActsIn::Contact),
    outside("reflex", ActsIn::Contact),
    outside("periodic_force_error", ActsIn::Sensor),
    outside("loose_contact", ActsIn::Sensor),
];

/// Outside of the list, and in the simulations of others alone.
pub const EXTERNAL_ONLY: [EffectInfo; 1] = [outside("soft_constraint", ActsIn::Contact)];

/// The effect `name`.
#[must_use]
pub fn find(name: &str) -> Option<&'static EffectInfo> {
    ALL.iter().chain(&EXTERNAL_ONLY).find(|known| known.name == name)
}
