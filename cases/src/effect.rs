//! The concealed physics, one family a file: a shape is drawn, and its size is found for a strength.

use std::fmt::Debug;

use rand::RngExt;

use crate::chance::Chance;
use crate::nominal::Nominal;
use crate::physics::Physics;
use crate::scale::{Scale, Unit};

pub mod actuator;
pub mod adhesion;
pub mod cogging;
pub mod damping;
pub mod delay;
pub mod elastic;
pub mod friction;
pub mod glitch;
pub mod gravity;
pub mod hum;
pub mod hysteresis;
pub mod lost_motion;
pub mod name;
pub mod offset;
pub mod plasticity;
pub mod pulse;
pub mod pushes;
pub mod range;
pub mod relaxation;
pub mod ringing;
pub mod ripple;
pub mod softening;
pub mod spots;
pub mod surface;
pub mod tissue;
pub mod transmission;
pub mod wander;

/// What a trial without any effect is like: shapes are drawn to suit it.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    /// The rig.
    pub nominal: Nominal,
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
    /// From the bench to the case.
    pub scale: Scale,
}

/// The sizes that a shape can have; what they measure is its own.
#[derive(Debug, Clone, Copy)]
pub struct Sizes {
    /// Nothing smaller can be simulated.
    pub smallest: f64,
    /// A good guess.
    pub first: f64,
    /// Nothing larger is plausible.
    pub largest: f64,
}

impl Sizes {
    /// Down to nothing, up to `largest`.
    #[must_use]
    pub fn new(first: f64, largest: f64) -> Self {
        Self { smallest: 1e-6 * first, first, largest }
    }
}

/// A true value, at the size of a bench.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// What it is.
    pub name: &'static str,
    /// In SI units.
    pub value: f64,
    /// Its dimension.
    pub unit: Unit,
}

impl Parameter {
    /// A value by name.
    #[must_use]
    pub fn new(name: &'static str, value: f64, unit: Unit) -> Self {
        Self { name, value, unit }
    }
}

/// An effect with all of its shape drawn but its size.
pub trait Shape: Debug {
    /// The form of its equation, for the reader of the answers.
    fn form(&self) -> &'static str;
    /// Its possible sizes.
    fn sizes(&self) -> Sizes;
    /// Its true values at `size`.
    fn parameters(&self, size: f64) -> Vec<Parameter>;
}

/// A shape that our own simulation can act out.
pub trait Acting: Shape {
    /// Adds it, of a `size` above zero, to the physics of a trial.
    fn put(&self, size: f64, physics: &mut Physics);
}

/// The effect `name` with a shape at random; none where the name is unknown.
#[must_use]
pub fn draw(name: &str, scene: &Scene, chance: &Chance) -> Option<Box<dyn Acting>> {
    let chance = &mut own_chance(name, chance);
    contact(name, scene, chance)
        .or_else(|| drive(name, scene, chance))
        .or_else(|| sensor(name, scene, chance))
        .or_else(|| outside(name, scene, chance))
}

/// The random numbers of the effect `name` alone: what is asked for first must not move what others draw.
#[must_use]
pub fn own_chance(name: &str, chance: &Chance) -> Chance {
    let mut own = chance.clone();
    own.set_stream(64 + name.bytes().fold(0u64, |sum, byte| sum.wrapping_mul(131).wrapping_add(u64::from(byte))));
    own.random::<u64>();
    own
}

fn contact(name: &str, scene: &Scene, chance: &mut Chance) -> Option<Box<dyn Acting>> {
    Some(match name {
        "nonlinear_stiffness" => Box::new(elastic::Nonlinear::draw(scene, chance)),
        "layered_stiffness" => Box::new(elastic::Layered::draw(scene, chance)),
        "hunt_crossley_damping" => Box::new(damping::HuntCrossley::draw(scene, chance)),
        "quadratic_damping" => Box::new(damping::Quadratic::draw(scene, chance)),
        "stress_relaxation" => Box::new(relaxation::Relaxation::draw(scene, chance)),
        "hysteresis" => Box::new(hysteresis::Hysteresis::draw(scene, chance)),
        "plastic_set" => Box::new(plasticity::PlasticSet::draw(scene, chance)),
        "adhesion" => Box::new(adhesion::Adhesion::draw(scene, chance)),
        "lost_motion" => Box::new(lost_motion::LostMotion::draw(scene, chance)),
        "time_varying_stiffness" => Box::new(softening::Softening::draw(scene, chance)),
        "surface_motion" => Box::new(surface::Surface::draw(scene, chance)),
        "environment_mass" => Box::new(tissue::EnvironmentMass::draw(scene, chance)),
        _ => return None,
    })
}

fn drive(name: &str, scene: &Scene, chance: &mut Chance) -> Option<Box<dyn Acting>> {
    Some(match name {
        "coulomb_friction" => Box::new(friction::Coulomb::draw(scene, chance)),
        "stribeck_friction" => Box::new(friction::Slowing::draw(scene, chance)),
        "load_dependent_friction" => Box::new(friction::LoadDependent),
        "gravity_load" => Box::new(gravity::GravityLoad::draw(scene, chance)),
        "cogging" => Box::new(cogging::Teeth::draw(scene, chance)),
        "backlash" => Box::new(transmission::Backlash::draw(scene, chance)),
        "transmission_compliance" => Box::new(transmission::Compliance::draw(scene, chance)),
        "effort_saturation" => Box::new(actuator::EffortSaturation::draw(scene)),
        "effort_lag" => Box::new(actuator::EffortLag),
        _ => return None,
    })
}

fn sensor(name: &str, scene: &Scene, chance: &mut Chance) -> Option<Box<dyn Acting>> {
    Some(match name {
        "force_bias" => Box::new(offset::ForceBias::draw(scene, chance)),
        "force_drift" => Box::new(offset::ForceDrift::draw(scene, chance)),
        "tool_inertia" => Box::new(delay::ToolInertia { mass: scene.nominal.mass }),
        "channel_delay" => Box::new(delay::ChannelDelay),
        "force_lag" => Box::new(delay::ForceLag),
        "force_saturation" => Box::new(range::ForceSaturation::draw(scene, chance)),
        "force_gain" => Box::new(range::ForceGain::draw(chance)),
        "mains_hum" => Box::new(hum::MainsHum::draw(scene, chance)),
        _ => return None,
    })
}

fn outside(name: &str, scene: &Scene, chance: &mut Chance) -> Option<Box<dyn Acting>> {
    Some(match name {
        "force_resonance" => Box::new(ringing::Resonance::draw(chance)),
        "effort_crosstalk" => Box::new(ringing::Crosstalk::draw(scene)),
        "thermal_wander" => Box::new(wander::ThermalWander::draw(scene, chance)),
        "signed_damping" => Box::new(spots::SignedDamping::draw(scene, chance)),
        "sticky_spots" => Box::new(spots::StickySpots::draw(scene, chance)),
        "outside_pushes" => Box::new(pushes::Pushing::draw(scene, chance)),
        "buckling" => Box::new(elastic::Buckling::draw(scene, chance)),
        "heartbeat" => Box::new(pulse::Beating::draw(scene, chance)),
        "reflex" => Box::new(pulse::Answering::draw(scene, chance)),
        "periodic_force_error" => Box::new(ripple::PeriodicError::draw(scene, chance)),
        "loose_contact" => Box::new(glitch::LooseContact::draw(scene, chance)),
        _ => return None,
    })
}
