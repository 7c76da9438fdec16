//! Effects of external simulators: their parameters are drawn here and passed on by name.

use rand::RngExt;

use crate::effect::actuator::{EffortLag, EffortSaturation};
use crate::effect::delay::{ChannelDelay, ToolInertia};
use crate::effect::force_range::ForceSaturation;
use crate::effect::friction::{CoulombFriction, StribeckFriction};
use crate::effect::gravity::GravityLoad;
use crate::effect::stiffness::NonlinearStiffness;
use crate::effect::transmission::{Backlash, TransmissionCompliance};
use crate::effect::{EffectParameter, EffectShape, NominalMotion, SizeRange, effect_rng};
use crate::rng::CaseRng;
use crate::scale::Unit;

/// A shape with the name of its effect.
#[derive(Debug)]
pub struct ExternalEffect {
    /// By the list, or of its own.
    pub name: &'static str,
    form: &'static str,
    shape: Box<dyn EffectShape + Send>,
}

impl EffectShape for ExternalEffect {
    fn form(&self) -> &'static str {
        self.form
    }

    fn size_range(&self) -> SizeRange {
        self.shape.size_range()
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        self.shape.parameters(size)
    }
}

/// The effect `name` with values at random; none where no simulator has it.
#[must_use]
pub fn draw(name: &'static str, motion: &NominalMotion, rng: &CaseRng) -> Option<ExternalEffect> {
    let rng = &mut effect_rng(name, rng);
    let shape: Box<dyn EffectShape + Send> = match name {
        "nonlinear_stiffness" => Box::new(NonlinearStiffness::power(motion, rng)),
        "hunt_crossley_damping" => Box::new(Dissipation { stiffness: motion.nominal.stiffness }),
        "environment_mass" => Box::new(Moved { unit: 0.05 * motion.nominal.mass }),
        "coulomb_friction" => Box::new(CoulombFriction::even(motion)),
        "stribeck_friction" => Box::new(StribeckFriction::exponential(motion, rng)),
        "gravity_load" => Box::new(GravityLoad::constant(motion, rng)),
        "transmission_compliance" => Box::new(TransmissionCompliance::draw(motion, rng)),
        "backlash" => Box::new(Backlash::draw(motion, rng)),
        "effort_saturation" => Box::new(EffortSaturation::draw(motion)),
        "effort_lag" => Box::new(EffortLag),
        "tool_inertia" => Box::new(ToolInertia { mass: motion.nominal.mass }),
        "channel_delay" => Box::new(ChannelDelay),
        "force_saturation" => Box::new(ForceSaturation::sharp(motion)),
        "soft_constraint" => Box::new(Soft::draw(motion, rng)),
        _ => return None,
    };
    // The law is ours, the way to stick or to meet is that of the simulator.
    let form = match name {
        "coulomb_friction" => "the simulator's own dry friction",
        "stribeck_friction" => "the simulator's own dry friction, exponential",
        "backlash" => "two masses with a gap between the simulator's own stops",
        _ => shape.form(),
    };
    Some(ExternalEffect { name, form, shape })
}

/// `hunt_crossley_damping`: `K p (1 + d v)`, alpha being K d.
#[derive(Debug)]
struct Dissipation {
    stiffness: f64,
}

impl EffectShape for Dissipation {
    fn form(&self) -> &'static str {
        "damping in proportion to depth, and no other"
    }

    fn size_range(&self) -> SizeRange {
        // s/m: beyond thirty the contact of a slow tap is all damper.
        SizeRange::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("alpha", self.stiffness * size, Unit::DampingGradient)]
    }
}

/// `environment_mass`: a mass that is there from the first touch on.
#[derive(Debug)]
struct Moved {
    unit: f64,
}

impl EffectShape for Moved {
    fn form(&self) -> &'static str {
        "mass at once on touching"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![EffectParameter::new("mass", size * self.unit, Unit::Mass)]
    }
}

/// `soft_constraint`: stiffness, damping and a moved mass that all rise with depth as MuJoCo's impedance does.
#[derive(Debug)]
struct Soft {
    impedance: f64,
    width: f64,
}

impl Soft {
    fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { impedance: rng.random_range(0.01..0.05), width: motion.depth * rng.random_range(0.5..1.2) }
    }
}

impl EffectShape for Soft {
    fn form(&self) -> &'static str {
        "MuJoCo's impedance over depth"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.1, 8.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("impedance", self.impedance, Unit::One),
            EffectParameter::new("deep_impedance", self.impedance * (1.0 + size), Unit::One),
            EffectParameter::new("width", self.width, Unit::Length),
        ]
    }
}
