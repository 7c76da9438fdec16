//! The concealed effects, one family a file: their parameters are drawn, and their size is found for a strength.

use std::fmt::Debug;

use rand::RngExt;

use crate::nominal::NominalParameters;
use crate::physics::RigModel;
use crate::rng::CaseRng;
use crate::scale::{Scale, Unit};

pub mod active_surface;
pub mod actuator;
pub mod adhesion;
pub mod cogging;
pub mod damping;
pub mod delay;
pub mod environment_mass;
pub mod external_push;
pub mod force_offset;
pub mod force_range;
pub mod force_resonance;
pub mod friction;
pub mod gravity;
pub mod hysteresis;
pub mod loose_contact;
pub mod lost_motion;
pub mod mains_hum;
pub mod periodic_force_error;
pub mod plastic_set;
pub mod position_dependent_friction;
pub mod registry;
pub mod stiffness;
pub mod stress_relaxation;
pub mod surface_motion;
pub mod thermal_wander;
pub mod time_varying_stiffness;
pub mod transmission;

/// Statistics of the trials without any effect, to which the drawn parameters are scaled.
#[derive(Debug, Clone, Copy)]
pub struct NominalMotion {
    /// The rig.
    pub nominal: NominalParameters,
    /// Deepest contact, m.
    pub depth: f64,
    /// Largest contact force, N.
    pub force: f64,
    /// Largest effort, N.
    pub effort: f64,
    /// RMS velocity in contact, m/s.
    pub speed: f64,
    /// Lowest and highest position, m.
    pub travel: (f64, f64),
    /// Of a trial, s.
    pub duration: f64,
    /// From bench scale to the scale of the case.
    pub scale: Scale,
}

/// The sizes that a shape can have; what they measure is its own.
#[derive(Debug, Clone, Copy)]
pub struct SizeRange {
    /// Nothing smaller can be simulated.
    pub smallest: f64,
    /// A good guess.
    pub initial: f64,
    /// Nothing larger is plausible.
    pub largest: f64,
}

impl SizeRange {
    /// Down to nothing, up to `largest`.
    #[must_use]
    pub fn new(initial: f64, largest: f64) -> Self {
        Self { smallest: 1e-6 * initial, initial, largest }
    }
}

/// A true value, at the size of a bench.
#[derive(Debug, Clone, Copy)]
pub struct EffectParameter {
    /// What it is.
    pub name: &'static str,
    /// In SI units.
    pub value: f64,
    /// Its dimension.
    pub unit: Unit,
}

impl EffectParameter {
    /// A value by name.
    #[must_use]
    pub fn new(name: &'static str, value: f64, unit: Unit) -> Self {
        Self { name, value, unit }
    }
}

/// An effect whose parameters are drawn except for its size.
pub trait EffectShape: Debug {
    /// The form of its equation, for the reader of the answers.
    fn form(&self) -> &'static str;
    /// Its possible sizes.
    fn size_range(&self) -> SizeRange;
    /// Its true values at `size`.
    fn parameters(&self, size: f64) -> Vec<EffectParameter>;
}

/// An effect that our own simulator has.
pub trait SimulatedEffect: EffectShape {
    /// Adds it, of a `size` above zero, to the model of a trial.
    fn apply(&self, size: f64, model: &mut RigModel);
}

/// The effect `name` with a shape at random; none where the name is unknown.
#[must_use]
pub fn draw(name: &str, motion: &NominalMotion, rng: &CaseRng) -> Option<Box<dyn SimulatedEffect>> {
    let rng = &mut effect_rng(name, rng);
    contact(name, motion, rng)
        .or_else(|| drive(name, motion, rng))
        .or_else(|| sensor(name, motion, rng))
        .or_else(|| outside(name, motion, rng))
}

/// The random numbers of the effect `name` alone: what is asked for first must not move what others draw.
#[must_use]
pub fn effect_rng(name: &str, rng: &CaseRng) -> CaseRng {
    let mut own = rng.clone();
    own.set_stream(64 + name.bytes().fold(0u64, |sum, byte| sum.wrapping_mul(131).wrapping_add(u64::from(byte))));
    own.random::<u64>();
    own
}

fn contact(name: &str, motion: &NominalMotion, rng: &mut CaseRng) -> Option<Box<dyn SimulatedEffect>> {
    Some(match name {
        "nonlinear_stiffness" => Box::new(stiffness::NonlinearStiffness::draw(motion, rng)),
        "layered_stiffness" => Box::new(stiffness::LayeredStiffness::draw(motion, rng)),
        "hunt_crossley_damping" => Box::new(damping::HuntCrossleyDamping::draw(motion, rng)),
        "quadratic_damping" => Box::new(damping::QuadraticDamping::draw(motion, rng)),
        "stress_relaxation" => Box::new(stress_relaxation::StressRelaxation::draw(motion, rng)),
        "hysteresis" => Box::new(hysteresis::Hysteresis::draw(motion, rng)),
        "plastic_set" => Box::new(plastic_set::PlasticSet::draw(motion, rng)),
        "adhesion" => Box::new(adhesion::Adhesion::draw(motion, rng)),
        "lost_motion" => Box::new(lost_motion::LostMotion::draw(motion, rng)),
        "time_varying_stiffness" => Box::new(time_varying_stiffness::TimeVaryingStiffness::draw(motion, rng)),
        "surface_motion" => Box::new(surface_motion::SurfaceMotion::draw(motion, rng)),
        "environment_mass" => Box::new(environment_mass::EnvironmentMass::draw(motion, rng)),
        _ => return None,
    })
}

fn drive(name: &str, motion: &NominalMotion, rng: &mut CaseRng) -> Option<Box<dyn SimulatedEffect>> {
    Some(match name {
        "coulomb_friction" => Box::new(friction::CoulombFriction::draw(motion, rng)),
        "stribeck_friction" => Box::new(friction::StribeckFriction::draw(motion, rng)),
        "load_dependent_friction" => Box::new(friction::LoadDependentFriction),
        "gravity_load" => Box::new(gravity::GravityLoad::draw(motion, rng)),
        "cogging" => Box::new(cogging::Cogging::draw(motion, rng)),
        "backlash" => Box::new(transmission::Backlash::draw(motion, rng)),
        "transmission_compliance" => Box::new(transmission::TransmissionCompliance::draw(motion, rng)),
        "effort_saturation" => Box::new(actuator::EffortSaturation::draw(motion)),
        "effort_lag" => Box::new(actuator::EffortLag),
        _ => return None,
    })
}

fn sensor(name: &str, motion: &NominalMotion, rng: &mut CaseRng) -> Option<Box<dyn SimulatedEffect>> {
    Some(match name {
        "force_bias" => Box::new(force_offset::ForceBias::draw(motion, rng)),
        "force_drift" => Box::new(force_offset::ForceDrift::draw(motion, rng)),
        "tool_inertia" => Box::new(delay::ToolInertia { mass: motion.nominal.mass }),
        "channel_delay" => Box::new(delay::ChannelDelay),
        "force_lag" => Box::new(delay::ForceLag),
        "force_saturation" => Box::new(force_range::ForceSaturation::draw(motion, rng)),
        "force_gain" => Box::new(force_range::ForceGain::draw(rng)),
        "mains_hum" => Box::new(mains_hum::MainsHum::draw(motion, rng)),
        _ => return None,
    })
}

fn outside(name: &str, motion: &NominalMotion, rng: &mut CaseRng) -> Option<Box<dyn SimulatedEffect>> {
    Some(match name {
        "force_resonance" => Box::new(force_resonance::ForceResonance::draw(rng)),
        "effort_crosstalk" => Box::new(force_resonance::EffortCrosstalk::draw(motion)),
        "thermal_wander" => Box::new(thermal_wander::ThermalWander::draw(motion, rng)),
        "signed_damping" => Box::new(position_dependent_friction::SignedDamping::draw(motion, rng)),
        "sticky_spots" => Box::new(position_dependent_friction::StickySpots::draw(motion, rng)),
        "outside_pushes" => Box::new(external_push::ExternalPush::draw(motion, rng)),
        "buckling" => Box::new(stiffness::Buckling::draw(motion, rng)),
        "heartbeat" => Box::new(active_surface::Heartbeat::draw(motion, rng)),
        "reflex" => Box::new(active_surface::Reflex::draw(motion, rng)),
        "periodic_force_error" => Box::new(periodic_force_error::PeriodicForceError::draw(motion, rng)),
        "loose_contact" => Box::new(loose_contact::LooseContact::draw(motion, rng)),
        _ => return None,
    })
}
